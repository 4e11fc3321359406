#include "cli/describe.h"
#include "study/inspect.h"

int command_verify(int argc, char **argv)
{
    common_options common = {0};
    const char *path = parse_one_file(argc, argv,
                                      "Example: weft verify silk.btf.h5\n\n"
                                      "Reads all of a material (.weft), a dataset (.btf.h5), a weave (.wv), a cloth of "
                                      "microcylinders (.mc), a stitch "
                                      "(.stitch) or a session folder and checks it: sizes, checksums, every number, "
                                      "every photograph. Exit code 1 and one line where something is wrong.",
                                      &common);
    weft_progress progress = command_progress(&common);
    weft_error error = {0};
    json_t *description;
    weft_code code = weft_verify(path, &progress, &description, &error);
    if (code == WEFT_OK)
        code = describe(&common, "verify", description, &error);
    if (code == WEFT_OK)
        command_say(&common, "sound");
    json_decref(description);
    return command_exit("verify", &common, code, &error);
}

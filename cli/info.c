#include "cli/describe.h"
#include "study/inspect.h"

int command_info(int argc, char **argv)
{
    common_options common = {0};
    const char *path = parse_one_file(argc, argv,
                                      "Example: weft info silk.weft\n\n"
                                      "Says what a material (.weft), a dataset (.btf.h5), a weave (.wv), a cloth of "
                                      "microcylinders (.mc), a stitch (.stitch) or a session folder holds.",
                                      &common);
    weft_error error = {0};
    json_t *description;
    weft_code code = weft_inspect(path, &description, &error);
    if (code == WEFT_OK)
        code = describe(&common, "info", description, &error);
    json_decref(description);
    return command_exit("info", &common, code, &error);
}

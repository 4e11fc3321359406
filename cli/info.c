#include "cli/command/arguments.h"
#include "cli/command/describe.h"
#include "inspect/inspect.h"

typedef struct info_command {
    weft_common_options common;
    const char *path;
} info_command;

static const weft_option option_table[] = {
    {.argument = "FILE", .is_required = true, .kind = WEFT_OPTION_INPUT, .offset = offsetof(info_command, path)},
    {0},
};

static int run(int argc, char **argv)
{
    info_command values = {0};
    weft_arguments_parse(&weft_command_info, argc, argv, &values);
    weft_error error = {0};
    json_t *description;
    weft_code code = weft_inspect(values.path, &description, &error);
    if (code == WEFT_OK)
        code = weft_command_describe(&values.common, "info", description, &error);
    json_decref(description);
    return weft_command_exit("info", &values.common, code, &error);
}

const weft_command weft_command_info = {
    .name = "info",
    .summary = "print what a file holds",
    .usage = "FILE",
    .documentation = "Example: weft info silk.weft\n\n"
                     "Prints what a material (.weft), a dataset (.btf.h5), a weave (.wv), microcylinder cloth (.mc), a "
                     "stitch (.stitch) or a session folder holds.",
    .options = option_table,
    .needs = "a file",
    .surplus = "one file at a time",
    .run = run,
};

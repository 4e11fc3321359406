#include "cli/command/arguments.h"
#include "cli/command/describe.h"
#include "inspect/inspect.h"

typedef struct verify_command {
    weft_common_options common;
    const char *path;
} verify_command;

static const weft_option option_table[] = {
    {.argument = "FILE", .is_required = true, .kind = WEFT_OPTION_INPUT, .offset = offsetof(verify_command, path)},
    {0},
};

/* What is wrong with a session: a line each. */
static void say_faults(const weft_common_options *common, json_t *description)
{
    size_t i;
    json_t *fault;
    json_array_foreach (json_object_get(description, "faults"), i, fault) {
        const char *kind = json_string_value(json_object_get(fault, "kind"));
        if (!common->json)
            weft_command_say(common, "%s: %s", kind, json_string_value(json_object_get(fault, "text")));
        else
            weft_command_describe(common, "fault", fault, NULL);
    }
}

/* An interrupted session is sound as far as it goes. */
static void say_sound(const weft_common_options *common, json_t *description)
{
    json_int_t planned = json_integer_value(json_object_get(description, "planned"));
    json_int_t taken = json_integer_value(json_object_get(description, "taken"));
    if (taken < planned)
        weft_command_say(common, "sound, but %lld of %lld shots are not taken yet", (long long)(planned - taken),
                         (long long)planned);
    else
        weft_command_say(common, "sound");
}

static int run(int argc, char **argv)
{
    verify_command values = {0};
    weft_arguments_parse(&weft_command_verify, argc, argv, &values);
    weft_progress progress = weft_command_progress(&values.common);
    weft_error error = {0};
    json_t *description;
    weft_code code = weft_verify(values.path, &progress, &description, &error);
    say_faults(&values.common, description);
    if (code == WEFT_OK)
        code = weft_command_describe(&values.common, "verify", description, &error);
    if (code == WEFT_OK)
        say_sound(&values.common, description);
    json_decref(description);
    return weft_command_exit("verify", &values.common, code, &error);
}

const weft_command weft_command_verify = {
    .name = "verify",
    .summary = "check a file from end to end",
    .usage = "FILE",
    .documentation =
        "Example: weft verify silk.btf.h5\n\n"
        "Reads all of a material (.weft), a dataset (.btf.h5), a weave (.wv), microcylinder cloth (.mc), a "
        "stitch (.stitch) or a session folder and checks it: sizes, checksums, every number, every "
        "photograph. Exit code 1 and one line if something is wrong. For a session it lists all faults: each "
        "shot that is missing, damaged or a duplicate, and each unexpected file. `weft capture` takes those "
        "shots again.",
    .options = option_table,
    .needs = "a file",
    .surplus = "one file at a time",
    .run = run,
};

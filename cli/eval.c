#include "base/atomic_file.h"
#include "cli/command/arguments.h"
#include "evaluate/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARAMETER_LIMIT = 256 };

typedef struct eval_command {
    weft_common_options common;
    const char *input, *output, *directions;
    int noise_seed;
    weft_model_options options;
    weft_parameter parameter[PARAMETER_LIMIT];
} eval_command;

/* NAME=R or NAME=R,G,B; the name stays in the argument, which is the program's to change. */
static weft_code add_parameter(const weft_option *option, const char *text, void *values, weft_error *error)
{
    eval_command *command = values;
    char *name = (char *)text, *value = strchr(name, '=');
    if (!value || command->options.parameter_count == PARAMETER_LIMIT)
        return weft_fail(error, WEFT_BAD_USAGE, "--set needs NAME=VALUE (at most %d of them), not '%s'",
                         PARAMETER_LIMIT, text);
    *value++ = 0;
    double rgb[3] = {0};
    int count = 1;
    for (const char *at = value; *at; at++)
        count += *at == ',';
    if ((count != 1 && count != 3) || weft_option_numbers(option->name, value, count, rgb, error) != WEFT_OK)
        return weft_fail(error, WEFT_BAD_USAGE, "--set %s needs one number or three, separated by commas", name);
    weft_rgb colour = count == 1 ? (weft_rgb){rgb[0], rgb[0], rgb[0]} : (weft_rgb){rgb[0], rgb[1], rgb[2]};
    command->parameter[command->options.parameter_count++] = (weft_parameter){name, colour};
    return WEFT_OK;
}

static const weft_option option_table[] = {
    {.argument = "MODEL", .is_required = true, .kind = WEFT_OPTION_INPUT, .offset = offsetof(eval_command, input)},
    {"at", 'a', "DIRECTIONS.csv",
     "Table with the columns lx,ly,lz,vx,vy,vz and optionally u,v (else the mean of the material) and level",
     .is_required = true, .kind = WEFT_OPTION_INPUT, .offset = offsetof(eval_command, directions)},
    {"output", 'o', "FILE.csv", "Write here instead of to standard output", .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(eval_command, output)},
    {"noise", .argument = "SEED|off", .help = "Evaluate a weave with its noise (default: off)",
     .kind = WEFT_OPTION_NOISE, .offset = offsetof(eval_command, noise_seed)},
    {"lobes", .help = "Evaluate the lobes of a .weft that also has components", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(eval_command, options.lobes)},
    {"interval",
     .help = "Add the ends of the 95 % interval of a .weft with a certificate, r_low, r_high, ...; needs u and v",
     .kind = WEFT_OPTION_FLAG, .offset = offsetof(eval_command, options.interval)},
    {"as-printed", .help = "Weight the threads of a .mc as the article prints it, not by area",
     .kind = WEFT_OPTION_FLAG, .offset = offsetof(eval_command, options.as_printed)},
    {"set", 's', "NAME=R[,G,B]", "Value of a $NAME in a weave or .mc; may be repeated", .read = add_parameter},
    {0},
};

static weft_code check(void *values, weft_error *error)
{
    const eval_command *command = values;
    if (command->common.json && !command->output)
        return weft_fail(error, WEFT_BAD_USAGE, "--json and the table cannot share standard output: add -o FILE.csv");
    return WEFT_OK;
}

/* The whole table is made before any of it is written: a bad row then leaves nothing half-done. */
static weft_code evaluate(const eval_command *command, weft_model *model, char **text, size_t *size, weft_error *error)
{
    weft_csv table;
    WEFT_TRY(weft_csv_read(command->directions, true, &table, error));
    weft_progress progress = weft_command_progress(&command->common);
    FILE *memory = open_memstream(text, size);
    weft_code code = memory ? weft_model_evaluate_table(model, &table, &progress, memory, error)
                            : weft_fail_memory(error, "table", (unsigned long long)table.row_count);
    if (memory)
        fclose(memory);
    weft_csv_free(&table);
    return code;
}

static weft_code write_table(const eval_command *command, const char *text, size_t size, weft_error *error)
{
    if (command->output)
        return weft_write_file(command->output, text, size, error);
    if (fwrite(text, 1, size, stdout) != size || fflush(stdout) != 0)
        return weft_fail_errno(error, "write", "standard output");
    return WEFT_OK;
}

static int run(int argc, char **argv)
{
    eval_command command = {0};
    command.options.parameter = command.parameter;
    weft_arguments_parse(&weft_command_eval, argc, argv, &command);
    command.options.noise_seed = (uint64_t)command.noise_seed;
    weft_error error = {0};
    weft_model *model = NULL;
    char *text = NULL;
    size_t size = 0;
    weft_code code = weft_model_open(command.input, &command.options, &model, &error);
    if (code == WEFT_OK)
        code = evaluate(&command, model, &text, &size, &error);
    if (code == WEFT_OK)
        code = write_table(&command, text, size, &error);
    free(text);
    weft_model_close(model);
    return weft_command_exit("eval", &command.common, code, &error);
}

const weft_command weft_command_eval = {
    .name = "eval",
    .summary = "evaluate any model at listed directions",
    .usage = "MODEL --at DIRECTIONS.csv",
    .documentation =
        "Example: weft eval silk.weft --at directions.csv > values.csv\n\n"
        "Evaluates a material (.weft), a dataset (.btf.h5), a weave (.wv) or microcylinder cloth (.mc) and "
        "prints the rows of the table with the BRDF appended: r,g,b in 1/sr, without the cosine.",
    .options = option_table,
    .needs = "a model and --at DIRECTIONS.csv",
    .surplus = "one model at a time",
    .check = check,
    .run = run,
};

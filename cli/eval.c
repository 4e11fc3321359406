#include "base/atomic_file.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "study/model/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARAMETER_LIMIT = 256 };

typedef struct eval_command {
    conversion files;
    const char *directions;
    weft_model_options options;
    weft_parameter parameter[PARAMETER_LIMIT];
} eval_command;

enum { KEY_NOISE = 0x2000, KEY_AS_PRINTED };

static const struct argp_option option_table[] = {
    {"at", 'a', "DIRECTIONS.csv", 0,
     "Where to evaluate: columns lx,ly,lz,vx,vy,vz and maybe u,v (else the mean of the material), level", 0},
    {"output", 'o', "FILE.csv", 0, "Write here instead of to standard output", 0},
    {"noise", KEY_NOISE, "SEED|off", 0, "Evaluate a weave with its noise (default: off)", 0},
    {"as-printed", KEY_AS_PRINTED, NULL, 0, "Weigh the threads of a .mc as its article prints it, not by area", 0},
    {"set", 's', "NAME=R[,G,B]", 0, "Value of a $NAME in a weave or .mc; may be repeated", 0},
    {0},
};

/* NAME=R or NAME=R,G,B; the name stays in the argument. */
static void add_parameter(eval_command *command, char *argument, struct argp_state *state)
{
    char *value = strchr(argument, '=');
    if (!value || command->options.parameter_count == PARAMETER_LIMIT) {
        argp_error(state, "--set needs NAME=VALUE (at most %d of them), not '%s'", PARAMETER_LIMIT, argument);
        return;
    }
    *value++ = 0;
    double rgb[3];
    int count = 0;
    for (char *end; count < 3; value = end + 1) {
        rgb[count++] = strtod(value, &end);
        if (end == value || !isfinite(rgb[count - 1]) || (*end && *end != ','))
            argp_error(state, "--set %s needs one number or three, separated by commas", argument);
        if (!*end)
            break;
    }
    if (count == 2)
        argp_error(state, "--set %s needs one number or three", argument);
    weft_rgb colour = count == 1 ? (weft_rgb){rgb[0], rgb[0], rgb[0]} : (weft_rgb){rgb[0], rgb[1], rgb[2]};
    command->parameter[command->options.parameter_count++] = (weft_parameter){argument, colour};
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    eval_command *command = state->input;
    switch (key) {
    case 'a':
        command->directions = argument;
        return 0;
    case KEY_NOISE:
        command->options.noise_seed = (uint64_t)parse_noise_seed("noise", argument, state);
        return 0;
    case KEY_AS_PRINTED:
        command->options.as_printed = true;
        return 0;
    case 's':
        add_parameter(command, argument, state);
        return 0;
    case ARGP_KEY_END:
        if (!command->files.input || !command->directions)
            argp_error(state, "needs a model and --at DIRECTIONS.csv");
        if (command->files.common.json && !command->files.output)
            argp_error(state, "--json and the table cannot share standard output: add -o FILE.csv");
        refuse_same_file(command->files.output, command->directions, state);
        return parse_conversion(key, argument, state, &command->files);
    default:
        return parse_conversion(key, argument, state, &command->files);
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

static const struct argp parser = {option_table,
                                   parse_option,
                                   "MODEL --at DIRECTIONS.csv",
                                   "Example: weft eval silk.weft --at directions.csv > values.csv\n\n"
                                   "Evaluates a material (.weft), a dataset (.btf.h5), a weave (.wv) or a cloth of "
                                   "microcylinders (.mc) and prints the rows of the table with "
                                   "the BRDF appended: r,g,b in 1/sr, without the cosine.",
                                   children,
                                   NULL,
                                   NULL};

/* The whole table is made before any of it is written: a bad row then leaves nothing half-done. */
static weft_code evaluate(const eval_command *command, weft_model *model, char **text, size_t *size, weft_error *error)
{
    weft_csv table;
    WEFT_TRY(weft_csv_read(command->directions, true, &table, error));
    weft_progress progress = command_progress(&command->files.common);
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
    if (command->files.output)
        return weft_write_file(command->files.output, text, size, error);
    if (fwrite(text, 1, size, stdout) != size || fflush(stdout) != 0)
        return weft_fail_errno(error, "write", "standard output");
    return WEFT_OK;
}

int command_eval(int argc, char **argv)
{
    eval_command command = {.files = {.noun = "model"}};
    command.options.parameter = command.parameter;
    command_parse(&parser, argc, argv, &command, &command.files.common);
    weft_error error = {0};
    weft_model *model = NULL;
    char *text = NULL;
    size_t size = 0;
    weft_code code = weft_model_open(command.files.input, &command.options, &model, &error);
    if (code == WEFT_OK)
        code = evaluate(&command, model, &text, &size, &error);
    if (code == WEFT_OK)
        code = write_table(&command, text, size, &error);
    free(text);
    weft_model_close(model);
    return command_exit("eval", &command.files.common, code, &error);
}

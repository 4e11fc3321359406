#include "cli/command/arguments.h"
#include "base/atomic_file.h"

#include <argp.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

const char *argp_program_version = "weft " WEFT_VERSION;

enum { MAX_ROWS = 80, MAX_GIVEN = 256, FIRST_KEY = 0x1000, FIRST_FORMER_KEY = 0x2000, COMMON_GROUP = 9 };

static const weft_option common_table[] = {
    {"quiet", 'q', .help = "Print nothing but errors", .group = COMMON_GROUP, .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(weft_common_options, quiet)},
    {"json", .help = "Print progress and results as JSON, one event a line", .group = COMMON_GROUP,
     .kind = WEFT_OPTION_FLAG, .offset = offsetof(weft_common_options, json)},
    {"threads", 't', "N", "Use N threads (default: all cores)", COMMON_GROUP, .kind = WEFT_OPTION_WHOLE,
     .offset = offsetof(weft_common_options, threads), .low = 1, .high = 4096},
    {0},
};

/* All options of a command, and what is being read into. */
typedef struct arguments {
    const weft_command *command;
    void *values;
    int row_count, place_count, option_count;
    struct {
        const weft_option *option;
        const weft_setting *setting; /* of the picture, or NULL */
        bool is_given, by_former_name;
    } row[MAX_ROWS];
    struct argp_option option[2 * MAX_ROWS + 8]; /* with former names, headings and the end */
    int given_count;
    weft_given_option given[MAX_GIVEN]; /* settings of the picture: kept until all are there */
} arguments;

/* NULL where the command draws no picture. */
static weft_settings *settings_of(const arguments *a)
{
    size_t offset = a->command->settings_offset;
    return offset > 0 ? (weft_settings *)((char *)a->values + offset) : NULL;
}

/* ---- The table of argp ---- */

/* What argp calls the option of a row: its letter where it has one. */
static int key_of(const arguments *a, int row)
{
    char letter = a->row[row].option->letter;
    return letter ? letter : FIRST_KEY + row;
}

static void add_heading(arguments *a, const char *title, int group)
{
    a->option[a->option_count++] = (struct argp_option){.doc = title, .group = group};
}

/* A removed option takes any value, so that what is said of it is said first. */
static void add_row(arguments *a, const weft_option *option, const weft_setting *setting)
{
    int row = a->row_count++;
    if (row == MAX_ROWS)
        abort();
    a->row[row].option = option;
    a->row[row].setting = setting;
    if (!option->name)
        return;
    struct argp_option own = {
        .name = option->name,
        .key = key_of(a, row),
        .arg = option->gone ? "VALUE" : option->argument,
        .flags = (option->may_be_empty || option->gone ? OPTION_ARG_OPTIONAL : 0) | (option->gone ? OPTION_HIDDEN : 0),
        .doc = option->help,
        .group = option->group,
    };
    a->option[a->option_count++] = own;
    if (!option->former_name)
        return;
    own.name = option->former_name;
    own.key = FIRST_FORMER_KEY + row;
    own.flags |= OPTION_HIDDEN;
    a->option[a->option_count++] = own;
}

static void add_option(void *context, const weft_option *option, const weft_setting *setting)
{
    add_row(context, option, setting);
}

static void add_rows(arguments *a)
{
    if (a->command->settings_offset > 0)
        for (int group = 1; weft_settings_group(group); group++)
            add_heading(a, weft_settings_group(group), group);
    add_heading(a, "Common options:", COMMON_GROUP);
    weft_arguments_each(a->command, add_option, a);
}

static bool is_row(const weft_option *option)
{
    return option->name || option->argument;
}

void weft_arguments_each(const weft_command *command, weft_arguments_visit *visit, void *context)
{
    for (const weft_option *option = command->options; is_row(option); option++)
        visit(context, option, NULL);
    if (command->settings_offset > 0)
        for (const weft_setting *setting = weft_settings_schema(); setting->key || setting->option.name; setting++)
            if (is_row(&setting->option))
                visit(context, &setting->option, setting);
    for (const weft_option *option = common_table; is_row(option); option++)
        visit(context, option, NULL);
}

/* ---- Reading ---- */

/* Does not return unless all went well. */
static void insist(weft_code code, const weft_error *error, struct argp_state *state)
{
    if (code == WEFT_BAD_USAGE)
        argp_error(state, "%s", error->message);
    else if (code != WEFT_OK)
        argp_failure(state, (int)weft_class_of(code), 0, "%s", error->message);
}

static weft_code give(arguments *a, const weft_setting *setting, const char *text, weft_error *error)
{
    if (a->given_count == MAX_GIVEN)
        return weft_fail(error, WEFT_BAD_USAGE, "more than %d options", MAX_GIVEN);
    a->given[a->given_count++] = (weft_given_option){setting, text};
    return WEFT_OK;
}

static void set(arguments *a, int row, const char *text, struct argp_state *state)
{
    weft_error error = {0};
    const weft_option *option = a->row[row].option;
    const weft_setting *setting = a->row[row].setting;
    a->row[row].is_given = true;
    weft_code code = setting ? give(a, setting, text, &error) : weft_option_set(option, text, a->values, &error);
    insist(code, &error, state);
}

/* Arguments that are known by their place take the rows without a name in turn; that of a scene is one. */
static void set_next(arguments *a, const char *text, struct argp_state *state)
{
    int place = 0;
    for (int row = 0; row < a->row_count; row++) {
        if (a->row[row].option->name || (place++ < a->place_count && !a->row[row].setting))
            continue;
        if (!a->row[row].option->repeats)
            a->place_count++;
        set(a, row, text, state);
        return;
    }
    argp_error(state, "%s: unexpected argument '%s'", a->command->surplus, text);
}

static error_t set_by_key(arguments *a, int key, const char *text, struct argp_state *state)
{
    for (int row = 0; row < a->row_count; row++) {
        const weft_option *option = a->row[row].option;
        bool is_former = option->former_name && key == FIRST_FORMER_KEY + row;
        if (!option->name || (key != key_of(a, row) && !is_former))
            continue;
        if (option->gone)
            argp_error(state, "--%s is gone since 0.2: %s", option->name, option->gone);
        a->row[row].by_former_name |= is_former;
        set(a, row, text, state);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* The help of an option ends with its default, which stands in its row. The caller frees it. */
static char *describe_default(int key, const char *text, void *input)
{
    const arguments *a = input;
    const weft_option *option = NULL;
    char *longer = NULL;
    for (int row = 0; text && a && row < a->row_count; row++)
        if (a->row[row].option->name && key == key_of(a, row))
            option = a->row[row].option;
    if (!option || !option->usual || asprintf(&longer, "%s (default: %s)", text, option->usual) < 0)
        return (char *)text;
    return longer;
}

static void set_defaults(arguments *a)
{
    for (int row = 0; row < a->row_count; row++) {
        const weft_option *option = a->row[row].option;
        weft_error error = {0};
        if (option->usual && !a->row[row].setting &&
            weft_option_set(option, option->usual, a->values, &error) != WEFT_OK)
            abort();
    }
}

static void note_former_names(const arguments *a)
{
    for (int row = 0; row < a->row_count; row++) {
        const weft_option *option = a->row[row].option;
        if (a->row[row].by_former_name)
            fprintf(stderr, "weft %s: --%s is now --%s\n", a->command->name, option->former_name, option->name);
    }
}

/* ---- What they come to ---- */

/* The text of a row of one of the kinds, or NULL. */
static const char *text_of(const arguments *a, int row)
{
    const weft_option *option = a->row[row].option;
    bool is_text = option->kind == WEFT_OPTION_TEXT || option->kind == WEFT_OPTION_INPUT ||
                   option->kind == WEFT_OPTION_OUTPUT || option->kind == WEFT_OPTION_FOLDER;
    return is_text && !a->row[row].setting ? *(const char **)((char *)a->values + option->offset) : NULL;
}

/* Refuses an output that is an input, by whatever path. */
static void refuse_same_file(const char *output, const char *input, struct argp_state *state)
{
    struct stat written, read;
    if (output && input && stat(output, &written) == 0 && stat(input, &read) == 0 && written.st_dev == read.st_dev &&
        written.st_ino == read.st_ino)
        argp_error(state, "'%s' would overwrite its own input", output);
}

static void refuse_overwriting(const arguments *a, struct argp_state *state)
{
    for (int output = 0; output < a->row_count; output++) {
        if (a->row[output].option->kind != WEFT_OPTION_OUTPUT)
            continue;
        for (int input = 0; input < a->row_count; input++)
            if (a->row[input].option->kind == WEFT_OPTION_INPUT)
                refuse_same_file(text_of(a, output), text_of(a, input), state);
        const weft_settings *settings = settings_of(a);
        if (!settings)
            continue;
        refuse_same_file(text_of(a, output), settings->environment, state);
        refuse_same_file(text_of(a, output), settings->material, state);
    }
}

/* Before hours of work whose result has no place. */
static void check_outputs(const arguments *a, struct argp_state *state)
{
    weft_error error = {0};
    for (int row = 0; row < a->row_count; row++) {
        const weft_option_kind kind = a->row[row].option->kind;
        const char *name = text_of(a, row);
        if (name && kind == WEFT_OPTION_OUTPUT)
            insist(weft_output_check(name, &error), &error, state);
        if (name && kind == WEFT_OPTION_FOLDER)
            insist(weft_output_folder_check(name, &error), &error, state);
    }
}

static void check_inputs(const arguments *a, struct argp_state *state)
{
    weft_error error = {0};
    for (int row = 0; row < a->row_count; row++) {
        const weft_option *option = a->row[row].option;
        const char *name = text_of(a, row);
        if (name && option->kind == WEFT_OPTION_INPUT)
            insist(weft_argument_check_type(option->argument, name, &error), &error, state);
    }
}

/* Before a window opens. */
static void check_given_inputs(const arguments *a, struct argp_state *state)
{
    weft_error error = {0};
    for (int i = 0; i < a->given_count; i++) {
        const weft_option *option = &a->given[i].setting->option;
        if (option->name && option->kind == WEFT_OPTION_NAME)
            insist(weft_argument_check_type(option->argument, a->given[i].text, &error), &error, state);
    }
}

static void complete(arguments *a, struct argp_state *state)
{
    weft_error error = {0};
    for (int row = 0; row < a->row_count; row++)
        if (a->row[row].option->is_required && !text_of(a, row))
            argp_error(state, "needs %s", a->command->needs);
    refuse_overwriting(a, state);
    if (settings_of(a)) {
        insist(weft_settings_of_options(a->given, a->given_count, settings_of(a), &error), &error, state);
        check_given_inputs(a, state);
        refuse_overwriting(a, state); /* what the settings of another picture name, too */
    }
    check_inputs(a, state);
    check_outputs(a, state);
    if (a->command->check)
        insist(a->command->check(a->values, &error), &error, state);
}

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        set_next(a, text, state);
        return 0;
    case ARGP_KEY_END:
        complete(a, state);
        return 0;
    default:
        return set_by_key(a, key, text, state);
    }
}

void weft_arguments_parse(const weft_command *command, int argc, char **argv, void *values)
{
    arguments a = {.command = command, .values = values};
    const weft_common_options *common = values;
    add_rows(&a);
    set_defaults(&a);
    const struct argp parser = {a.option,         parse_option, command->usage, command->documentation, NULL,
                                describe_default, NULL};
    argp_err_exit_status = WEFT_BAD_USAGE;
    argp_parse(&parser, argc, argv, 0, NULL, &a);
    if (!common->quiet)
        note_former_names(&a);
    if (common->threads > 0)
        omp_set_num_threads(common->threads);
}

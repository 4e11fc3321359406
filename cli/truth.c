#include "btf/file_kind.h"
#include "capture/plan.h"
#include "cli/command/arguments.h"
#include "cli/command/describe.h"
#include "compare/error_budget/error_budget.h"
#include "compress/options/options.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>

enum { MOST_CLOTHS = 64, LEAST_QUERIES = 10, MOST_QUERIES = 1000000, MOST_PATHS = 65536, MOST_COMPONENTS = 32 };

typedef struct truth_command {
    weft_common_options common;
    int cloth_count, component_count; /* 0 components: as weft compress chooses */
    const char *cloth[MOST_CLOTHS], *rig_file;
    weft_error_budget_request request;
    weft_error_budget result[MOST_CLOTHS];
} truth_command;

static weft_code read_cloth(const weft_option *option, const char *text, void *values, weft_error *error)
{
    truth_command *command = values;
    if (command->cloth_count == MOST_CLOTHS)
        return weft_fail(error, WEFT_BAD_USAGE, "more than %d cloths", MOST_CLOTHS);
    command->cloth[command->cloth_count++] = text;
    weft_file_kind kind;
    WEFT_TRY(weft_file_kind_of(text, &kind, error));
    return weft_argument_check_type(option->argument, text, error);
}

static const weft_option option_table[] = {
    {.argument = "CLOTH.wv|.stitch...", .kind = WEFT_OPTION_OTHER, .read = read_cloth, .repeats = true},
    {"output", 'o', "REPORT/", "The folder for the page and its tables", .is_required = true,
     .kind = WEFT_OPTION_FOLDER, .offset = offsetof(truth_command, request.folder)},
    {"rig", .argument = "FILE.json", .help = "Settings of the virtual rig (default: its own)",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(truth_command, rig_file)},
    {"plan", .argument = "ubo81|FILE.csv",
     .help = "The photographs: all pairs of 81 directions (default), or a table as weft capture takes it",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(truth_command, request.chain.plan)},
    {"tiles", .argument = "N",
     .help = "Tiles of a stitch across the opening; opening and lens are scaled for it; 0: not scaled", .usual = "2",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(truth_command, request.tiles), .low = 0, .high = 1000},
    {"texels", .argument = "N", .help = "Texels along a side of the opening", .usual = "32", .kind = WEFT_OPTION_WHOLE,
     .offset = offsetof(truth_command, request.chain.size), .low = 1, .high = 1024},
    {"components", .argument = "N",
     .help = "Components of the material, at most 32 (default: as weft compress chooses)", .kind = WEFT_OPTION_WHOLE,
     .offset = offsetof(truth_command, component_count), .low = 4, .high = MOST_COMPONENTS},
    {"queries", .argument = "N", .help = "Number of random places, lights and views", .usual = "2000",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(truth_command, request.queries.count), .low = LEAST_QUERIES,
     .high = MOST_QUERIES},
    {"paths", .argument = "N", .help = "Light paths for each value of the cloth", .usual = "64",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(truth_command, request.queries.paths), .low = 1, .high = MOST_PATHS},
    {"seed", .argument = "N", .help = "Seed of the random numbers", .usual = "1", .kind = WEFT_OPTION_SEED,
     .offset = offsetof(truth_command, request.queries.seed)},
    {0},
};

static weft_code check(void *values, weft_error *error)
{
    truth_command *command = values;
    if (command->cloth_count == 0)
        return weft_fail(error, WEFT_BAD_USAGE, "needs %s", weft_command_truth.needs);
    weft_plan plan;
    WEFT_TRY(weft_plan_read(command->request.chain.plan, &plan, error));
    weft_plan_free(&plan);
    command->request.chain.component_count =
        command->component_count > 0 ? command->component_count : WEFT_COMPONENTS_AUTOMATIC;
    return WEFT_OK;
}

static weft_code say_result(const truth_command *command, const weft_error_budget *result, weft_error *error)
{
    const weft_error_stack *stack = &result->stack;
    weft_command_say(&command->common, "%-24s %6.2f %% %11.4f %12.4f %9.4f %9.4f %9.4f %6.2f %%", result->name,
                     100 * sqrt(fmax(stack->whole.value, 0)), stack->part[WEFT_SOURCE_DIRECTIONS].value,
                     stack->part[WEFT_SOURCE_REGISTRATION].value, stack->part[WEFT_SOURCE_MODEL].value,
                     stack->part[WEFT_SOURCE_STORAGE].value, stack->whole.value, 100 * stack->noise);
    return weft_command_report(&command->common, "sources", weft_error_budget_to_json(result), error);
}

/* What is known so far is on the page and in the table after each cloth. */
static weft_code write_report(const truth_command *command, int count, weft_error *error)
{
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s/sources.csv", command->request.folder) >= (int)sizeof path)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' is too long a name", command->request.folder);
    WEFT_TRY(weft_error_budget_write_csv(command->result, count, path, error));
    return weft_error_budget_write_page(command->result, count, &command->request, error);
}

static weft_code measure_all(truth_command *command, weft_error *error)
{
    const weft_common_options *common = &command->common;
    weft_progress progress = weft_command_progress(common);
    weft_command_say(common, "squared relative errors, which add up to the square of the relative RMSE:");
    weft_command_say(common, "%-24s %8s %11s %12s %9s %9s %9s %8s", "cloth", "rel.RMSE", "directions", "registration",
                     "model", "storage", "sum", "noise");
    for (int i = 0; i < command->cloth_count; i++) {
        WEFT_TRY(
            weft_error_budget_measure(&command->request, command->cloth[i], &progress, &command->result[i], error));
        WEFT_TRY(say_result(command, &command->result[i], error));
        WEFT_TRY(write_report(command, i + 1, error));
    }
    weft_command_say_page(common, "page", command->request.folder);
    return WEFT_OK;
}

static int run(int argc, char **argv)
{
    static truth_command command;
    command.request = (weft_error_budget_request){.rig = weft_virtual_settings_default(), .chain.plan = "ubo81"};
    weft_arguments_parse(&weft_command_truth, argc, argv, &command);
    weft_error error = {0};
    weft_code code = WEFT_OK;
    if (command.rig_file)
        code = weft_virtual_settings_read(command.rig_file, &command.request.rig, &error);
    if (code == WEFT_OK)
        code = measure_all(&command, &error);
    return weft_command_exit("truth", &command.common, code, &error);
}

const weft_command weft_command_truth = {
    .name = "truth",
    .summary = "split the error of a material by source, on cloth whose reflectance is known",
    .usage = "CLOTH... -o REPORT/",
    .documentation =
        "Example: weft truth silk.wv plain_knit.stitch -o report/\n\n"
        "Photographs each cloth with the virtual rig, registers and compresses it, and evaluates the material "
        "and each earlier stage at random places, lights and views, where the cloth itself is known. Writes "
        "one HTML page that splits the squared error of each cloth into the choice of directions, photographs "
        "and registration, the model, and storage; and the same as comma-separated values. The photographs "
        "are deleted when they are registered.",
    .options = option_table,
    .needs = "one cloth or more, and -o REPORT/",
    .surplus = "cloths",
    .check = check,
    .run = run,
};

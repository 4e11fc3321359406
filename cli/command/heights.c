#include "cli/command/heights.h"

#include "cli/command/describe.h"
#include "relief/page.h"

#include <stdlib.h>

void weft_heights_say(const weft_common_options *common, const weft_relief_report *report)
{
    char reason[512];
    weft_relief_reason(report, reason, sizeof reason);
    weft_command_say(common, "%s", reason);
    json_t *object = weft_relief_report_pack(report);
    weft_command_report(common, "relief", object, NULL);
}

weft_code weft_heights_estimate(const weft_common_options *common, const char *path, weft_relief_report *report,
                                weft_error *error)
{
    const weft_relief_options options = {0};
    weft_progress progress = weft_command_progress(common);
    weft_dataset *dataset;
    WEFT_TRY(weft_dataset_open(path, &dataset, error));
    weft_code code = weft_relief_estimate(dataset, &options, &progress, report, error);
    weft_dataset_close(dataset);
    return code;
}

/* What is found is a gain, no need: the dataset is complete without it. */
static void say_without(const weft_common_options *common, const weft_error *error)
{
    weft_command_say(common, "no heights: %s", error->message);
}

void weft_heights_look(const weft_common_options *common, const char *path)
{
    weft_relief_report report;
    weft_error error = {0};
    if (weft_heights_estimate(common, path, &report, &error) != WEFT_OK) {
        say_without(common, &error);
        return;
    }
    weft_heights_say(common, &report);
    if (report.verdict != WEFT_RELIEF_NOTHING && weft_relief_keep(path, path, &report, &error) != WEFT_OK)
        say_without(common, &error);
    weft_relief_report_free(&report);
}

#include "relief/keep.h"

#include "base/text/json_text.h"

#include <stdlib.h>

json_t *weft_relief_report_pack(const weft_relief_report *report)
{
    static const char *const name[] = {"nothing", "plane", "relief"};
    json_t *levels = json_array();
    for (int i = 0; i < report->level_count; i++)
        weft_json_append(&levels, json_pack("[f, f, f]", report->level_error[i].flat, report->level_error[i].plane,
                                            report->level_error[i].heights));
    return json_pack("{s:s, s:f, s:[f, f], s:b, s:i, s:{s:f, s:f, s:f}, s:o}", "verdict", name[report->verdict],
                     "plane_mm", report->plane_mm, "range_mm", report->low_mm, report->high_mm, "repeats",
                     report->repeats, "levels_used", report->levels_used, "left_out_error", "flat", report->error.flat,
                     "plane", report->error.plane, "relief", report->error.heights, "level_error", levels);
}

weft_code weft_relief_keep(const char *path, const char *output, const weft_relief_report *report, weft_error *error)
{
    const weft_dataset_heights heights = {report->width, report->height, report->levels_used, report->height_mm_of};
    double plane_mm = report->verdict == WEFT_RELIEF_NOTHING ? 0 : report->plane_mm;
    json_t *object = weft_relief_report_pack(report);
    if (report->moved_mm != 0)
        weft_json_put(&object, "moved_mm", json_real(report->moved_mm));
    char *made = object ? json_dumps(object, JSON_COMPACT) : NULL;
    json_decref(object);
    if (!made)
        return weft_fail_memory(error, "report", 0);
    weft_code code = weft_dataset_put_relief(path, output, plane_mm,
                                             report->verdict == WEFT_RELIEF_HEIGHTS ? &heights : NULL, made, error);
    free(made);
    return code;
}

#include "relief/page.h"

#include "base/text/chart.h"
#include "base/text/json_text.h"
#include "btf/direction/direction.h"

#include <math.h>
#include <stdlib.h>

enum { PICTURE_WIDTH = 360 };

static double ratio(double a, double b)
{
    return b > 0 ? a / b : 0;
}

void weft_relief_reason(const weft_relief_report *report, char *text, size_t size)
{
    const weft_relief_errors *error = &report->error;
    double against_plane = ratio(error->heights, error->plane), plane_gain = ratio(error->plane, error->flat);
    switch (report->verdict) {
    case WEFT_RELIEF_HEIGHTS:
        snprintf(text, size,
                 "relief: the error on left-out views is %.1f %% with heights, %.0f %% of the %.1f %% with the best "
                 "plane (limit: %.0f %%)",
                 100 * error->heights, 100 * against_plane, 100 * error->plane, 100 * WEFT_RELIEF_GAIN);
        break;
    case WEFT_RELIEF_PLANE:
        snprintf(text, size,
                 "plane: on left-out views heights have %.0f %% of the error of the best plane (limit: %.0f %%), and "
                 "the plane has %.0f %% of the error without depth (limit: %.0f %%)",
                 100 * against_plane, 100 * WEFT_RELIEF_GAIN, 100 * plane_gain, 100 * WEFT_RELIEF_PLANE_GAIN);
        break;
    default:
        snprintf(text, size,
                 "nothing: on left-out views heights have %.0f %% of the error of the best plane (limit: %.0f %%), and "
                 "the plane has %.0f %% of the error without depth (limit: %.0f %%)",
                 100 * against_plane, 100 * WEFT_RELIEF_GAIN, 100 * plane_gain, 100 * WEFT_RELIEF_PLANE_GAIN);
    }
}

/* ---- Pictures ---- */

/* Grey, from `low` (black) to `high`. */
static weft_code write_map(weft_page *page, const char *name, const weft_relief_report *report, const float *value,
                           double low, double high, const char *caption, weft_error *error)
{
    weft_image image;
    WEFT_TRY(weft_image_create(report->width, report->height, &image, error));
    double scale = high > low ? 1 / (high - low) : 0;
    for (int i = 0; i < report->width * report->height; i++)
        for (int c = 0; c < 3; c++)
            image.pixels[3 * i + c] = (float)(((double)value[i] - low) * scale);
    weft_code code = weft_page_picture(page, name, &image, PICTURE_WIDTH, caption, error);
    weft_image_free(&image);
    return code;
}

static weft_code write_maps(weft_page *page, const weft_relief_report *report, weft_error *error)
{
    char caption[160];
    float low = report->height_mm_of[0], high = low, most = 0;
    for (int i = 0; i < report->width * report->height; i++) {
        low = fminf(low, report->height_mm_of[i]);
        high = fmaxf(high, report->height_mm_of[i]);
        most = fmaxf(most, report->confidence[i]);
    }
    snprintf(caption, sizeof caption, "Heights: black is %.3f mm, white %.3f mm above the plane of the texels",
             (double)low, (double)high);
    fputs("<h2>Heights</h2>\n<div class=\"row\">\n", page->html);
    WEFT_TRY(write_map(page, "height", report, report->height_mm_of, (double)low, (double)high, caption, error));
    snprintf(caption, sizeof caption, "Confidence: white is a least cost %.2f below the mean", (double)most);
    WEFT_TRY(write_map(page, "confidence", report, report->confidence, 0, (double)most, caption, error));
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

/* ---- Errors by view ---- */

static double angle_of(const weft_relief_view *view)
{
    return weft_deg_of_rad(acos(fmin((double)view->direction.z, 1)));
}

static weft_code write_chart(weft_page *page, const weft_relief_report *report, weft_error *error)
{
    static const char *const name[] = {"flat", "best plane", "heights"};
    static const int colour[] = {1, 3, 0};
    int count = report->compared_count;
    double(*point)[2] = calloc(3 * (size_t)count + 1, sizeof *point);
    if (!point)
        return weft_fail_memory(error, "errors by view", 3 * (size_t)count * sizeof *point);
    weft_chart_series series[3];
    for (int s = 0; s < 3; s++) {
        double(*of)[2] = point + s * count;
        for (int i = 0; i < count; i++) {
            const weft_relief_errors *e = &report->view[i].error;
            of[i][0] = angle_of(&report->view[i]);
            of[i][1] = 100 * (s == 0 ? e->flat : s == 1 ? e->plane : e->heights);
        }
        series[s] = (weft_chart_series){name[s], colour[s], WEFT_CHART_POINTS, count, (const double(*)[2])of, NULL};
    }
    fputs(
        "<h2>Error by view</h2>\n<p class=\"note\">Each view predicted from its neighbours: as if all lay flat in the "
        "plane of the texels, through the best plane, and through heights that it had no part in.</p>\n",
        page->html);
    const weft_chart chart = {"Error of views that are left out",
                              {"view from the normal", "\u00b0", 0, 60, 0},
                              {"relative RMSE", " %", 0, 10, 0},
                              3,
                              series};
    weft_chart_write(page, &chart);
    free(point);
    return WEFT_OK;
}

static void write_levels(weft_page *page, const weft_relief_report *report)
{
    fputs("<h2>Error by mip level</h2>\n<table>\n", page->html);
    weft_page_columns(page, "level|flat|plane|heights");
    for (int level = 0; level < report->level_count; level++) {
        const weft_relief_errors *error = &report->level_error[level];
        fprintf(page->html, "<tr><td>%d%s</td><td>%.1f %%</td><td>%.1f %%</td><td>%.1f %%</td></tr>\n", level,
                level < report->levels_used ? "" : " (left flat)", 100 * error->flat, 100 * error->plane,
                100 * error->heights);
    }
    fputs("</table>\n", page->html);
}

static void write_facts(weft_page *page, const weft_relief_report *report)
{
    static const char *const name[] = {"nothing", "plane", "relief"};
    fputs("<div class=\"tiles\">\n", page->html);
    weft_page_tile(page, "decided", "%s", name[report->verdict]);
    weft_page_tile(page, "of the error through the plane, through heights", "%.0f %%",
                   100 * ratio(report->error.heights, report->error.plane));
    weft_page_tile(page, "of the error if flat, through the best plane", "%.0f %%",
                   100 * ratio(report->error.plane, report->error.flat));
    weft_page_tile(page, "best plane above the plane of the texels", "%.3f mm", report->plane_mm);
    fputs("</div>\n<table>\n", page->html);
    weft_page_fact(page, "material", "%.3g \u00d7 %.3g mm, %s", report->width_mm, report->height_mm,
                   report->repeats ? "repeats" : "does not repeat");
    weft_page_fact(page, "difference across the borders, of that inside", "%.0f %%", 100 * report->seam);
    weft_page_fact(page, "views", "%d, of which %d were left out in turn", report->view_count, report->compared_count);
    weft_page_fact(page, "lights", "%d", report->light_count);
    weft_page_fact(page, "heights looked for", "%.3f to %.3f mm", report->low_mm, report->high_mm);
    fputs("</table>\n", page->html);
}

static weft_code write_page(weft_page *page, const weft_relief_report *report, weft_error *error)
{
    char reason[512];
    weft_relief_reason(report, reason, sizeof reason);
    fputs("<p>", page->html);
    weft_page_text(page, reason);
    fputs(".</p>\n", page->html);
    write_facts(page, report);
    WEFT_TRY(write_maps(page, report, error));
    write_levels(page, report);
    WEFT_TRY(write_chart(page, report, error));
    return WEFT_OK;
}

weft_code weft_relief_page_write(const char *folder, const char *name, const weft_relief_report *report,
                                 weft_error *error)
{
    weft_page page;
    char title[256];
    snprintf(title, sizeof title, "The relief of %s", name);
    WEFT_TRY(weft_page_begin(folder, title, &page, error));
    weft_code code = write_page(&page, report, error);
    if (code == WEFT_OK)
        return weft_page_finish(&page, error);
    weft_page_abandon(&page);
    return code;
}

/* ---- In the dataset ---- */

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

#include "relief/page.h"

#include "base/text/html_page.h"
#include "btf/direction/direction.h"

#include <math.h>

enum { PICTURE_WIDTH = 360, CHART_WIDTH = 1000, CHART_HEIGHT = 320, CHART_MARGIN = 40 };

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
                 "relief: views that are left out are predicted with %.3f through the heights, %.2f of the "
                 "%.3f through the best plane (at most %.2f is wanted)",
                 error->heights, against_plane, error->plane, WEFT_RELIEF_GAIN);
        break;
    case WEFT_RELIEF_PLANE:
        snprintf(text, size,
                 "plane: heights predict views that are left out with %.2f of the error of the best plane "
                 "(%.2f is wanted), the plane with %.2f of that of no depth (%.2f is wanted)",
                 against_plane, WEFT_RELIEF_GAIN, plane_gain, WEFT_RELIEF_PLANE_GAIN);
        break;
    default:
        snprintf(text, size,
                 "nothing: neither heights (%.2f of the error of the best plane, %.2f is wanted) nor the "
                 "plane (%.2f of that of no depth, %.2f is wanted) predict views that are left out well "
                 "enough",
                 against_plane, WEFT_RELIEF_GAIN, plane_gain, WEFT_RELIEF_PLANE_GAIN);
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

static double largest_error(const weft_relief_report *report)
{
    double most = 1e-3;
    for (int i = 0; i < report->compared_count; i++)
        most = fmax(most,
                    fmax(report->view[i].error.flat, fmax(report->view[i].error.plane, report->view[i].error.heights)));
    return most;
}

static void write_dot(weft_page *page, double angle, double error, double most, const char *colour)
{
    double x = CHART_MARGIN + angle / 65 * (CHART_WIDTH - 2 * CHART_MARGIN);
    double y = CHART_HEIGHT - CHART_MARGIN - error / most * (CHART_HEIGHT - 2 * CHART_MARGIN);
    fprintf(page->html, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\" fill-opacity=\".7\"/>", x, y, colour);
}

static void write_chart(weft_page *page, const weft_relief_report *report)
{
    double most = largest_error(report);
    fprintf(page->html,
            "<h2>Error by view</h2>\n<p class=\"note\">Each view predicted from its neighbours: as if all lay in the "
            "plane of the texels (red), through the best plane (grey), through heights that it had no part in (blue). "
            "Relative RMSE up to %.3f, over the angle of the view up to 65 degrees.</p>\n"
            "<svg class=\"chart\" viewBox=\"0 0 %d %d\"><path d=\"M%d %d V%d H%d\" fill=\"none\" stroke=\"#999\"/>",
            most, CHART_WIDTH, CHART_HEIGHT, CHART_MARGIN, CHART_MARGIN, CHART_HEIGHT - CHART_MARGIN,
            CHART_WIDTH - CHART_MARGIN);
    for (int i = 0; i < report->compared_count; i++) {
        double angle = angle_of(&report->view[i]);
        write_dot(page, angle, report->view[i].error.flat, most, "#d9483b");
        write_dot(page, angle, report->view[i].error.plane, most, "#888");
        write_dot(page, angle, report->view[i].error.heights, most, "#2166ac");
    }
    fputs("</svg>\n", page->html);
}

static void write_views(weft_page *page, const weft_relief_report *report)
{
    fputs("<table class=\"long\">\n", page->html);
    weft_page_columns(page, "view|theta, degrees|phi, degrees|flat|plane|heights");
    for (int i = 0; i < report->compared_count; i++) {
        const weft_relief_view *view = &report->view[i];
        double phi = weft_deg_of_rad(atan2((double)view->direction.y, (double)view->direction.x));
        fprintf(page->html, "<tr%s><td>%d</td><td>%.1f</td><td>%.1f</td><td>%.3f</td><td>%.3f</td><td>%.3f</td></tr>\n",
                view->error.heights > view->error.plane ? " class=\"weak\"" : "", view->number, angle_of(view), phi,
                view->error.flat, view->error.plane, view->error.heights);
    }
    fputs("</table>\n", page->html);
}

static void write_levels(weft_page *page, const weft_relief_report *report)
{
    fputs("<h2>Error by mip level</h2>\n<table>\n", page->html);
    weft_page_columns(page, "level|flat|plane|heights");
    for (int level = 0; level < report->level_count; level++) {
        const weft_relief_errors *error = &report->level_error[level];
        fprintf(page->html, "<tr><td>%d%s</td><td>%.3f</td><td>%.3f</td><td>%.3f</td></tr>\n", level,
                level < report->levels_used ? "" : " (left flat)", error->flat, error->plane, error->heights);
    }
    fputs("</table>\n", page->html);
}

static void write_facts(weft_page *page, const weft_relief_report *report)
{
    static const char *const name[] = {"nothing", "plane", "relief"};
    fputs("<div class=\"tiles\">\n", page->html);
    weft_page_tile(page, "decided", "%s", name[report->verdict]);
    weft_page_tile(page, "error through heights / plane", "%.2f", ratio(report->error.heights, report->error.plane));
    weft_page_tile(page, "error through the plane / flat", "%.2f", ratio(report->error.plane, report->error.flat));
    weft_page_tile(page, "best plane, mm", "%.3f", report->plane_mm);
    fputs("</div>\n<table>\n", page->html);
    weft_page_fact(page, "material", "%.3g x %.3g mm, %s", report->width_mm, report->height_mm,
                   report->repeats ? "repeats" : "does not repeat");
    weft_page_fact(page, "difference across the borders / inside", "%.2f", report->seam);
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
    write_chart(page, report);
    write_views(page, report);
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

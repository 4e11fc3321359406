#include "capture/status/status_page.h"

#include "base/atomic_file.h"
#include "base/numeric/statistics.h"
#include "base/picture/colour.h"
#include "base/text/chart.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { THUMBNAIL = 160 };

/* One photograph of which the lamp is known. */
typedef struct lamp_level {
    int number; /* of the photographs of this run */
    double level;
} lamp_level;

struct weft_status_page {
    char folder[PATH_MAX];
    const weft_session *session;
    const char *camera;      /* NULL: there is one */
    int viewpoint;           /* of the last photograph; -1: none yet */
    int *shown, shown_count; /* [shot_count] first shots of the viewpoints */
    lamp_level *lamp;        /* [shot_count] */
    int lamp_count, noted;
};

static void free_status(weft_status_page *status)
{
    free(status->shown);
    free(status->lamp);
    free(status);
}

weft_code weft_status_page_begin(const char *folder, const weft_session *session, const char *camera,
                                 weft_status_page **result, weft_error *error)
{
    *result = NULL;
    if (!folder)
        return WEFT_OK;
    weft_status_page *status = calloc(1, sizeof *status);
    if (!status)
        return weft_fail_memory(error, "status page", sizeof *status);
    snprintf(status->folder, sizeof status->folder, "%s", folder);
    status->session = session;
    status->camera = camera;
    status->viewpoint = -1;
    status->shown = calloc((size_t)session->shot_count, sizeof *status->shown);
    status->lamp = calloc((size_t)session->shot_count, sizeof *status->lamp);
    if (!status->shown || !status->lamp) {
        free_status(status);
        return weft_fail_memory(error, "status page", (size_t)session->shot_count * sizeof *status->lamp);
    }
    *result = status;
    return WEFT_OK;
}

/* ---- The lamp ---- */

/* Power of the lamp in units of its own: what the white patches show, per second and per cosine of its direction. */
static void measure_lamp(weft_status_page *status, int shot, const weft_shot_record *record, double value)
{
    const weft_session *session = status->session;
    double theta_rad = session->shot[shot].light_driven.theta_rad;
    double range = (1 << session->bits) - 1 - session->black_level;
    if (theta_rad > weft_rad_of_deg(60) || value < 0.01 * range || value > 0.95 * range)
        return;
    status->lamp[status->lamp_count++] = (lamp_level){status->noted, value / record->exposure_s / cos(theta_rad)};
}

/* 0 where nothing is known. */
static double median_level(const weft_status_page *status)
{
    double *level = calloc((size_t)status->lamp_count + 1, sizeof *level);
    if (!level)
        return 0;
    for (int i = 0; i < status->lamp_count; i++)
        level[i] = status->lamp[i].level;
    double median = weft_quantile(level, (size_t)status->lamp_count, 0.5);
    free(level);
    return median;
}

static double largest_drift(const weft_status_page *status, double median)
{
    double largest = 0;
    for (int i = 0; i < status->lamp_count && median > 0; i++)
        largest = fmax(largest, fabs(status->lamp[i].level / median - 1));
    return largest;
}

/* ---- The page ---- */

static weft_code write_thumbnail(const weft_status_page *status, int shot, const uint16_t *samples, weft_error *error)
{
    const weft_session *session = status->session;
    int step = (session->camera.width + THUMBNAIL - 1) / THUMBNAIL;
    double range = (1 << session->bits) - 1 - session->black_level;
    weft_image image;
    char path[PATH_MAX + 32];
    WEFT_TRY(weft_image_create(session->camera.width / step, session->camera.height / step, &image, error));
    for (int i = 0; i < image.width * image.height; i++) {
        size_t at = (size_t)(i / image.width * step) * (size_t)session->camera.width + (size_t)(i % image.width * step);
        for (int c = 0; c < 3; c++)
            image.pixels[3 * i + c] = weft_srgb_of_linear(
                (float)weft_clamp((samples[3 * at + (size_t)c] - session->black_level) / range, 0, 1));
    }
    snprintf(path, sizeof path, "%s/shot%d.png", status->folder, shot);
    weft_code code = weft_image_write(path, &image, NULL, error);
    weft_image_free(&image);
    return code;
}

static void write_tiles(weft_page *page, const weft_status_page *status, const weft_status_counts *counts)
{
    double to_go_s = counts->taken_now ? counts->seconds / counts->taken_now * (counts->total - counts->taken) : 0;
    fputs("<div class=\"tiles\">", page->html);
    weft_page_tile(page, "photographs", "%d of %d", counts->taken, counts->total);
    weft_page_tile(page, "time to go", "%d h %02d min", (int)(to_go_s / 3600), (int)(to_go_s / 60) % 60);
    weft_page_tile(page, "largest change of the lamp from its median", "%.2f %%",
                   100 * largest_drift(status, median_level(status)));
    fputs("</div>", page->html);
}

/* The lamp over the photographs of this run. */
static weft_code write_drift(weft_page *page, const weft_status_page *status, weft_error *error)
{
    double median = median_level(status);
    double(*point)[2] = calloc((size_t)status->lamp_count + 1, sizeof *point);
    if (!point)
        return weft_fail_memory(error, "status page", (size_t)status->lamp_count * sizeof *point);
    for (int i = 0; i < status->lamp_count; i++) {
        point[i][0] = status->lamp[i].number;
        point[i][1] = median > 0 ? 100 * (status->lamp[i].level / median - 1) : NAN;
    }
    weft_chart_series lamp = {.point_count = status->lamp_count, .point = (const double(*)[2])point};
    weft_chart chart = {"The lamp, as the white patches show it",
                        {"photograph of this run", "", 0, 1, 1},
                        {"against its median", " %", -5, 5, 0},
                        1,
                        &lamp};
    weft_chart_write(page, &chart);
    free(point);
    return WEFT_OK;
}

static void write_faults(weft_page *page, const weft_status_counts *counts, const char *why)
{
    fputs("<h2>What went wrong</h2><table>", page->html);
    weft_page_columns(page, "what|times");
    weft_page_fact(page, "photographs that were not as the journal says, taken again", "%d", counts->damaged);
    weft_page_fact(page, "exposures that the camera did not deliver", "%d", counts->timeouts);
    weft_page_fact(page, "photographs during which the stage moved", "%d", counts->disturbed);
    fputs("</table>", page->html);
    if (why) {
        fputs("<p>The run ended early: ", page->html);
        weft_page_text(page, why);
        fputs("</p>", page->html);
    }
}

static void write_gallery(weft_page *page, const weft_status_page *status)
{
    fputs("<h2>The first photograph of each viewpoint</h2><div class=\"row even\">", page->html);
    for (int i = 0; i < status->shown_count; i++) {
        const weft_shot *shot = &status->session->shot[status->shown[i]];
        fprintf(page->html,
                "<figure><img src=\"shot%d.png\" alt=\"photograph %d\"><figcaption>view %.0f\u00b0 (azimuth "
                "%.0f\u00b0), light "
                "%.0f\u00b0 (azimuth %.0f\u00b0)</figcaption></figure>\n",
                status->shown[i], status->shown[i], weft_deg_of_rad(shot->view.theta_rad),
                weft_deg_of_rad(shot->view.phi_rad), weft_deg_of_rad(shot->light_driven.theta_rad),
                weft_deg_of_rad(shot->light_driven.phi_rad));
    }
    fputs("</div>", page->html);
}

static weft_code write_page(const weft_status_page *status, const weft_status_counts *counts, const char *why,
                            weft_error *error)
{
    weft_page page;
    char title[WEFT_MESSAGE_SIZE];
    snprintf(title, sizeof title, "%s%s%s", status->session->sample, status->camera ? ", camera " : "",
             status->camera ? status->camera : "");
    WEFT_TRY(weft_page_begin(status->folder, title, &page, error));
    write_tiles(&page, status, counts);
    write_faults(&page, counts, why);
    weft_code code = write_drift(&page, status, error);
    if (code != WEFT_OK) {
        weft_page_abandon(&page);
        return code;
    }
    write_gallery(&page, status);
    return weft_page_finish(&page, error);
}

weft_code weft_status_page_note(weft_status_page *status, int shot, const weft_shot_record *record, double white,
                                const uint16_t *samples, const weft_status_counts *counts, weft_error *error)
{
    if (!status)
        return WEFT_OK;
    measure_lamp(status, shot, record, white);
    status->noted++;
    if (record->viewpoint == status->viewpoint)
        return WEFT_OK;
    status->viewpoint = record->viewpoint;
    status->shown[status->shown_count++] = shot;
    WEFT_TRY(weft_make_folder(status->folder, error));
    WEFT_TRY(write_thumbnail(status, shot, samples, error));
    return write_page(status, counts, NULL, error);
}

weft_code weft_status_page_end(weft_status_page *status, const weft_status_counts *counts, const char *why,
                               weft_error *error)
{
    if (!status)
        return WEFT_OK;
    weft_code code = write_page(status, counts, why, error);
    free_status(status);
    return code;
}

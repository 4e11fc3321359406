#include "registration/report/report.h"

#include "base/atomic_file.h"
#include "base/numeric/statistics.h"
#include "base/picture/colour.h"
#include "base/picture/image.h"
#include "base/text/chart.h"
#include "base/text/html_page.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDEST_PICTURE = 260 };

/* ---- Numbers ---- */

static double saturated_share(const weft_registration *r)
{
    double sum = 0;
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++) {
        const weft_viewpoint *one = &r->survey.viewpoint[viewpoint];
        for (int i = 0; i < one->count && r->used[viewpoint] > 0; i++)
            sum += (double)r->saturated[one->shot[i]];
    }
    return r->image_count ? sum / r->image_count : 0;
}

weft_code weft_registration_summarise(const weft_session *session, const weft_registration *r,
                                      weft_registration_summary *summary, weft_error *error)
{
    size_t viewpoints = (size_t)r->survey.viewpoint_count, count = 0;
    double *uncertainty = calloc(2 * viewpoints, sizeof *uncertainty), *shift = uncertainty + viewpoints;
    if (!uncertainty)
        return weft_fail_memory(error, "viewpoints", 2 * viewpoints * sizeof *uncertainty);
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++) {
        if (r->pose[viewpoint].source == WEFT_POSE_FAILED)
            continue;
        uncertainty[count] = weft_registration_uncertainty_texels(session, r, viewpoint);
        shift[count++] = r->pose[viewpoint].shift_mm;
    }
    *summary = (weft_registration_summary){weft_quantile(uncertainty, count, 0.5), weft_quantile(uncertainty, count, 1),
                                           weft_quantile(shift, count, 0.5), saturated_share(r)};
    free(uncertainty);
    return WEFT_OK;
}

double weft_bend_depth_mm(const weft_bend_found *found)
{
    /* The larger of the two principal curvatures. */
    const weft_bend *b = &found->bend;
    double mean = (b->xx + b->yy) / 2, spread = hypot((b->xx - b->yy) / 2, b->xy / 2);
    return (fabs(mean) + spread) * found->unit_mm * found->unit_mm;
}

double weft_vignetting_loss(const weft_vignetting *vignetting)
{
    return 1 - exp((vignetting->r2 + vignetting->r4 * vignetting->reach) * vignetting->reach);
}

/* ---- Pictures ---- */

weft_code weft_report_prepare(const char *folder, weft_error *error)
{
    char pictures[PATH_MAX];
    if (snprintf(pictures, sizeof pictures, "%s/pictures", folder) >= (int)sizeof pictures)
        return weft_fail(error, WEFT_BAD_USAGE, "the report's folder has too long a name");
    return weft_make_folder(pictures, error);
}

/* The quantile of 0.98 of the finite values; 1 where it is not above 0. */
static weft_code find_white(const float *value, size_t count, float *white, weft_error *error)
{
    float *finite = malloc((count + 1) * sizeof *finite);
    if (!finite)
        return weft_fail_memory(error, "the values of a picture", count * sizeof *finite);
    size_t finite_count = 0;
    for (size_t i = 0; i < count; i++) {
        if (isfinite(value[i]))
            finite[finite_count++] = value[i];
    }
    float high = finite_count ? weft_quantile_of_floats(finite, finite_count, 0.98) : 1;
    *white = high > 0 ? high : 1;
    free(finite);
    return WEFT_OK;
}

/* Mean of the finite values of a channel in a square of pixels; 0 where there is none. */
static float mean_of_square(const float *value, int width, int channels, int x0, int y0, int side, int channel)
{
    float sum = 0;
    int count = 0;
    for (int i = 0; i < side * side; i++) {
        float v = value[((long)(y0 + i / side) * width + x0 + i % side) * channels + channel];
        if (isfinite(v)) {
            sum += v;
            count++;
        }
    }
    return count ? sum / (float)count : 0;
}

/* Writes value [height][width][channels] (1 or 3) as sRGB, reduced to at most WIDEST_PICTURE pixels across. */
static weft_code write_picture(const weft_registration *registration, int viewpoint, const char *what,
                               const float *value, int width, int height, int channels, weft_error *error)
{
    char path[PATH_MAX];
    float white;
    weft_image image;
    int side = (width + WIDEST_PICTURE - 1) / WIDEST_PICTURE;
    if (snprintf(path, sizeof path, "%s/pictures/%03d_%s.png", registration->settings.report_folder, viewpoint, what) >=
        (int)sizeof path)
        return weft_fail(error, WEFT_BAD_USAGE, "the report's folder has too long a name");
    WEFT_TRY(find_white(value, (size_t)width * (size_t)height * (size_t)channels, &white, error));
    WEFT_TRY(weft_image_create(width / side, height / side, &image, error));
    for (int i = 0; i < 3 * image.width * image.height; i++) {
        int x = i / 3 % image.width * side, y = i / 3 / image.width * side;
        float mean = mean_of_square(value, width, channels, x, y, side, i % 3 % channels);
        image.pixels[i] = weft_srgb_of_linear(mean / white);
    }
    weft_code code = weft_image_write(path, &image, NULL, error);
    weft_image_free(&image);
    return code;
}

weft_code weft_report_write_pictures(const weft_registration *registration, const weft_camera *camera, int viewpoint,
                                     const float *average, const float *texel, weft_error *error)
{
    const weft_registration_settings *settings = &registration->settings;
    if (average)
        WEFT_TRY(
            write_picture(registration, viewpoint, "photograph", average, camera->width, camera->height, 1, error));
    return texel ? write_picture(registration, viewpoint, "texels", texel, settings->width, settings->height, 3, error)
                 : WEFT_OK;
}

/* ---- Sections of the page ---- */

static weft_code write_summary(weft_page *page, const weft_session *session, const weft_registration *r,
                               weft_error *error)
{
    weft_registration_summary all;
    WEFT_TRY(weft_registration_summarise(session, r, &all, error));
    fputs("<div class=\"tiles\">\n", page->html);
    weft_page_tile(page, "photographs in the dataset", "%d of %d", r->image_count, session->shot_count);
    weft_page_tile(page, "viewpoints of the camera registered", "%d of %d",
                   r->survey.viewpoint_count - r->failed_viewpoints, r->survey.viewpoint_count);
    weft_page_tile(page, "thousandths of a texel: random error, median viewpoint", "%.2f",
                   1000 * all.median_uncertainty);
    weft_page_tile(page, "thousandths of a texel: random error, worst viewpoint", "%.2f", 1000 * all.worst_uncertainty);
    weft_page_tile(page, "median shift against the predicted pose", "%.3f mm", all.median_shift_mm);
    weft_page_tile(page, "samples saturated", "%.3f %%", 100 * all.saturated);
    if (session->colour.terms > 0)
        weft_page_tile(page, "CIEDE2000: linear sRGB, of a held-out patch of a chart", "%.2f",
                       session->colour.left_out.mean);
    weft_page_tile(page, "time taken", "%.0f s", r->seconds);
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

static void write_faults(weft_page *page, const weft_session *session, const weft_registration *r)
{
    if (r->fault_count == 0 && r->failed_viewpoints == 0)
        return;
    fputs("<h2>What could not be used</h2>\n<table>", page->html);
    weft_page_columns(page, "what|:why");
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++) {
        const weft_viewpoint *one = &r->survey.viewpoint[viewpoint];
        if (r->pose[viewpoint].source != WEFT_POSE_FAILED)
            continue;
        fprintf(page->html,
                "<tr class=\"bad\"><td class=\"text\">view %s, viewpoint %d, %d photographs</td><td class=\"text\">",
                weft_view_name_of(r->survey.view[one->view]).text, one->viewpoint, one->count);
        weft_page_text(page, r->pose[viewpoint].remark);
        fputs("</td></tr>\n", page->html);
    }
    for (int shot = 0; shot < session->shot_count; shot++) {
        if (!r->fault[shot].reason[0])
            continue;
        fprintf(page->html, "<tr class=\"bad\"><td class=\"text\">photograph %d</td><td class=\"text\">", shot);
        weft_page_text(page, r->fault[shot].reason);
        fputs("</td></tr>\n", page->html);
    }
    fputs("</table>\n", page->html);
}

/* The random error of every viewpoint over the angle of its view, and the lamp over the session. */
static weft_code write_charts(weft_page *page, const weft_session *session, const weft_registration *r,
                              weft_error *error)
{
    int count = r->survey.viewpoint_count, found = 0;
    double(*point)[2] = calloc(2 * (size_t)count, sizeof *point), (*lamp)[2] = point + count;
    if (!point)
        return weft_fail_memory(error, "viewpoints", 2 * (size_t)count * sizeof *point);
    double mean = weft_lamp_drift_of(r).mean;
    for (int i = 0; i < count; i++) {
        const weft_viewpoint *one = &r->survey.viewpoint[i];
        weft_viewpoint_white white = weft_viewpoint_white_of(r, i);
        double level = white.level[0] + white.level[1] + white.level[2];
        lamp[i][0] = one->viewpoint;
        lamp[i][1] = white.photographs > 0 ? 100 * (level / mean - 1) : NAN;
        if (r->pose[i].source == WEFT_POSE_FAILED)
            continue;
        point[found][0] = weft_deg_of_rad(r->survey.view[one->view].theta_rad);
        point[found++][1] = 1000 * weft_registration_uncertainty_texels(session, r, i);
    }
    const weft_chart_series errors = {.point_count = found, .point = (const double(*)[2])point};
    const weft_chart_series levels = {.point_count = count, .point = (const double(*)[2])lamp};
    const weft_chart error_chart = {"Random error of every viewpoint",
                                    {"view from the normal", "\u00b0", 0, 75, 0},
                                    {"thousandths of a texel", "", 0, 0.1, 0},
                                    1,
                                    &errors};
    const weft_chart lamp_chart = {"The lamp over the session",
                                   {"viewpoint of the camera", "", 0, 0, 1},
                                   {"white level against the mean", " %", -5, 5, 0},
                                   1,
                                   &levels};
    fputs("<h2>Errors and lamp</h2>\n<p>The random error is estimated from what the drawing leaves unexplained in the "
          "photograph, RMS over the opening. Errors of the calibrated lens come on top. The white level is the raw "
          "value above black, per second of exposure, of a perfect white diffuser; a steady lamp has the same in every "
          "photograph.",
          page->html);
    if (r->estimated_whites)
        fprintf(page->html, " In %d photographs no patch could be measured; they use the level of the others.",
                r->estimated_whites);
    fputs("</p>\n<div class=\"plots\">\n", page->html);
    weft_chart_write(page, &error_chart);
    if (mean > 0)
        weft_chart_write(page, &lamp_chart);
    fputs("</div>\n", page->html);
    free(point);
    return WEFT_OK;
}

static void write_sensor(weft_page *page, const weft_sensor_summary *sensor)
{
    if (sensor->dark_frames > 0)
        fprintf(
            page->html,
            "<li>The sensor gathers %.3g raw values per second without light (from %d dark frames at %.3g s, and as "
            "many brief ones); this is subtracted. %d hot pixels are masked.</li>\n",
            sensor->dark_rate, sensor->dark_frames, sensor->longest_s, sensor->hot);
    if (sensor->flat_frames > 0)
        fprintf(page->html,
                "<li>Pixels respond with %.1f to %.1f %% of the usual one (0.1st and 99.9th percentile, from %d flat "
                "frames), and %+.2f %% toward the rim beside the calibrated vignetting; this is divided out. %d dead "
                "pixels are masked.</li>\n",
                100 * sensor->least, 100 * sensor->most, sensor->flat_frames, 100 * sensor->fall_off, sensor->dead);
}

static void write_rig(weft_page *page, const weft_registration *r)
{
    const weft_bend_found *bend = &r->found.bend;
    const weft_vignetting *v = &r->found.vignetting;
    fputs("<h2>What the photographs determine of the rig</h2>\n<ul>\n", page->html);
    if (bend->viewpoints > 0)
        fprintf(page->html,
                "<li>The plate is bent by %.3f mm between its middle and its rim (random error %.4f mm, from %d "
                "viewpoints); this is taken out.</li>\n",
                weft_bend_depth_mm(bend), bend->standard_error_mm, bend->viewpoints);
    else
        fputs("<li>The bend of the plate could not be found: it is taken as flat.</li>\n", page->html);
    if (v->photographs > 0)
        fprintf(
            page->html,
            "<li>Beside the calibrated vignetting, the outermost white patch loses %.2f %% (standard error %.2f %%, "
            "from %d photographs); this is taken out.</li>\n",
            100 * weft_vignetting_loss(v), 100 * v->standard_error, v->photographs);
    write_sensor(page, &r->found.sensor);
    fputs("</ul>\n<h2>What they cannot determine</h2>\n<ul>\n<li>The scale of the print: millimetres are those that "
          "are printed.</li>\n<li>How high the cloth lies over the paper: 0.1 mm moves it by 0.17 mm in a view from 60 "
          "degrees. It is taken to lie in the surface that continues the print.</li>\n<li>The reflectance of the white "
          "patches: all reflectances scale with it.</li>\n</ul>\n",
          page->html);
}

static void write_figure(weft_page *page, const weft_registration *r, int viewpoint)
{
    const weft_viewpoint *one = &r->survey.viewpoint[viewpoint];
    const weft_view_pose *pose = &r->pose[viewpoint];
    weft_angles view = r->survey.view[one->view];
    bool failed = pose->source == WEFT_POSE_FAILED;
    fprintf(page->html, "<figure%s><div><img loading=\"lazy\" alt=\"photograph\" src=\"pictures/%03d_photograph.png\">",
            failed ? " class=\"bad\"" : "", viewpoint);
    if (r->used[viewpoint] > 0)
        fprintf(page->html,
                "<img class=\"texels\" loading=\"lazy\" alt=\"rectified\" src=\"pictures/%03d_texels.png\">",
                viewpoint);
    fprintf(page->html,
            "</div><figcaption>%.0f\u00b0 from the normal, azimuth %.0f\u00b0 (%s), viewpoint %d: "
            "%s%s</figcaption></figure>\n",
            weft_deg_of_rad(view.theta_rad), weft_deg_of_rad(view.phi_rad), weft_view_name_of(view).text,
            one->viewpoint, failed ? "failed" : "pose from ", failed ? "" : weft_pose_source_name(pose));
}

static void write_viewpoint(weft_page *page, const weft_session *session, const weft_registration *r, int viewpoint)
{
    const weft_viewpoint *one = &r->survey.viewpoint[viewpoint];
    const weft_view_pose *pose = &r->pose[viewpoint];
    weft_angles view = r->survey.view[one->view];
    const char *class = pose->source == WEFT_POSE_FAILED                     ? " class=\"bad\""
                        : pose->remark[0] || r->used[viewpoint] < one->count ? " class=\"weak\""
                                                                             : "";
    fprintf(page->html,
            "<tr%s><td>%s</td><td>%.1f</td><td>%.1f</td><td>%d</td><td>%d of %d</td><td class=\"text\">%s</td>", class,
            weft_view_name_of(view).text, weft_deg_of_rad(view.theta_rad), weft_deg_of_rad(view.phi_rad),
            one->viewpoint, r->used[viewpoint], one->count, weft_pose_source_name(pose));
    fprintf(page->html, "<td>%d</td><td>%.2f</td><td>%.4f</td><td>%.2f</td><td>%.3f</td><td class=\"text\">",
            pose->marker_count, pose->marker_rms_px, pose->correlation,
            1000 * weft_registration_uncertainty_texels(session, r, viewpoint), pose->shift_mm);
    weft_page_text(page, pose->remark);
    fputs("</td></tr>\n", page->html);
}

static void write_viewpoints(weft_page *page, const weft_session *session, const weft_registration *r)
{
    fputs("<h2>Pictures</h2>\n<p>Left: the mean of a viewpoint's photographs. Right: one photograph, rectified to "
          "texels.</p>\n<div class=\"gallery\">\n",
          page->html);
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++)
        write_figure(page, r, viewpoint);
    fputs("</div>\n<h2>Every view</h2>\n<table class=\"long\">", page->html);
    weft_page_columns(
        page, "view|\u03b8\u00b0|\u03c6\u00b0|viewpoint|photographs|:used|markers|markers' RMS (px)|correlation|error "
              "(texel/1000)|shift (mm)|:remark");
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++)
        write_viewpoint(page, session, r, viewpoint);
    fputs("</table>\n", page->html);
}

/* ---- The page ---- */

static weft_code write_page(weft_page *page, const weft_session *session, const weft_registration *r,
                            const char *dataset, weft_error *error)
{
    fputs("<p class=\"note\">Session ", page->html);
    weft_page_text(page, session->folder);
    fputs(", dataset ", page->html);
    weft_page_text(page, dataset);
    fprintf(page->html, ", %d \u00d7 %d texels of %.3f mm</p>\n", r->settings.width, r->settings.height,
            session->target.opening_mm / r->settings.width);
    WEFT_TRY(write_summary(page, session, r, error));
    write_faults(page, session, r);
    WEFT_TRY(write_charts(page, session, r, error));
    write_rig(page, r);
    write_viewpoints(page, session, r);
    return WEFT_OK;
}

weft_code weft_report_write_page(const weft_session *session, const weft_registration *registration,
                                 const char *dataset, weft_error *error)
{
    weft_page page;
    char *title;
    if (asprintf(&title, "Registration of %s", session->sample ? session->sample : "a sample") < 0)
        return weft_fail_memory(error, "the report", 0);
    weft_code code = weft_page_begin(registration->settings.report_folder, title, &page, error);
    free(title);
    WEFT_TRY(code);
    code = write_page(&page, session, registration, dataset, error);
    if (code == WEFT_OK)
        return weft_page_finish(&page, error);
    weft_page_abandon(&page);
    return code;
}

#include "registration/report/tables.h"

#include "base/numeric/statistics.h"
#include "base/text/chart.h"

#include <math.h>
#include <stdlib.h>

static int ring_of_viewpoint(const weft_registration *r, int viewpoint)
{
    return weft_ubo81_ring(r->survey.view[r->survey.viewpoint[viewpoint].view].theta_rad);
}

/* Fraction of the texels of the photographs of a ring that are saturated. */
static double saturated_fraction(const weft_registration *r, int ring)
{
    double sum = 0;
    int count = 0;
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++) {
        const weft_viewpoint *one = &r->survey.viewpoint[viewpoint];
        if ((ring >= 0 && ring_of_viewpoint(r, viewpoint) != ring) || r->used[viewpoint] == 0)
            continue;
        for (int i = 0; i < one->count; i++)
            sum += (double)r->saturated[one->shot[i]];
        count += r->used[viewpoint];
    }
    return count ? sum / count : 0;
}

weft_code weft_ring_summarise(const weft_session *session, const weft_registration *r, int ring,
                              weft_ring_summary *summary, weft_error *error)
{
    *summary = (weft_ring_summary){.saturated = saturated_fraction(r, ring)};
    size_t viewpoints = (size_t)r->survey.viewpoint_count;
    double *uncertainty = calloc(3 * viewpoints, sizeof *uncertainty);
    if (!uncertainty)
        return weft_fail_memory(error, "the viewpoints of a ring", 3 * viewpoints * sizeof *uncertainty);
    double *correlation = uncertainty + viewpoints, *shift = correlation + viewpoints;
    int count = 0;
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++) {
        if (ring >= 0 && ring_of_viewpoint(r, viewpoint) != ring)
            continue;
        summary->viewpoints++;
        if (r->pose[viewpoint].source == WEFT_POSE_FAILED) {
            summary->failed++;
            continue;
        }
        uncertainty[count] = weft_registration_uncertainty_texels(session, r, viewpoint);
        correlation[count] = r->pose[viewpoint].correlation;
        shift[count++] = r->pose[viewpoint].shift_mm;
    }
    summary->median_uncertainty = weft_quantile(uncertainty, count, 0.5);
    summary->worst_uncertainty = weft_quantile(uncertainty, count, 1);
    summary->median_correlation = weft_quantile(correlation, count, 0.5);
    summary->worst_correlation = weft_quantile(correlation, count, 0);
    summary->median_shift_mm = weft_quantile(shift, count, 0.5);
    summary->worst_shift_mm = weft_quantile(shift, count, 1);
    free(uncertainty);
    return WEFT_OK;
}

void weft_write_faults(weft_page *page, const weft_session *session, const weft_registration *r)
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

/* What is drawn of a viewpoint. */
typedef enum viewpoint_quantity { VIEWPOINT_ERROR, VIEWPOINT_SHIFT } viewpoint_quantity;

/* A dot for every viewpoint that did not fail, over the angle of its view. */
static weft_code draw_viewpoints(weft_page *page, const weft_session *session, const weft_registration *r,
                                 viewpoint_quantity quantity, weft_error *error)
{
    int count = 0;
    double(*point)[2] = calloc((size_t)r->survey.viewpoint_count + 1, sizeof *point);
    if (!point)
        return weft_fail_memory(error, "viewpoints", (size_t)r->survey.viewpoint_count * sizeof *point);
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++) {
        if (r->pose[viewpoint].source == WEFT_POSE_FAILED)
            continue;
        point[count][0] = weft_deg_of_rad(r->survey.view[r->survey.viewpoint[viewpoint].view].theta_rad);
        point[count++][1] = quantity == VIEWPOINT_ERROR
                                ? 1000 * weft_registration_uncertainty_texels(session, r, viewpoint)
                                : r->pose[viewpoint].shift_mm;
    }
    const weft_chart_series viewpoints = {.point_count = count, .point = (const double(*)[2])point};
    const weft_chart chart = {quantity == VIEWPOINT_ERROR ? "Random error of every viewpoint"
                                                          : "Shift of every viewpoint",
                              {"view from the normal", "\u00b0", 0, 75, 0},
                              {quantity == VIEWPOINT_ERROR ? "thousandths of a texel" : "mm", "", 0, 0.1, 0},
                              1,
                              &viewpoints};
    weft_chart_write(page, &chart);
    free(point);
    return WEFT_OK;
}

weft_code weft_write_rings(weft_page *page, const weft_session *session, const weft_registration *r, weft_error *error)
{
    fputs(
        "<h2>By ring of views</h2>\n<p>The error is the random one, estimated from what the drawing leaves unexplained "
        "in "
        "the photograph, RMS over the opening; what the calibration of the lens has wrong comes on top and is not seen "
        "here. The shift is against the pose that the rig promised.</p>\n"
        "<table>",
        page->html);
    weft_page_columns(page,
                      "view|viewpoints|failed|error, median (texel/1000)|worst|correlation, median|worst|shift, median "
                      "(mm)|worst|saturated (%)");
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        weft_ring_summary s;
        WEFT_TRY(weft_ring_summarise(session, r, ring, &s, error));
        if (s.viewpoints == 0)
            continue;
        fprintf(page->html,
                "<tr%s><td>%d\u00b0</td><td>%d</td><td>%d</td><td>%.2f</td><td>%.2f</td><td>%.4f</td><td>%.4f</td>"
                "<td>%.3f</td><td>%.3f</td><td>%.3f</td></tr>\n",
                s.failed ? " class=\"weak\"" : "", 15 * ring, s.viewpoints, s.failed, 1000 * s.median_uncertainty,
                1000 * s.worst_uncertainty, s.median_correlation, s.worst_correlation, s.median_shift_mm,
                s.worst_shift_mm, 100 * s.saturated);
    }
    fputs("</table>\n<div class=\"plots\">\n", page->html);
    WEFT_TRY(draw_viewpoints(page, session, r, VIEWPOINT_ERROR, error));
    WEFT_TRY(draw_viewpoints(page, session, r, VIEWPOINT_SHIFT, error));
    fputs("</div>\n", page->html);
    return WEFT_OK;
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

void weft_write_viewpoints(weft_page *page, const weft_session *session, const weft_registration *r)
{
    fputs("<h2>Every view</h2>\n<table class=\"long\">", page->html);
    weft_page_columns(
        page, "view|\u03b8\u00b0|\u03c6\u00b0|viewpoint|photographs|:used|markers|markers' RMS (px)|correlation|error "
              "(texel/1000)|shift (mm)|:remark");
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++)
        write_viewpoint(page, session, r, viewpoint);
    fputs("</table>\n", page->html);
}

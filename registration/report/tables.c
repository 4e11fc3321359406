#include "registration/report/tables.h"

#include "base/numeric/statistics.h"
#include "base/text/chart.h"

#include <math.h>
#include <stdlib.h>

static int ring_of_stay(const weft_registration *r, int stay)
{
    return weft_ubo81_ring(r->survey.view[r->survey.stay[stay].view].theta_rad);
}

/* Fraction of the texels of the photographs of a ring that are saturated. */
static double saturated_fraction(const weft_registration *r, int ring)
{
    double sum = 0;
    int count = 0;
    for (int stay = 0; stay < r->survey.stay_count; stay++) {
        const weft_stay *one = &r->survey.stay[stay];
        if ((ring >= 0 && ring_of_stay(r, stay) != ring) || r->used[stay] == 0)
            continue;
        for (int i = 0; i < one->count; i++)
            sum += (double)r->saturated[one->shot[i]];
        count += r->used[stay];
    }
    return count ? sum / count : 0;
}

weft_code weft_ring_summarise(const weft_session *session, const weft_registration *r, int ring,
                              weft_ring_summary *summary, weft_error *error)
{
    *summary = (weft_ring_summary){.saturated = saturated_fraction(r, ring)};
    size_t stays = (size_t)r->survey.stay_count;
    double *uncertainty = calloc(3 * stays, sizeof *uncertainty);
    if (!uncertainty)
        return weft_fail_memory(error, "the stays of a ring", 3 * stays * sizeof *uncertainty);
    double *correlation = uncertainty + stays, *shift = correlation + stays;
    int count = 0;
    for (int stay = 0; stay < r->survey.stay_count; stay++) {
        if (ring >= 0 && ring_of_stay(r, stay) != ring)
            continue;
        summary->stays++;
        if (r->pose[stay].source == WEFT_POSE_FAILED) {
            summary->failed++;
            continue;
        }
        uncertainty[count] = weft_registration_uncertainty_texels(session, r, stay);
        correlation[count] = r->pose[stay].correlation;
        shift[count++] = r->pose[stay].shift_mm;
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
    if (r->fault_count == 0 && r->failed_stays == 0)
        return;
    fputs("<h2>What could not be used</h2>\n<table>", page->html);
    weft_page_columns(page, "what|:why");
    for (int stay = 0; stay < r->survey.stay_count; stay++) {
        const weft_stay *one = &r->survey.stay[stay];
        if (r->pose[stay].source != WEFT_POSE_FAILED)
            continue;
        fprintf(page->html,
                "<tr class=\"bad\"><td class=\"text\">view %s, stay %d, %d photographs</td><td class=\"text\">",
                weft_view_name_of(r->survey.view[one->view]).text, one->stay, one->count);
        weft_page_text(page, r->pose[stay].remark);
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

/* What is drawn of a stay. */
typedef enum stay_quantity { STAY_ERROR, STAY_SHIFT } stay_quantity;

/* A dot for every stay that did not fail, over the angle of its view. */
static weft_code draw_stays(weft_page *page, const weft_session *session, const weft_registration *r,
                            stay_quantity quantity, weft_error *error)
{
    int count = 0;
    double(*point)[2] = calloc((size_t)r->survey.stay_count + 1, sizeof *point);
    if (!point)
        return weft_fail_memory(error, "stays", (size_t)r->survey.stay_count * sizeof *point);
    for (int stay = 0; stay < r->survey.stay_count; stay++) {
        if (r->pose[stay].source == WEFT_POSE_FAILED)
            continue;
        point[count][0] = weft_deg_of_rad(r->survey.view[r->survey.stay[stay].view].theta_rad);
        point[count++][1] = quantity == STAY_ERROR ? 1000 * weft_registration_uncertainty_texels(session, r, stay)
                                                   : r->pose[stay].shift_mm;
    }
    const weft_chart_series stays = {.point_count = count, .point = (const double(*)[2])point};
    const weft_chart chart = {quantity == STAY_ERROR ? "Random error of every stay" : "Shift of every stay",
                              {"view from the normal", "\u00b0", 0, 75, 0},
                              {quantity == STAY_ERROR ? "thousandths of a texel" : "mm", "", 0, 0.1, 0},
                              1,
                              &stays};
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
                      "view|stays|failed|error, median (texel/1000)|worst|correlation, median|worst|shift, median "
                      "(mm)|worst|saturated (%)");
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        weft_ring_summary s;
        WEFT_TRY(weft_ring_summarise(session, r, ring, &s, error));
        if (s.stays == 0)
            continue;
        fprintf(page->html,
                "<tr%s><td>%d\u00b0</td><td>%d</td><td>%d</td><td>%.2f</td><td>%.2f</td><td>%.4f</td><td>%.4f</td>"
                "<td>%.3f</td><td>%.3f</td><td>%.3f</td></tr>\n",
                s.failed ? " class=\"weak\"" : "", 15 * ring, s.stays, s.failed, 1000 * s.median_uncertainty,
                1000 * s.worst_uncertainty, s.median_correlation, s.worst_correlation, s.median_shift_mm,
                s.worst_shift_mm, 100 * s.saturated);
    }
    fputs("</table>\n<div class=\"plots\">\n", page->html);
    WEFT_TRY(draw_stays(page, session, r, STAY_ERROR, error));
    WEFT_TRY(draw_stays(page, session, r, STAY_SHIFT, error));
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

static void write_stay(weft_page *page, const weft_session *session, const weft_registration *r, int stay)
{
    const weft_stay *one = &r->survey.stay[stay];
    const weft_view_pose *pose = &r->pose[stay];
    weft_angles view = r->survey.view[one->view];
    const char *class = pose->source == WEFT_POSE_FAILED                ? " class=\"bad\""
                        : pose->remark[0] || r->used[stay] < one->count ? " class=\"weak\""
                                                                        : "";
    fprintf(page->html,
            "<tr%s><td>%s</td><td>%.1f</td><td>%.1f</td><td>%d</td><td>%d of %d</td><td class=\"text\">%s</td>", class,
            weft_view_name_of(view).text, weft_deg_of_rad(view.theta_rad), weft_deg_of_rad(view.phi_rad), one->stay,
            r->used[stay], one->count, weft_pose_source_name(pose));
    fprintf(page->html, "<td>%d</td><td>%.2f</td><td>%.4f</td><td>%.2f</td><td>%.3f</td><td class=\"text\">",
            pose->marker_count, pose->marker_rms_px, pose->correlation,
            1000 * weft_registration_uncertainty_texels(session, r, stay), pose->shift_mm);
    weft_page_text(page, pose->remark);
    fputs("</td></tr>\n", page->html);
}

void weft_write_stays(weft_page *page, const weft_session *session, const weft_registration *r)
{
    fputs("<h2>Every view</h2>\n<table class=\"long\">", page->html);
    weft_page_columns(
        page, "view|\u03b8\u00b0|\u03c6\u00b0|stay|photographs|:used|markers|markers' RMS (px)|correlation|error "
              "(texel/1000)|shift (mm)|:remark");
    for (int stay = 0; stay < r->survey.stay_count; stay++)
        write_stay(page, session, r, stay);
    fputs("</table>\n", page->html);
}

#include "registration/report/tables.h"

#include "base/numeric/statistics.h"
#include "base/text/chart.h"

#include <math.h>
#include <stdlib.h>

/* Mean of the channels of a white level. */
static double level_of(const weft_white *white)
{
    return (white->level[0] + white->level[1] + white->level[2]) / 3;
}

/* Collects the measured levels of a ring of lights (-1: all) into `level`. */
static int collect_levels(const weft_session *session, const weft_registration *r, int ring, double *level,
                          double *disagreement)
{
    int count = 0;
    for (int shot = 0; shot < session->shot_count; shot++) {
        if (r->white[shot].patches == 0 || (ring >= 0 && weft_ubo81_ring(session->shot[shot].light.theta_rad) != ring))
            continue;
        level[count] = level_of(&r->white[shot]);
        disagreement[count++] = r->white[shot].disagreement;
    }
    return count;
}

static void write_ring(weft_page *page, int ring, double overall, double *level, double *disagreement, int count)
{
    if (count == 0)
        return;
    double median = weft_quantile(level, count, 0.5);
    fprintf(
        page->html,
        "<tr><td>%d\u00b0</td><td>%d</td><td>%.*f</td><td>%+.2f</td><td>%+.2f \u2026 %+.2f</td><td>%.2f</td></tr>\n",
        15 * ring, count, median < 1000, median, 100 * (median / overall - 1),
        100 * (weft_quantile(level, count, 0.05) / median - 1), 100 * (weft_quantile(level, count, 0.95) / median - 1),
        100 * weft_quantile(disagreement, count, 0.5));
}

/* Median level of the measured photographs of a viewpoint; 0 where there is none. */
static double level_of_viewpoint(const weft_registration *r, const weft_viewpoint *viewpoint, double *scratch)
{
    int count = 0;
    for (int i = 0; i < viewpoint->count; i++) {
        if (r->white[viewpoint->shot[i]].patches > 0)
            scratch[count++] = level_of(&r->white[viewpoint->shot[i]]);
    }
    return weft_quantile(scratch, count, 0.5);
}

/* The median white level of every viewpoint against the median of all, over the order in which they were taken. */
static weft_code write_drift(weft_page *page, const weft_registration *r, double overall, double *scratch,
                             weft_error *error)
{
    int count = r->survey.viewpoint_count;
    double(*point)[2] = calloc((size_t)count + 1, sizeof *point);
    if (!point)
        return weft_fail_memory(error, "white levels", (size_t)count * sizeof *point);
    for (int i = 0; i < count; i++) {
        double level = level_of_viewpoint(r, &r->survey.viewpoint[i], scratch);
        point[i][0] = r->survey.viewpoint[i].viewpoint;
        point[i][1] = level > 0 ? 100 * (level / overall - 1) : NAN;
    }
    weft_chart_series viewpoints = {.point_count = count, .point = (const double(*)[2])point};
    weft_chart chart = {"The lamp over the session",
                        {"viewpoint of the camera", "", 0, 0, 1},
                        {"white level against the median", " %", -5, 5, 0},
                        1,
                        &viewpoints};
    weft_chart_write(page, &chart);
    free(point);
    return WEFT_OK;
}

weft_code weft_write_whites(weft_page *page, const weft_session *session, const weft_registration *r, weft_error *error)
{
    size_t shots = (size_t)session->shot_count;
    double *level = calloc(2 * shots, sizeof *level);
    if (!level)
        return weft_fail_memory(error, "white levels", 2 * shots * sizeof *level);
    double *disagreement = level + shots;
    double overall = weft_quantile(level, collect_levels(session, r, -1, level, disagreement), 0.5);
    fputs("<h2>White reference</h2>\n<p>The white level is the raw value above black, per second of exposure, of a "
          "perfect "
          "white diffuser lit along its normal; of a steady lamp it is the same in every photograph.",
          page->html);
    if (r->estimated_whites)
        fprintf(page->html, " In %d photographs no patch could be measured; they use the level of the others.",
                r->estimated_whites);
    fputs("</p>\n<table>", page->html);
    weft_page_columns(page, "light|photographs|white level, median|against all (%)|5th to 95th percentile (%)|patches "
                            "disagree by (%)");
    for (int ring = 0; ring < WEFT_RING_COUNT && overall > 0; ring++)
        write_ring(page, ring, overall, level, disagreement, collect_levels(session, r, ring, level, disagreement));
    fputs("</table>\n", page->html);
    weft_code code = overall > 0 ? write_drift(page, r, overall, level, error) : WEFT_OK;
    free(level);
    return code;
}

#include "registration/report/tables.h"

#include "base/numeric/statistics.h"

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
        "<tr><td>%d&deg;</td><td>%d</td><td>%.5g</td><td>%+.2f</td><td>%+.2f &hellip; %+.2f</td><td>%.2f</td></tr>\n",
        15 * ring, count, median, 100 * (median / overall - 1), 100 * (weft_quantile(level, count, 0.05) / median - 1),
        100 * (weft_quantile(level, count, 0.95) / median - 1), 100 * weft_quantile(disagreement, count, 0.5));
}

/* Median level of the measured photographs of a stay; 0 where there is none. */
static double level_of_stay(const weft_registration *r, const weft_stay *stay, double *scratch)
{
    int count = 0;
    for (int i = 0; i < stay->count; i++) {
        if (r->white[stay->shot[i]].patches > 0)
            scratch[count++] = level_of(&r->white[stay->shot[i]]);
    }
    return weft_quantile(scratch, count, 0.5);
}

/* A dot for every stay: its median white level against the median of all, over the order in which they were taken. */
static void write_drift(weft_page *page, const weft_registration *r, double overall, double *scratch)
{
    enum { width = 1000, height = 160, margin = 40 };
    const double reach = 0.05;
    int last = 1;
    for (int i = 0; i < r->survey.stay_count; i++)
        last = r->survey.stay[i].stay > last ? r->survey.stay[i].stay : last;
    fprintf(page->html, "<svg class=\"chart\" viewBox=\"0 0 %d %d\" font-size=\"12\" fill=\"#5b6675\">", width, height);
    for (int tick = -1; tick <= 1; tick++)
        fprintf(
            page->html,
            "<line x1=\"%d\" x2=\"%d\" y1=\"%d\" y2=\"%d\" stroke=\"#dfe3e8\"/><text x=\"4\" y=\"%d\">%+d %%</text>",
            margin, width - 10, height / 2 - tick * 60, height / 2 - tick * 60, height / 2 - tick * 60 + 4, 5 * tick);
    for (int i = 0; i < r->survey.stay_count; i++) {
        double level = level_of_stay(r, &r->survey.stay[i], scratch);
        double y = weft_clamp((level / overall - 1) / reach, -1.2, 1.2);
        if (level > 0)
            fprintf(page->html, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"#2b6cb0\"/>",
                    margin + 10 + (double)(width - margin - 30) * r->survey.stay[i].stay / last, height / 2 - 60 * y);
    }
    fputs("</svg>\n", page->html);
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
    fputs("</table>\n<p>White level of every stay of the camera, in the order in which they were taken:</p>\n",
          page->html);
    if (overall > 0)
        write_drift(page, r, overall, level);
    free(level);
    return WEFT_OK;
}

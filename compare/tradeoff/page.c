#include "base/text/chart.h"
#include "compare/tradeoff/tradeoff.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME = 64, SHOWN_WIDTH = 96 };

static double error_of(const weft_tradeoff_row *row)
{
    return row->measured.held[WEFT_SAMPLES_ALL].relative_rmse;
}

/* Which texels errors are of. */
static void put_texels(weft_page *page, const weft_tradeoff *tradeoff)
{
    bool is_spread = tradeoff->measured_texels != tradeoff->neighbours || tradeoff->lobe_texels != tradeoff->neighbours;
    if (!is_spread) {
        fprintf(page->html, "<p class=\"note\">Errors are measured on %ld texels in the middle", tradeoff->neighbours);
        return;
    }
    fprintf(page->html,
            "<p class=\"note\">Errors are measured on %ld texels scattered over the dataset (lobes on %ld), as in "
            "the file of a material. Pictures, and the errors of analytic cloth, are of %ld texels in the middle",
            tradeoff->measured_texels, tradeoff->lobe_texels, tradeoff->neighbours);
    if (tradeoff->split_count > 1)
        fprintf(page->html, ". Images were held out %d times, other ones each time", tradeoff->split_count);
}

/* ---- The choice ---- */

/* A model that several presets choose stands there once. */
static void put_choice(weft_page *page, const weft_tradeoff_row *row, int number)
{
    const char *between = "";
    fputs("<tr><td>", page->html);
    for (weft_preset preset = WEFT_PRESET_SMALL; preset <= WEFT_PRESET_BEST; preset++) {
        if (row->is_chosen[preset])
            fprintf(page->html, "%s<b>%s</b>", between, weft_preset_name(preset));
        between = row->is_chosen[preset] ? ", " : between;
    }
    fprintf(page->html,
            "</td><td class=\"text\"><a href=\"#model-%d\">%s</a></td><td>%.0f</td><td>%.2f %%</td><td class=\"text "
            "reason\">",
            number, row->model.name, row->price.bytes, 100 * error_of(row));
    between = "";
    for (weft_preset preset = WEFT_PRESET_SMALL; preset <= WEFT_PRESET_BEST; preset++) {
        if (row->is_chosen[preset])
            fprintf(page->html, "%s%s", between, weft_preset_reason(preset));
        between = row->is_chosen[preset] ? "<br>" : between;
    }
    fprintf(page->html, "</td><td class=\"text\"><code>%s</code></td></tr>\n", row->model.arguments);
}

/* In the order of the presets. */
static void put_choices(weft_page *page, const weft_tradeoff *tradeoff)
{
    const weft_tradeoff_row *before = NULL;
    fputs("<table>\n", page->html);
    weft_page_columns(page, ":preset|:model|bytes|error, not fitted|:chosen for|:weft compress");
    for (weft_preset preset = WEFT_PRESET_SMALL; preset <= WEFT_PRESET_BEST; preset++) {
        for (int i = 0; i < tradeoff->row_count; i++) {
            const weft_tradeoff_row *row = &tradeoff->row[i];
            if (!row->is_chosen[preset] || row == before)
                continue;
            put_choice(page, row, i + 1);
            before = row;
        }
    }
    fputs("</table>\n", page->html);
}

static void put_summary(weft_page *page, const weft_tradeoff *tradeoff)
{
    char held[160];
    weft_tradeoff_print_held(tradeoff, held, sizeof held);
    fprintf(page->html,
            "<p>%d models of %d \u00d7 %d texels and %d photographs. <b>Error</b> is the relative RMSE on photographs "
            "that the model was not fitted to: %s were held out, the same for all models. The table also "
            "has the error on the photographs that the model was fitted to.</p>\n",
            tradeoff->row_count, tradeoff->width, tradeoff->height, tradeoff->image_count, held);
    put_choices(page, tradeoff);
    put_texels(page, tradeoff);
    if (tradeoff->fitted_texels < tradeoff->texels)
        fprintf(page->html, ". Bytes and times of fits are scaled up from %ld texels, which the frames show",
                tradeoff->fitted_texels);
    fprintf(page->html, ". Times were measured on this machine with %d threads. This page took %.0f s. ",
            tradeoff->threads, tradeoff->seconds);
    if (tradeoff->why_not_drawn[0])
        fputs("There are no times of frames: ", page->html);
    else
        fputs("Frames are 730 \u00d7 400 pixels of the drape, every texel, level and direction evaluated, drawn by ",
              page->html);
    weft_page_text(page, tradeoff->why_not_drawn[0] ? tradeoff->why_not_drawn : tradeoff->renderer);
    fputs(". The table as numbers: <a href=\"tradeoff.csv\">tradeoff.csv</a>.</p>\n", page->html);
}

/* ---- Charts ---- */

enum { RINGS = WEFT_PRICED_FAMILIES, FRONT, SERIES };

/* A series holds all rows; those that are not of it have no place. */
typedef struct price_chart {
    double point[SERIES][WEFT_PRICED_MOST][2];
    weft_chart_note note[WEFT_PRICED_MOST];
    char text[WEFT_PRICED_MOST][2 * NAME], target[WEFT_PRICED_MOST][NAME];
} price_chart;

static double x_of(const weft_tradeoff_row *row, int which)
{
    return which == 0 ? row->price.bytes : which == 1 ? row->price.frame_ms : row->price.fit_s;
}

static bool is_of_series(const weft_tradeoff_row *row, int series)
{
    if (series == RINGS)
        return row->is_chosen[WEFT_PRESET_NONE];
    return series == FRONT ? !row->is_beaten && row->model.arguments[0] : (int)row->model.family == series;
}

static void add_row(const weft_tradeoff *tradeoff, int which, int i, price_chart *chart)
{
    const weft_tradeoff_row *row = &tradeoff->row[i];
    char presets[NAME];
    weft_tradeoff_print_presets(row, presets, sizeof presets);
    snprintf(chart->text[i], sizeof chart->text[i], "%s%s%s", presets, presets[0] ? ": " : "", row->model.name);
    snprintf(chart->target[i], NAME, "model-%d", i + 1);
    chart->note[i] = (weft_chart_note){chart->text[i], chart->target[i]};
    for (int s = 0; s < SERIES; s++) {
        chart->point[s][i][0] = is_of_series(row, s) ? x_of(row, which) : NAN;
        chart->point[s][i][1] = 100 * error_of(row);
    }
}

/* What has no place comes last. */
static int compare_x(const void *left, const void *right)
{
    const double *a = left, *b = right;
    return isnan(*a) || isnan(*b) ? isnan(*a) - isnan(*b) : (*a > *b) - (*a < *b);
}

static void put_chart(weft_page *page, const weft_tradeoff *tradeoff, int which)
{
    static const char *const title[] = {"Error by size", "Error by time of a frame", "Error by time of the fit"};
    static const char *const x_label[] = {"bytes of the file", "ms a frame", "seconds"};
    price_chart chart;
    weft_chart_series series[SERIES];
    for (int i = 0; i < tradeoff->row_count; i++)
        add_row(tradeoff, which, i, &chart);
    qsort(chart.point[FRONT], (size_t)tradeoff->row_count, sizeof *chart.point[FRONT], compare_x);
    for (int s = 0; s < FRONT; s++)
        series[s] = (weft_chart_series){s == RINGS ? "chosen by a preset" : weft_priced_family_name(s),
                                        s == RINGS ? 1 : s,
                                        s == RINGS ? WEFT_CHART_RINGS : WEFT_CHART_POINTS,
                                        tradeoff->row_count,
                                        (const double(*)[2])chart.point[s],
                                        chart.note};
    series[FRONT] = (weft_chart_series){"not beaten",
                                        WEFT_PRICED_FAMILIES,
                                        WEFT_CHART_STEPS,
                                        tradeoff->row_count,
                                        (const double(*)[2])chart.point[FRONT],
                                        NULL};
    weft_chart_write_logarithmic(page, &(weft_chart){title[which],
                                                     {x_label[which], "", 0, 0, 0},
                                                     {"relative RMSE, not fitted", " %", 0, 0, 0},
                                                     which == 0 ? SERIES : FRONT,
                                                     series});
}

static void put_charts(weft_page *page, const weft_tradeoff *tradeoff)
{
    fputs("<div class=\"plots\">\n", page->html);
    for (int which = 0; which < 3; which++)
        put_chart(page, tradeoff, which);
    fputs(
        "</div>\n<p class=\"note\">Both axes are logarithmic; lower and further left is better. The staircase joins "
        "the models of <code>weft compress</code> that no other of them beats in both bytes and error. Rings mark the "
        "presets. Click on a point to see its row.</p>\n",
        page->html);
}

/* ---- Table ---- */

static void put_number(weft_page *page, const char *format, double value, bool is_known)
{
    fputs("<td>", page->html);
    if (is_known)
        fprintf(page->html, format, value);
    fputs("</td>", page->html);
}

static void put_errors(weft_page *page, const weft_held_error *m)
{
    const weft_error_summary *all = &m->held[WEFT_SAMPLES_ALL];
    put_number(page, "<b>%.2f %%</b>", 100 * all->relative_rmse, true);
    put_number(page, "%.2f %%", 100 * m->fitted[WEFT_SAMPLES_ALL].relative_rmse, m->fitted[WEFT_SAMPLES_ALL].count > 0);
    put_number(page, "%.1f %%", 100 * m->interval_width, m->interval_width > 0);
    put_number(page, "%.1f %%", 100 * all->median_relative, true);
    put_number(page, "%.1f %%", 100 * all->percentile80_relative, true);
    for (int kind = WEFT_SAMPLES_GRAZING; kind < WEFT_SAMPLE_KINDS; kind++)
        put_number(page, "%.2f %%", 100 * m->held[kind].relative_rmse, m->held[kind].count > 0);
    put_number(page, "%.2f", m->quality.psnr_db, m->picture_count > 0);
    put_number(page, "%.4f", m->quality.ssim, m->picture_count > 0);
    put_number(page, "%.4f", m->quality.flip, m->picture_count > 0);
}

static void put_name(weft_page *page, const weft_tradeoff_row *row, int number)
{
    char presets[NAME];
    bool is_chosen = row->is_chosen[WEFT_PRESET_NONE];
    weft_tradeoff_print_presets(row, presets, sizeof presets);
    fprintf(page->html, "<tr id=\"model-%d\"%s><td>%d</td><td class=\"text\">%s%s%s%s</td>", number,
            is_chosen ? " class=\"weak\"" : "", number, row->model.name, is_chosen ? " <b>(" : "", presets,
            is_chosen ? ")</b>" : "");
}

/* What a small screen shows without scrolling comes first. */
static void put_row(weft_page *page, const weft_tradeoff_row *row, int number)
{
    const weft_price *price = &row->price;
    bool is_fitted = weft_priced_model_is_fit(&row->model) || price->fit_s > 0;
    put_name(page, row, number);
    put_number(page, "%.0f", price->bytes, true);
    put_errors(page, &row->measured);
    put_number(page, "%.3f", price->flicker, price->has_flicker);
    put_number(page, "%.1f", price->fit_s, is_fitted);
    put_number(page, "%.1f", price->frame_ms, price->frame_ms > 0);
    put_number(page, "%.0f", price->evaluations_a_second, price->evaluations_a_second > 0);
    put_number(page, price->bits_a_texel < 1000 ? "%.1f" : "%.0f", price->bits_a_texel, true);
    fprintf(page->html, "<td>%d</td><td class=\"text\"><code>%s</code></td></tr>\n", price->photograph_count,
            row->model.arguments);
}

static void put_table(weft_page *page, const weft_tradeoff *tradeoff)
{
    fputs("<h2 id=\"prices\">Prices</h2>\n<table class=\"long\">\n", page->html);
    weft_page_columns(page, "|:model|bytes|error, not fitted|fitted|95 % interval|median|80th "
                            "percentile|grazing|highlights|shadows|PSNR dB|"
                            "SSIM|FLIP|flicker|fit, s|ms a frame|evaluations/s|bits a texel|"
                            "photographs|:weft compress");
    for (int i = 0; i < tradeoff->row_count; i++)
        put_row(page, &tradeoff->row[i], i + 1);
    fputs(
        "</table>\n"
        "<p class=\"note\">A row without options of <code>weft compress</code> is for comparison: fewer photographs "
        "stand for a shorter capture. Evaluations: BRDFs at random places and directions, on one thread. "
        "Grazing: view or light is 52.5\u00b0 or more from the normal. "
        "Highlights: the brightest twentieth of the samples of each texel. Shadows: the darkest fifth; their error is "
        "relative to the little light there is. These errors, and PSNR, SSIM and FLIP of pictures, are of photographs "
        "that were not fitted; each texel is a pixel. 95 % interval: the mean width of the interval that holds 95 % of "
        "these samples, relative to the mean sample. Flicker: while a light sweeps across, the brightness of a place "
        "moves so much farther than up and down once; 0 is smooth. BARD, RTI and matrices have no frames, because the "
        "player "
        "does "
        "not draw them.</p>\n",
        page->html);
}

/* ---- Pictures ---- */

static weft_code put_pictures_of(weft_page *page, const weft_tradeoff_row *row, int number, weft_error *error)
{
    char name[NAME], caption[NAME + 96];
    const weft_held_error *m = &row->measured;
    fprintf(page->html, "<div class=\"row\">\n");
    snprintf(name, sizeof name, "model-%d-photograph", number);
    snprintf(caption, sizeof caption, "photograph %d", m->worst_image);
    WEFT_TRY(weft_page_picture(page, name, &m->sample, SHOWN_WIDTH, caption, error));
    snprintf(name, sizeof name, "model-%d", number);
    snprintf(caption, sizeof caption, "%d: %s, error %.1f %%", number, row->model.name, 100 * error_of(row));
    WEFT_TRY(weft_page_picture(page, name, &m->predicted, SHOWN_WIDTH, caption, error));
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

static weft_code put_pictures(weft_page *page, const weft_tradeoff *tradeoff, weft_error *error)
{
    fputs(
        "<h2 id=\"pictures\">Under the worst light</h2>\n<p class=\"note\">For each model, the "
        "held-out photograph with the largest error, and its prediction. Click to enlarge both and to wipe one against "
        "the other.</p>\n<div class=\"pairs\">\n",
        page->html);
    for (int i = 0; i < tradeoff->row_count; i++) {
        if (tradeoff->row[i].measured.picture_count > 0)
            WEFT_TRY(put_pictures_of(page, &tradeoff->row[i], i + 1, error));
    }
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

weft_code weft_tradeoff_write_page(const weft_tradeoff *tradeoff, const char *dataset_path, const char *folder,
                                   weft_error *error)
{
    char title[512];
    const char *slash = strrchr(dataset_path, '/');
    snprintf(title, sizeof title, "What accuracy costs: %s", slash ? slash + 1 : dataset_path);
    weft_page page;
    WEFT_TRY(weft_page_begin(folder, title, &page, error));
    put_summary(&page, tradeoff);
    put_charts(&page, tradeoff);
    put_table(&page, tradeoff);
    weft_code code = put_pictures(&page, tradeoff, error);
    if (code == WEFT_OK)
        return weft_page_finish(&page, error);
    weft_page_abandon(&page);
    return code;
}

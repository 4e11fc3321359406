#include "registration/colour/calibration.h"

#include "base/picture/colour.h"
#include "registration/colour/grey_tone.h"
#include "registration/colour/patches.h"

#include <math.h>
#include <string.h>

enum { WHITE = WEFT_CHART_FIRST_GREY, FEWEST_PATCHES = 18 };

/* Shares of a patch that may be clipped, and of full scale that its white must reach. */
static const double most_clipped = 0.02, least_white = 0.02;

/* RMS of the logarithm of greys that were called linear: a file with a tone curve comes to 0.4 and more. */
static const double largest_linear_misfit = 0.25;

/* CIEDE2000: colours that are none of the chart, and such as a user should look into. */
static const double foreign_difference = 8, poor_difference = 3;

/* A lamp that lights the chart this unevenly is not described by two slopes. */
static const double uneven_lamp = 1.5;

/* ---- What is used ---- */

static void decide_used(const weft_chart_patch patch[WEFT_CHART_PATCHES], weft_colour_report *report,
                        weft_chart_light *chart)
{
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        report->patch[i].name = weft_chart_patch_name[i];
        report->patch[i].unused = patch[i].clipped > most_clipped ? "it is clipped" : NULL;
        memcpy(report->patch[i].pixel, patch[i].pixel, sizeof patch[i].pixel);
        memcpy(chart->decoded.rgb[i], patch[i].light, sizeof chart->decoded.rgb[i]);
        memcpy(report->patch[i].reference, chart->reference.rgb[i], sizeof chart->reference.rgb[i]);
        chart->used[i] = !report->patch[i].unused;
        report->used += chart->used[i];
    }
}

static weft_code check_exposure(const weft_chart_shot *shot, const weft_chart_light *chart, int used, const char *path,
                                weft_error *error)
{
    const double *white = chart->decoded.rgb[WHITE];
    double least = fmin(white[0], fmin(white[1], white[2]));
    if (!chart->used[WHITE])
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': the white patch of the chart is clipped: expose less", path);
    if (shot->is_scaled && !(least >= least_white))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': too dark: the white patch of the chart reaches %.1f %% of full scale, not %.0f %%: "
                         "expose more",
                         path, 100 * least, 100 * least_white);
    if (used < FEWEST_PATCHES)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': %d of the %d patches of the chart are clipped: expose less",
                         path, WEFT_CHART_PATCHES - used, WEFT_CHART_PATCHES);
    return WEFT_OK;
}

/* How well the greys grow with light under the tone curve that is found, and if the file's values were linear. */
static bool compare_tones(const weft_chart_light *chart, double *curved, double *linear)
{
    weft_chart_colours light, encoded;
    weft_grey_tone tone;
    if (!weft_grey_tone_find(&chart->decoded, &chart->reference, chart->used, &tone))
        return false;
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        for (int c = 0; c < 3; c++) {
            light.rgb[i][c] = weft_grey_tone_light(&tone, chart->decoded.rgb[i][c]);
            encoded.rgb[i][c] = (double)weft_srgb_of_linear((float)chart->decoded.rgb[i][c]);
        }
    }
    *curved = weft_grey_misfit(&light, &chart->reference, chart->used);
    *linear = weft_grey_misfit(&encoded, &chart->reference, chart->used);
    return true;
}

static weft_code check_tone(const weft_chart_light *chart, const char *path, weft_error *error)
{
    double misfit = weft_grey_misfit(&chart->decoded, &chart->reference, chart->used), curved, linear;
    if (!chart->has_tone && misfit > largest_linear_misfit)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': the greys of the chart are not proportional to light (RMS error of their logarithms: "
                         "%.2f), so the values are not linear",
                         path, misfit);
    if (chart->has_tone && compare_tones(chart, &curved, &linear) && linear < curved)
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "'%s': the greys of the chart are proportional to light, so the values are linear; pass --linear", path);
    return WEFT_OK;
}

/* ---- The matrix ---- */

static weft_colour_residual summarise(const weft_chart_light *chart, const double difference[WEFT_CHART_PATCHES])
{
    weft_colour_residual residual = {0, 0};
    int count = 0;
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        residual.mean += chart->used[i] ? difference[i] : 0;
        residual.worst = fmax(residual.worst, chart->used[i] ? difference[i] : 0);
        count += chart->used[i];
    }
    residual.mean /= count;
    return residual;
}

/* Each patch that is used, by the matrix of the others. */
static weft_code leave_out(const weft_chart_light *chart, int terms, const char *path,
                           double difference[WEFT_CHART_PATCHES], weft_error *error)
{
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        weft_colour_fit fit;
        difference[i] = 0;
        if (!chart->used[i])
            continue;
        WEFT_TRY(weft_colour_fit_run(chart, terms, i, path, &fit, error));
        difference[i] = fit.difference[i];
    }
    return WEFT_OK;
}

/* With so many terms, if that predicts patches left out better than what the report has already. */
static weft_code try_terms(const weft_chart_light *chart, int terms, const char *path, weft_colour_report *report,
                           weft_colour_fit *best, weft_error *error)
{
    double difference[WEFT_CHART_PATCHES];
    weft_colour_fit fit;
    WEFT_TRY(weft_colour_fit_run(chart, terms, -1, path, &fit, error));
    WEFT_TRY(leave_out(chart, terms, path, difference, error));
    weft_colour_residual left_out = summarise(chart, difference);
    if (report->colour.terms && left_out.mean >= report->colour.left_out.mean)
        return WEFT_OK;
    *best = fit;
    report->colour = (weft_colour){.terms = terms, .left_out = left_out, .fitted = summarise(chart, fit.difference)};
    memcpy(report->colour.matrix, fit.matrix, sizeof fit.matrix);
    for (int i = 0; i < WEFT_CHART_PATCHES; i++)
        report->patch[i].left_out = difference[i];
    return WEFT_OK;
}

static weft_code choose(const weft_chart_light *chart, int terms, const char *path, weft_colour_report *report,
                        weft_colour_fit *fit, weft_error *error)
{
    if (terms != WEFT_COLOUR_ROOT_TERMS)
        WEFT_TRY(try_terms(chart, WEFT_COLOUR_LINEAR_TERMS, path, report, fit, error));
    if (terms != WEFT_COLOUR_LINEAR_TERMS)
        WEFT_TRY(try_terms(chart, WEFT_COLOUR_ROOT_TERMS, path, report, fit, error));
    return WEFT_OK;
}

/* ---- The report ---- */

static void tell_patches(const weft_colour_fit *fit, weft_colour_report *report)
{
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        weft_colour_patch *patch = &report->patch[i];
        for (int c = 0; c < 3; c++) {
            patch->camera[c] = fit->camera.rgb[i][c];
            patch->srgb[c] = fit->srgb.rgb[i][c];
        }
        patch->fitted = fit->difference[i];
    }
    report->lamp_range = exp(2 * fabs(fit->slope[0]) + 4.0 / 3 * fabs(fit->slope[1]));
}

static weft_code warn(weft_colour_report *r, weft_error *error)
{
    if (r->colour.left_out.mean > poor_difference)
        WEFT_TRY(weft_lines_add(&r->warnings, error,
                                "the error on left-out colours is %.1f CIEDE2000; a raw file does better than a JPEG, "
                                "and a lamp of full spectrum better than one with gaps",
                                r->colour.left_out.mean));
    if (r->lamp_range > uneven_lamp)
        WEFT_TRY(weft_lines_add(&r->warnings, error,
                                "the lamp lights one corner of the chart %.2f times as much as another: move it away",
                                r->lamp_range));
    return WEFT_OK;
}

static weft_code check_colours(const weft_colour_report *report, const char *path, weft_error *error)
{
    if (report->colour.fitted.mean <= foreign_difference)
        return WEFT_OK;
    return weft_fail(error, WEFT_BAD_INPUT,
                     "'%s': the colours are not those of the chart: they differ by %.1f CIEDE2000 after the best "
                     "matrix; is it the chart of --chart, uncovered, in one light?",
                     path, report->colour.fitted.mean);
}

static weft_code calibrate(const weft_chart_shot *shot, const char *path, const weft_colour_settings *settings,
                           weft_colour_report *report, weft_error *error)
{
    weft_chart_patch patch[WEFT_CHART_PATCHES];
    weft_chart_light chart = {.has_tone = shot->has_tone, .reference = weft_chart_reference(settings->chart)};
    weft_colour_fit fit = {0};
    WEFT_TRY(weft_chart_find(shot, path, settings->chart, patch, error));
    decide_used(patch, report, &chart);
    WEFT_TRY(check_exposure(shot, &chart, report->used, path, error));
    WEFT_TRY(check_tone(&chart, path, error));
    WEFT_TRY(choose(&chart, settings->terms, path, report, &fit, error));
    WEFT_TRY(check_colours(report, path, error));
    tell_patches(&fit, report);
    return warn(report, error);
}

weft_code weft_colour_calibrate(const char *path, const weft_colour_settings *settings, weft_colour_report *report,
                                weft_error *error)
{
    weft_chart_shot shot;
    *report = (weft_colour_report){0};
    WEFT_TRY(weft_chart_shot_read(path, settings->linear, &shot, error));
    weft_code code = calibrate(&shot, path, settings, report, error);
    weft_image_free(&shot.light);
    return code;
}

void weft_colour_report_free(weft_colour_report *report)
{
    weft_lines_free(&report->warnings);
}

#include "registration/colour/calibration.h"

#include "base/numeric/statistics.h"
#include "registration/colour/difference.h"
#include "registration/colour/grey_tone.h"
#include "registration/pose/normal_equations.h"

#include <math.h>
#include <string.h>

/* Unknowns: of each row the terms but the last, the sum of a row, and the slope. */
enum { ROUNDS = 20, LIGHT_GREYS = 4, MOST_UNKNOWNS = 3 * (WEFT_COLOUR_ROOT_TERMS - 1) + 3 };

/* CIEDE2000 from which a patch counts less. */
static const double usual_difference = 2;

/* ---- Light and white ---- */

/* Left to right and top to bottom, half the width of the chart being 1. */
static void place_of(int patch, double place[2])
{
    place[0] = (patch % WEFT_CHART_COLUMNS - 2.5) / 3;
    place[1] = (patch / WEFT_CHART_COLUMNS - 1.5) / 3;
}

static weft_code find_light(const weft_chart_light *chart, const bool used[WEFT_CHART_PATCHES], const char *path,
                            weft_chart_colours *light, weft_error *error)
{
    weft_grey_tone tone = {{0}};
    if (chart->has_tone && !weft_grey_tone_find(&chart->decoded, &chart->reference, used, &tone))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': fewer than %d greys of the chart can be used", path,
                         WEFT_GREY_TONE_FEWEST);
    for (int i = 0; i < WEFT_CHART_PATCHES; i++)
        for (int c = 0; c < 3; c++)
            light->rgb[i][c] = weft_grey_tone_light(&tone, chart->decoded.rgb[i][c]);
    return WEFT_OK;
}

/* Mean without the highest and the lowest, where there are more than two; sorts. */
static double middle_of(double *value, int count)
{
    double low = weft_quantile(value, (size_t)count, 0), high = weft_quantile(value, (size_t)count, 1), sum = 0;
    for (int i = 0; i < count; i++)
        sum += value[i];
    return count > 2 ? (sum - low - high) / (count - 2) : sum / count;
}

/* What each channel shows of a perfect white diffuser, and false where no grey is light enough to tell. */
static bool find_white(const weft_chart_colours *light, const weft_chart_colours *reference,
                       const bool used[WEFT_CHART_PATCHES], double white[3])
{
    for (int c = 0; c < 3; c++) {
        double ratio[LIGHT_GREYS];
        int count = 0;
        for (int i = WEFT_CHART_FIRST_GREY; i < WEFT_CHART_FIRST_GREY + LIGHT_GREYS; i++) {
            if (used[i] && light->rgb[i][c] > 0)
                ratio[count++] = log(light->rgb[i][c] / reference->rgb[i][c]);
        }
        if (count == 0)
            return false;
        white[c] = exp(middle_of(ratio, count));
    }
    return true;
}

/* ---- One patch ---- */

static void terms_of(const weft_colour_fit *fit, const double light[3], int patch, double term[WEFT_COLOUR_ROOT_TERMS])
{
    double place[2], rgb[3];
    place_of(patch, place);
    double lamp = exp(fit->slope[0] * place[0] + fit->slope[1] * place[1]);
    for (int c = 0; c < 3; c++)
        rgb[c] = light[c] / (fit->white[c] * lamp);
    weft_colour_terms(fit->terms, rgb, term);
}

static void predict(const weft_chart_colours *light, const weft_chart_colours *reference, weft_colour_fit *fit)
{
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        double term[WEFT_COLOUR_ROOT_TERMS], lab[3], wanted[3];
        terms_of(fit, light->rgb[i], i, term);
        for (int c = 0; c < 3; c++) {
            fit->camera.rgb[i][c] = term[c];
            fit->srgb.rgb[i][c] = 0;
            for (int k = 0; k < fit->terms; k++)
                fit->srgb.rgb[i][c] += fit->matrix[c][k] * term[k];
        }
        weft_lab_of_linear_srgb(fit->srgb.rgb[i], lab);
        weft_lab_of_linear_srgb(reference->rgb[i], wanted);
        fit->difference[i] = weft_ciede2000(lab, wanted);
    }
}

/* ---- Least squares ---- */

/* How channel `channel` of the colour changes with each unknown. Rows have the sum s: their last term is s less the
 * others. Light that grows with the slope is a lamp that does, so the colour falls. */
static void derivatives(const weft_colour_fit *fit, const double term[WEFT_COLOUR_ROOT_TERMS], const double colour[3],
                        int patch, int channel, double row[MOST_UNKNOWNS])
{
    int free_terms = fit->terms - 1, first = channel * free_terms;
    double place[2];
    place_of(patch, place);
    memset(row, 0, MOST_UNKNOWNS * sizeof *row);
    for (int k = 0; k < free_terms; k++)
        row[first + k] = term[k] - term[free_terms];
    row[3 * free_terms] = term[free_terms];
    for (int d = 0; d < 2; d++)
        row[3 * free_terms + 1 + d] = -colour[channel] * place[d];
}

static void add_patch(const weft_colour_fit *fit, const double light[3], const double wanted[3], int patch,
                      double weight, weft_normal_equations *equations)
{
    double term[WEFT_COLOUR_ROOT_TERMS], metric[3][3], row[3][MOST_UNKNOWNS];
    terms_of(fit, light, patch, term);
    weft_ciede2000_metric(wanted, metric);
    for (int c = 0; c < 3; c++)
        derivatives(fit, term, wanted, patch, c, row[c]);
    for (int m = 0; m < 3; m++) {
        double whole[WEFT_UNKNOWNS_LIMIT] = {0}, right = 0;
        for (int c = 0; c < 3; c++)
            right += metric[m][c] * wanted[c];
        for (int i = 0; i < MOST_UNKNOWNS; i++)
            whole[i] = metric[m][0] * row[0][i] + metric[m][1] * row[1][i] + metric[m][2] * row[2][i];
        weft_normal_equations_add(equations, whole, right, weight);
    }
}

/* The sum of the rows is exposure that the greys have missed: it goes into the white. */
static void adopt(const double solution[MOST_UNKNOWNS], weft_colour_fit *fit)
{
    int free_terms = fit->terms - 1;
    double sum = solution[3 * free_terms];
    for (int c = 0; c < 3; c++) {
        fit->matrix[c][free_terms] = 1;
        for (int k = 0; k < free_terms; k++) {
            fit->matrix[c][k] = solution[c * free_terms + k] / sum;
            fit->matrix[c][free_terms] -= fit->matrix[c][k];
        }
        fit->white[c] /= sum;
    }
    for (int d = 0; d < 2; d++)
        fit->slope[d] += solution[3 * free_terms + 1 + d];
}

static bool improve(const weft_chart_colours *light, const weft_chart_colours *reference,
                    const bool used[WEFT_CHART_PATCHES], bool is_first, weft_colour_fit *fit)
{
    weft_normal_equations equations = {0};
    double solution[MOST_UNKNOWNS];
    int unknowns = 3 * (fit->terms - 1) + 3;
    for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
        double off = is_first ? 0 : fit->difference[i] / usual_difference;
        if (used[i])
            add_patch(fit, light->rgb[i], reference->rgb[i], i, 1 / (1 + off * off), &equations);
    }
    if (!weft_normal_equations_factor(&equations, unknowns))
        return false;
    weft_normal_equations_solve(&equations, unknowns, solution);
    if (!(solution[unknowns - 3] > 0))
        return false;
    adopt(solution, fit);
    predict(light, reference, fit);
    return true;
}

weft_code weft_colour_fit_run(const weft_chart_light *chart, int terms, int but, const char *path, weft_colour_fit *fit,
                              weft_error *error)
{
    weft_chart_colours light;
    bool used[WEFT_CHART_PATCHES];
    memcpy(used, chart->used, sizeof used);
    if (but >= 0)
        used[but] = false;
    *fit = (weft_colour_fit){.terms = terms};
    WEFT_TRY(find_light(chart, used, path, &light, error));
    if (!find_white(&light, &chart->reference, used, fit->white))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': none of the light greys of the chart can be used", path);
    for (int round = 0; round < ROUNDS; round++) {
        if (!improve(&light, &chart->reference, used, round == 0, fit))
            return weft_fail(error, WEFT_BAD_INPUT,
                             "'%s': the patches of the chart determine no colour matrix (singular equations)", path);
    }
    return WEFT_OK;
}

#include "registration/colour/grey_tone.h"

#include "base/picture/colour.h"
#include "registration/pose/normal_equations.h"

#include <math.h>

enum { UNKNOWNS = 3 + WEFT_GREY_TONE_TERMS };

static const double darkest = 1e-4;

double weft_grey_misfit(const weft_chart_colours *light, const weft_chart_colours *reference,
                        const bool used[WEFT_CHART_PATCHES])
{
    double left = 0, count = 0;
    for (int c = 0; c < 3; c++) {
        double sum = 0, squares = 0, greys = 0;
        for (int i = WEFT_CHART_FIRST_GREY; i < WEFT_CHART_PATCHES - 1; i++) {
            double off = log(fmax(light->rgb[i][c], darkest) / reference->rgb[i][c]);
            sum += used[i] ? off : 0;
            squares += used[i] ? off * off : 0;
            greys += used[i];
        }
        left += fmax(0, squares - sum * sum / greys);
        count += greys;
    }
    return sqrt(left / count);
}

static double exponent(const weft_grey_tone *tone, double decoded)
{
    double sum = 0, x = 2 * (double)weft_srgb_of_linear((float)decoded) - 1, power = x;
    for (int k = 0; k < WEFT_GREY_TONE_TERMS; k++, power *= x)
        sum += tone->term[k] * power;
    return sum;
}

double weft_grey_tone_light(const weft_grey_tone *tone, double decoded)
{
    return decoded * exp(exponent(tone, decoded));
}

/* A grey in a channel: gain[c] - sum of the terms = log decoded - log reference. */
static void add_grey(int channel, double decoded, double reference, weft_normal_equations *equations)
{
    double row[WEFT_UNKNOWNS_LIMIT] = {0}, value = fmax(decoded, darkest);
    double x = 2 * (double)weft_srgb_of_linear((float)value) - 1, power = x;
    row[channel] = 1;
    for (int k = 0; k < WEFT_GREY_TONE_TERMS; k++, power *= x)
        row[3 + k] = -power;
    weft_normal_equations_add(equations, row, log(value / reference), 1);
}

bool weft_grey_tone_find(const weft_chart_colours *decoded, const weft_chart_colours *reference,
                         const bool used[WEFT_CHART_PATCHES], weft_grey_tone *tone)
{
    weft_normal_equations equations = {0};
    double found[UNKNOWNS];
    int greys = 0;
    *tone = (weft_grey_tone){0};
    for (int i = WEFT_CHART_FIRST_GREY; i < WEFT_CHART_PATCHES; i++) {
        greys += used[i];
        for (int c = 0; used[i] && c < 3; c++)
            add_grey(c, decoded->rgb[i][c], reference->rgb[i][c], &equations);
    }
    if (greys < WEFT_GREY_TONE_FEWEST || !weft_normal_equations_factor(&equations, UNKNOWNS))
        return false;
    weft_normal_equations_solve(&equations, UNKNOWNS, found);
    for (int k = 0; k < WEFT_GREY_TONE_TERMS; k++)
        tone->term[k] = found[3 + k];
    return true;
}

#include "registration/colour/grey_tone.h"

#include "base/numeric/cholesky.h"
#include "base/picture/colour.h"

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

/* The equation of a grey in a channel: gain[c] - sum of the terms = log decoded - log reference. */
static void add_equation(int channel, double decoded, double right, double *matrix, double vector[UNKNOWNS])
{
    double row[UNKNOWNS] = {0}, x = 2 * (double)weft_srgb_of_linear((float)decoded) - 1, power = x;
    row[channel] = 1;
    for (int k = 0; k < WEFT_GREY_TONE_TERMS; k++, power *= x)
        row[3 + k] = -power;
    for (int i = 0; i < UNKNOWNS; i++) {
        vector[i] += row[i] * right;
        for (int j = 0; j < UNKNOWNS; j++)
            matrix[i * UNKNOWNS + j] += row[i] * row[j];
    }
}

bool weft_grey_tone_find(const weft_chart_colours *decoded, const weft_chart_colours *reference,
                         const bool used[WEFT_CHART_PATCHES], weft_grey_tone *tone)
{
    double matrix[UNKNOWNS * UNKNOWNS] = {0}, vector[UNKNOWNS] = {0};
    int greys = 0;
    *tone = (weft_grey_tone){0};
    for (int i = WEFT_CHART_FIRST_GREY; i < WEFT_CHART_PATCHES; i++) {
        greys += used[i];
        for (int c = 0; used[i] && c < 3; c++) {
            double value = fmax(decoded->rgb[i][c], darkest);
            add_equation(c, value, log(value / reference->rgb[i][c]), matrix, vector);
        }
    }
    if (greys < WEFT_GREY_TONE_FEWEST || !weft_cholesky_factor(UNKNOWNS, UNKNOWNS, matrix))
        return false;
    weft_cholesky_solve(UNKNOWNS, UNKNOWNS, matrix, vector);
    for (int k = 0; k < WEFT_GREY_TONE_TERMS; k++)
        tone->term[k] = vector[3 + k];
    return true;
}

#include "compress/texel/pack.h"

#include "compress/fit/workspace.h"

#include <math.h>
#include <string.h>

#define LARGEST_HALF 65504.0
#define SHARP_EXPONENT 40 /* from here on rounding C changes C^N by more than 1 % */

weft_frame weft_pack_frame(const weft_frame *frame, int16_t code[3])
{
    weft_frame_encode(frame, code);
    return weft_frame_decode(code);
}

static weft_half half_of(double value)
{
    return weft_half_of_float((float)fmin(fmax(value, -LARGEST_HALF), LARGEST_HALF));
}

static double real_of(weft_half half)
{
    return (double)weft_float_of_half(half);
}

/* A^(1/N) c, with A in the units of the dataset. */
static void round_lobe(const weft_fit_lobe *lobe, double scale, weft_half packed[4])
{
    double amplitude = lobe->amplitude * scale;
    packed[3] = half_of(exp(lobe->log_exponent));
    double size = amplitude > 0 ? exp(log(amplitude) / real_of(packed[3])) : 0;
    for (int k = 0; k < 3; k++)
        packed[k] = half_of(size * lobe->c[k]);
}

static weft_fit_lobe unround_lobe(const weft_half packed[4], double scale)
{
    weft_fit_lobe lobe = {.c = {real_of(packed[0]), real_of(packed[1]), real_of(packed[2])},
                          .log_exponent = log(fmax(real_of(packed[3]), 1))};
    double largest = fabs(lobe.c[weft_lobe_fixed(&lobe)]);
    if (!(largest > 0))
        return (weft_fit_lobe){.c = {0, 0, 1}};
    lobe.amplitude = exp(real_of(packed[3]) * log(largest)) / scale;
    for (int k = 0; k < 3; k++)
        lobe.c[k] /= largest;
    return lobe;
}

weft_fit weft_unpack(const weft_packed *packed, int lobe_count, const weft_frame *frame, double scale)
{
    weft_fit fit = {.diffuse = real_of(packed->diffuse) / scale, .lobe_count = lobe_count, .frame = *frame};
    for (int i = 0; i < lobe_count; i++)
        fit.lobe[i] = unround_lobe(packed->lobe[i], scale);
    return fit;
}

static int sharpest_lobe(const weft_fit *fit)
{
    int sharpest = -1;
    for (int i = 0; i < fit->lobe_count; i++) {
        if (fit->lobe[i].amplitude > 0 && fit->lobe[i].log_exponent > log(SHARP_EXPONENT) &&
            (sharpest < 0 || fit->lobe[i].log_exponent > fit->lobe[sharpest].log_exponent))
            sharpest = i;
    }
    return sharpest;
}

/* The scale that moves from T to rho and C, at least the largest T. Where a lobe is sharp it grows a little further, to
 * where the size of that lobe is a half float exactly. */
static double choose_scale(const weft_fit *fit, double sample_scale, double largest_t)
{
    int sharpest = sharpest_lobe(fit);
    if (sharpest < 0)
        return largest_t;
    double exponent = real_of(half_of(exp(fit->lobe[sharpest].log_exponent)));
    double size = exp(log(fit->lobe[sharpest].amplitude * sample_scale * largest_t) / exponent);
    weft_half rounded = half_of(size);
    if (real_of(rounded) < size)
        rounded++;
    double growth = exp(exponent * log(real_of(rounded) / size));
    return growth < 2 ? largest_t * growth : largest_t;
}

/* The T that becomes code 255. Nearly always the largest; but one view in which the model almost vanishes must not cost
 * the others their resolution, so that smaller ones are tried and judged by the squared error they leave. */
static double largest_table(const weft_bundle *bundle, const double *table, const double *energy)
{
    double largest = 0, best = 0, least = INFINITY;
    for (int view = 0; view < bundle->view_count; view++)
        largest = fmax(largest, table[view]);
    for (int halvings = 0; halvings < 6 && largest > 0; halvings++) {
        double candidate = ldexp(largest, -halvings), loss = 0;
        for (int view = 0; view < bundle->view_count; view++) {
            double t = weft_table_of_code(weft_code_of_table(table[view] / candidate)) * candidate;
            loss += energy[view] * (t - table[view]) * (t - table[view]);
        }
        if (loss < least) {
            least = loss;
            best = candidate;
        }
    }
    return best > 0 ? best : 1;
}

/* Freezes the sharp lobes as they will be read; the others stay as fitted, with N rounded. */
static unsigned freeze_sharp(weft_fit *fit, double sample_scale)
{
    unsigned frozen = 0;
    for (int i = 0; i < fit->lobe_count; i++) {
        weft_fit_lobe *lobe = &fit->lobe[i];
        weft_half rounded[4];
        round_lobe(lobe, sample_scale, rounded);
        if (lobe->amplitude > 0 && lobe->log_exponent > log(SHARP_EXPONENT)) {
            *lobe = unround_lobe(rounded, sample_scale);
            frozen |= 1u << i;
        } else {
            lobe->log_exponent = log(fmax(real_of(rounded[3]), 1));
        }
    }
    return frozen;
}

static void scale_amplitudes(weft_fit *fit, double factor)
{
    fit->diffuse *= factor;
    for (int i = 0; i < fit->lobe_count; i++)
        fit->lobe[i].amplitude *= factor;
}

void weft_pack_rounded(const weft_fit *fit, double scale, weft_packed *packed)
{
    memset(packed, 0, sizeof *packed);
    packed->diffuse = half_of(fit->diffuse * scale);
    for (int i = 0; i < fit->lobe_count; i++)
        round_lobe(&fit->lobe[i], scale, packed->lobe[i]);
    for (int i = fit->lobe_count; i < WEFT_MATERIAL_MAX_LOBES; i++)
        packed->lobe[i][3] = half_of(1);
}

/* T by eq. 4 for the rounded lobes, as codes, and as they will be read. */
static void code_table(const weft_bundle *bundle, const weft_trial *trial, const weft_fit *rounded, uint8_t *code,
                       double *decoded)
{
    weft_trial_table(bundle, trial, rounded, decoded);
    for (int view = 0; view < bundle->view_count; view++) {
        code[view] = weft_code_of_table(decoded[view]);
        decoded[view] = weft_table_of_code(code[view]);
    }
}

/* rho and the lobes that are not frozen, solved for again with the table as it will be read, each at most `most`. */
static void solve_rest(const weft_bundle *bundle, const weft_trial *trial, const double *decoded, unsigned frozen,
                       const double *most, weft_fit *rounded)
{
    double low[WEFT_LINEAR_MAX] = {0}, high[WEFT_LINEAR_MAX];
    for (int j = 0; j <= rounded->lobe_count; j++) {
        bool fixed = j > 0 && (frozen >> (j - 1) & 1);
        low[j] = fixed ? rounded->lobe[j - 1].amplitude : 0;
        high[j] = fixed ? low[j] : most[j];
    }
    weft_trial_solve_given_table(bundle, trial, decoded, low, high, rounded);
}

void weft_pack_channel(const weft_bundle *bundle, const weft_samples *samples, int channel,
                       const weft_fit_options *options, weft_fit_workspace *workspace, const weft_fit *fit,
                       const double *table, weft_packed *packed, uint8_t *code)
{
    weft_trial *trial = &workspace->trial[0];
    weft_fit rounded = *fit;
    double *decoded = workspace->scratch[0], *energy = workspace->scratch[1], scale = 1, most[WEFT_LINEAR_MAX];
    memcpy(decoded, table, (size_t)bundle->view_count * sizeof *decoded);
    if (options->table)
        memset(code, 255, (size_t)bundle->view_count);
    if (!(samples->energy[channel] > 0)) {
        weft_pack_rounded(fit, samples->scale, packed);
        return;
    }
    if (options->table) {
        weft_trial_model_energy(bundle, trial, fit, energy);
        scale = choose_scale(fit, samples->scale, largest_table(bundle, table, energy));
        scale_amplitudes(&rounded, scale);
    }
    unsigned frozen = freeze_sharp(&rounded, samples->scale);
    if (frozen) {
        for (int view = 0; view < bundle->view_count; view++)
            workspace->table[view] = (float)(table[view] / scale);
        trial->fit = rounded;
        weft_workspace_pass(bundle, samples, channel, options, workspace->table, trial);
    }
    if (options->table)
        code_table(bundle, trial, &rounded, code, decoded);
    /* Where one view alone needs a large T, what the terms take over from it far exceeds the bound of the fit. */
    for (int j = 0; j < WEFT_LINEAR_MAX; j++)
        most[j] = options->max_amplitude * fmax(scale, 1);
    solve_rest(bundle, trial, decoded, frozen, most, &rounded);
    weft_pack_rounded(&rounded, samples->scale, packed);
}

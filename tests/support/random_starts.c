#include "tests/support/random_starts.h"

#include "compress/fit/workspace.h"
#include "tests/support/alternation.h"
#include "tests/support/synthetic_texel.h"

#include <math.h>

static double between(uint64_t *state, double low, double high)
{
    return low + (high - low) * synthetic_uniform(state);
}

/* Point number `index` of `count` along a spiral (Vogel 1979), evenly by area, down to 80 degrees. */
static weft_vec3 spiral_direction(int index, int count, double turn)
{
    double z = 1 - (index + 0.5) / count * (1 - cos(80 * WEFT_PI / 180)), azimuth = turn + 2.399963229728653 * index;
    double radius = sqrt(1 - z * z);
    return weft_vec3_of(radius * cos(azimuth), radius * sin(azimuth), z);
}

weft_code random_truth_layout(int view_count, int light_count, weft_dataset_layout *layout, weft_error *error)
{
    *layout = (weft_dataset_layout){.width = 1,
                                    .height = 1,
                                    .image_count = view_count * light_count,
                                    .view_count = view_count,
                                    .texel_pitch_mm = 1};
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    for (int view = 0; view < view_count; view++) {
        layout->view[view] = spiral_direction(view, view_count, 0);
        for (int light = 0; light < light_count; light++) {
            layout->light[view * light_count + light] = spiral_direction(light, light_count, 1);
            layout->view_of_image[view * light_count + light] = view;
        }
    }
    return WEFT_OK;
}

/* Any direction of a lobe: a face of the cube, and a place on it. */
static void random_shape(uint64_t *state, double largest_exponent, weft_fit_lobe *lobe)
{
    int face = (int)between(state, 0, 6);
    for (int k = 0; k < 3; k++)
        lobe->c[k] = between(state, -1, 1);
    lobe->c[face / 2] = face % 2 ? -1 : 1;
    lobe->log_exponent = between(state, 0, log(largest_exponent));
}

static double power_of(const weft_fit_lobe *lobe, weft_vec3 light, weft_vec3 view)
{
    double base = lobe->c[0] * light.x * view.x + lobe->c[1] * light.y * view.y + lobe->c[2] * light.z * view.z;
    return base > 0 ? pow(base, exp(lobe->log_exponent)) : 0;
}

/* The root mean square of a lobe in the samples; 0 where it shines in fewer of them than one in a hundred, by the
 * inverse participation of their squares. */
static double strength_of(const weft_dataset_layout *layout, const weft_fit_lobe *lobe)
{
    double sum = 0, sum_of_squares = 0;
    for (int i = 0; i < layout->image_count; i++) {
        double value = layout->light[i].z * power_of(lobe, layout->light[i], layout->view[layout->view_of_image[i]]);
        sum += value * value;
        sum_of_squares += value * value * value * value;
    }
    return sum * sum > 0.01 * layout->image_count * sum_of_squares ? sqrt(sum / layout->image_count) : 0;
}

static double gaussian(uint64_t *state)
{
    double radius = sqrt(-2 * log(1 - synthetic_uniform(state)));
    return radius * cos(2 * WEFT_PI * synthetic_uniform(state));
}

void random_truth_samples(const weft_dataset_layout *layout, uint64_t seed, double noise, float *samples)
{
    uint64_t state = (seed + 1) * 0x9e3779b97f4a7c15u;
    weft_fit_lobe lobe[3];
    int lobe_count = 1 + (int)between(&state, 0, 3);
    double diffuse = between(&state, 0, 1), contrast = between(&state, 0, 1);
    for (int i = 0; i < lobe_count; i++) {
        double strength;
        do {
            random_shape(&state, 200, &lobe[i]);
            strength = strength_of(layout, &lobe[i]);
        } while (!(strength > 1e-3));
        lobe[i].amplitude = between(&state, 0.2, 2) / strength;
    }
    double lean = between(&state, 0, 2 * WEFT_PI);
    for (int i = 0; i < layout->image_count; i++) {
        weft_vec3 light = layout->light[i], view = layout->view[layout->view_of_image[i]];
        double table = exp(-contrast * (cos(lean) * view.x + sin(lean) * view.y + 1 - view.z)), value = diffuse;
        for (int k = 0; k < lobe_count; k++)
            value += lobe[k].amplitude * power_of(&lobe[k], light, view);
        value *= table * light.z * (1 + noise * gaussian(&state));
        for (int channel = 0; channel < 3; channel++)
            samples[3 * i + channel] = (float)value;
    }
}

double random_starts_best(const weft_bundle *bundle, const weft_samples *samples, int channel,
                          const weft_fit_options *options, weft_fit_workspace *workspace, const weft_frame *frame,
                          uint64_t seed, int start_count, weft_fit *best_fit, double *table)
{
    weft_fit_options converged = *options;
    uint64_t state = (seed + 1) * 0xbf58476d1ce4e5b9u;
    double best = INFINITY;
    converged.tolerance = 1e-6;
    converged.max_passes = 400;
    for (int start = 0; start < start_count; start++) {
        weft_trial *now = &workspace->trial[0];
        weft_fit fit = {.lobe_count = options->lobe_count, .frame = *frame};
        for (int i = 0; i < fit.lobe_count; i++)
            random_shape(&state, options->max_exponent, &fit.lobe[i]);
        now->fit = fit;
        weft_workspace_begin_cold(bundle, samples, channel, &converged, now);
        weft_workspace_refine(bundle, samples, channel, &converged, workspace, 0.1);
        weft_workspace_finish(bundle, &converged, now, &fit, table);
        double left = weft_fit_residual(bundle, samples, channel, &fit, table);
        if (left < best) {
            best = left;
            *best_fit = fit;
        }
    }
    return best;
}

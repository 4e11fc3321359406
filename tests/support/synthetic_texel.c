#include "synthetic_texel.h"

#include "btf/direction/direction.h"

#include <math.h>
#include <string.h>

double synthetic_uniform(uint64_t *state)
{
    /* splitmix64 (Steele, Lea and Flood 2014) */
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static double between(uint64_t *state, double low, double high)
{
    return low + (high - low) * synthetic_uniform(state);
}

static double gaussian(uint64_t *state)
{
    double radius = sqrt(-2 * log(1 - synthetic_uniform(state)));
    return radius * cos(2 * WEFT_PI * synthetic_uniform(state));
}

weft_code synthetic_layout(int width, int height, weft_dataset_layout *layout, weft_error *error)
{
    *layout = (weft_dataset_layout){.width = width,
                                    .height = height,
                                    .image_count = WEFT_UBO81_COUNT * WEFT_UBO81_COUNT,
                                    .view_count = WEFT_UBO81_COUNT,
                                    .texel_pitch_mm = 0.1};
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    for (int view = 0; view < WEFT_UBO81_COUNT; view++) {
        layout->view[view] = weft_direction_of_angles(weft_ubo81_angles(view));
        for (int light = 0; light < WEFT_UBO81_COUNT; light++) {
            int image = view * WEFT_UBO81_COUNT + light;
            layout->light[image] = weft_direction_of_angles(weft_ubo81_angles(light));
            layout->view_of_image[image] = view;
        }
    }
    return WEFT_OK;
}

/* Numbers of the material (seed / 64) moved a little by those of the texel. */
typedef struct dice {
    uint64_t material, texel;
} dice;

static dice dice_of_seed(uint64_t seed, uint64_t salt)
{
    return (dice){.material = (seed / 64 + 1) * 7919 + salt * 104729, .texel = (seed + 1) * 15485863 + salt * 32452843};
}

static double draw(dice *state, double low, double high)
{
    double value = between(&state->material, low, high);
    value += between(&state->texel, -0.1, 0.1) * (high - low);
    return weft_clamp(value, low, high);
}

/* ---- Lafortune x T ---- */

static void lafortune_truth(const weft_dataset_layout *layout, uint64_t seed, int channel, weft_fit *fit, double *table)
{
    dice state = dice_of_seed(seed, 1);
    *fit = (weft_fit){.lobe_count = 2, .frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0)};
    double tint = 1 - 0.25 * channel;
    fit->diffuse = tint * draw(&state, 0.05, 0.4);
    fit->lobe[0] = (weft_fit_lobe){.c = {draw(&state, -1, -0.7), draw(&state, -0.95, -0.6), 1},
                                   .log_exponent = log(draw(&state, 4, 40)),
                                   .amplitude = draw(&state, 0.3, 2)};
    fit->lobe[1] = (weft_fit_lobe){.c = {draw(&state, -0.3, 0.3), draw(&state, -0.3, 0.3), 1},
                                   .log_exponent = log(draw(&state, 1, 3)),
                                   .amplitude = tint * draw(&state, 0.2, 0.8)};
    double tilt = draw(&state, 0.1, 0.5), azimuth = draw(&state, 0, 6.28);
    weft_vec3 lean = weft_vec3_of(cos(azimuth), sin(azimuth), 0);
    for (int view = 0; view < layout->view_count; view++)
        table[view] = exp(-tilt * (weft_dot(layout->view[view], lean) + 1 - layout->view[view].z));
}

void synthetic_truth(const weft_dataset_layout *layout, uint64_t seed, weft_fit *fit, double *table)
{
    lafortune_truth(layout, seed, 0, fit, table);
}

static double lobe_of(const weft_fit_lobe *lobe, weft_vec3 light, weft_vec3 view)
{
    double b = lobe->c[0] * light.x * view.x + lobe->c[1] * light.y * view.y + lobe->c[2] * light.z * view.z;
    return b > 0 ? lobe->amplitude * pow(b, exp(lobe->log_exponent)) : 0;
}

static void lafortune_samples(const weft_dataset_layout *layout, uint64_t seed, float *samples)
{
    double table[WEFT_MATERIAL_MAX_VIEWS];
    for (int channel = 0; channel < 3; channel++) {
        weft_fit fit;
        lafortune_truth(layout, seed, channel, &fit, table);
        for (int image = 0; image < layout->image_count; image++) {
            int index = layout->view_of_image[image];
            weft_vec3 light = layout->light[image], view = layout->view[index];
            double sum = fit.diffuse + lobe_of(&fit.lobe[0], light, view) + lobe_of(&fit.lobe[1], light, view);
            samples[3 * image + channel] = (float)(table[index] * light.z * sum);
        }
    }
}

/* ---- Two anisotropic Ward lobes ---- */

/* Ward 1992 with the half vector not normalised (Walter 2005), times pi. */
static double ward(const weft_frame *frame, double ax, double ay, weft_vec3 light, weft_vec3 view)
{
    weft_vec3 half = weft_unit(weft_add(light, view));
    double cosine = weft_dot(frame->normal, light) * weft_dot(frame->normal, view), hn = weft_dot(half, frame->normal);
    if (!(cosine > 1e-4) || !(hn > 0))
        return 0;
    double hx = weft_dot(half, frame->tangent) / ax, hy = weft_dot(half, frame->bitangent) / ay;
    return exp(-(hx * hx + hy * hy) / (hn * hn)) / (4 * ax * ay * sqrt(cosine));
}

/* How much of a tilted facet a low direction still reaches. */
static double shadow(weft_vec3 direction, weft_vec3 lean, double depth)
{
    double grazing = sqrt(1 - direction.z * direction.z) / fmax(direction.z, 0.1);
    return 1 / (1 + exp(2 * (depth * grazing * (1 + weft_dot(direction, lean)) - 1.5)));
}

static void ward_samples(const weft_dataset_layout *layout, uint64_t seed, float *samples)
{
    dice state = dice_of_seed(seed, 2);
    weft_frame frame[2];
    double strength[2], ax[2], ay[2];
    for (int i = 0; i < 2; i++) {
        double tilt = draw(&state, 0, 0.35), azimuth = draw(&state, 0, 6.28);
        weft_vec3 normal = weft_vec3_of(sin(tilt) * cos(azimuth), sin(tilt) * sin(azimuth), cos(tilt));
        frame[i] = weft_frame_of_normal(normal, draw(&state, -1.5, 1.5));
        ax[i] = draw(&state, 0.15, 0.4);
        ay[i] = draw(&state, 0.2, 0.6);
        strength[i] = draw(&state, 0.05, 0.3);
    }
    double depth = draw(&state, 0.2, 0.8), azimuth = draw(&state, 0, 6.28);
    weft_vec3 lean = weft_vec3_of(cos(azimuth), sin(azimuth), 0);
    const double albedo[3] = {draw(&state, 0.1, 0.6), draw(&state, 0.1, 0.6), draw(&state, 0.05, 0.4)};
    for (int image = 0; image < layout->image_count; image++) {
        weft_vec3 light = layout->light[image], view = layout->view[layout->view_of_image[image]];
        double visible = shadow(light, lean, depth) * shadow(view, lean, depth);
        double shine = strength[0] * ward(&frame[0], ax[0], ay[0], light, view) +
                       strength[1] * ward(&frame[1], ax[1], ay[1], light, view);
        for (int channel = 0; channel < 3; channel++)
            samples[3 * image + channel] = (float)(light.z * visible * (albedo[channel] + shine));
    }
}

/* ---- Two crossed yarns ---- */

/* A fibre along `fibre` throws light into a cone: Kajiya and Kay 1989. */
static double fibre_highlight(weft_vec3 fibre, weft_vec3 light, weft_vec3 view, double exponent)
{
    double tl = weft_dot(fibre, light), tv = weft_dot(fibre, view);
    double cosine = sqrt((1 - tl * tl) * (1 - tv * tv)) - tl * tv;
    return cosine > 0 ? pow(cosine, exponent) : 0;
}

static void yarn_samples(const weft_dataset_layout *layout, uint64_t seed, float *samples)
{
    dice state = dice_of_seed(seed, 3);
    double slope[2] = {draw(&state, -0.5, 0.5), draw(&state, -0.5, 0.5)}, exponent = draw(&state, 8, 30);
    double edge = draw(&state, -0.3, 0.3), depth = draw(&state, 0.2, 0.8), shine[2];
    double albedo[2][3];
    for (int yarn = 0; yarn < 2; yarn++) {
        shine[yarn] = draw(&state, 0.1, 0.6);
        for (int channel = 0; channel < 3; channel++)
            albedo[yarn][channel] = draw(&state, 0.05, 0.5);
    }
    const weft_vec3 fibre[2] = {weft_unit(weft_vec3_of(1, 0.1, slope[0])), weft_unit(weft_vec3_of(0.1, 1, slope[1]))};
    const weft_vec3 lean = weft_vec3_of(0.8, 0.6, 0);
    for (int image = 0; image < layout->image_count; image++) {
        weft_vec3 light = layout->light[image], view = layout->view[layout->view_of_image[image]];
        double shift = edge + 0.4 * view.x / fmax(view.z, 0.2);
        double front = 1 / (1 + exp(-6 * shift));
        double visible = shadow(light, lean, depth);
        for (int channel = 0; channel < 3; channel++) {
            double sum = 0;
            for (int yarn = 0; yarn < 2; yarn++)
                sum += (yarn ? 1 - front : front) *
                       (albedo[yarn][channel] + shine[yarn] * fibre_highlight(fibre[yarn], light, view, exponent));
            samples[3 * image + channel] = (float)(light.z * visible * sum);
        }
    }
}

void synthetic_texel(const weft_dataset_layout *layout, synthetic_kind kind, uint64_t seed, double noise,
                     float *samples)
{
    if (kind == SYNTHETIC_LAFORTUNE)
        lafortune_samples(layout, seed, samples);
    else if (kind == SYNTHETIC_WARD)
        ward_samples(layout, seed, samples);
    else
        yarn_samples(layout, seed, samples);
    uint64_t state = seed * 2654435761u + (uint64_t)kind;
    for (int i = 0; noise > 0 && i < 3 * layout->image_count; i++)
        samples[i] *= (float)(1 + noise * gaussian(&state));
}

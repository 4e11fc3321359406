#include "adversaries.h"

#include "btf/direction/direction.h"
#include "reflectance/lafortune/lafortune.h"
#include "synthetic_dataset.h"
#include "synthetic_texel.h"

#include <math.h>
#include <string.h>

enum { TEXELS = ADVERSARY_TEXELS };

static uint64_t dice_state;

/* Uniform in [0, 1): splitmix64. */
static double dice(void)
{
    uint64_t z = dice_state += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static weft_vec3 any_direction(double lowest_z)
{
    double z = lowest_z + (1 - lowest_z) * dice(), phi = 2 * WEFT_PI * dice(), r = sqrt(1 - z * z);
    return weft_vec3_of(r * cos(phi), r * sin(phi), z);
}

/* ---- What the samples are ---- */

static double noise_only(int image, weft_vec3 light, weft_vec3 view)
{
    (void)image, (void)light, (void)view;
    return dice();
}

static double one_bright_light(int image, weft_vec3 light, weft_vec3 view)
{
    (void)view;
    return (image % WEFT_UBO81_COUNT == 60 ? 30 : 0.02 * (1 + 0.05 * dice())) * light.z;
}

static double two_bright_lights(int image, weft_vec3 light, weft_vec3 view)
{
    (void)view;
    int l = image % WEFT_UBO81_COUNT;
    return (l == 20 || l == 71 ? 8 : 0.1 + 0.01 * dice()) * light.z;
}

static double needle(weft_vec3 light, weft_vec3 view, double exponent)
{
    return pow(fmax(0, 2 * light.z * view.z - weft_dot(light, view)), exponent);
}

static double sharp(int image, weft_vec3 light, weft_vec3 view)
{
    (void)image;
    return light.z * (0.05 + 20 * needle(light, view, 20000)) + 0.002 * dice();
}

static double clipped(int image, weft_vec3 light, weft_vec3 view)
{
    (void)image;
    return fmin(0.2, light.z * (0.05 + 5 * needle(light, view, 40)));
}

/* Faint ripples, as of a compressed photograph, on a broad sheen. */
static double photographed(int image, weft_vec3 light, weft_vec3 view)
{
    double own = light.z * (0.1 + 0.3 * needle(light, view, 3)) + 0.02 * sin(12.9 * image) + 0.03 * dice();
    return round(255 * fmax(own, 0)) / 255;
}

static double bright_at_the_rim(int image, weft_vec3 light, weft_vec3 view)
{
    (void)image;
    return light.z * (0.05 + pow(1 - view.z, 6) * (1 + dice())) + 0.001 * dice();
}

/* What cloth does towards the rim, and more: T takes it up, and goes on from the last ring with a lobe that grows. */
static double sheen_that_grows(int image, weft_vec3 light, weft_vec3 view)
{
    (void)image;
    double grows = exp(7 * (1 - view.z)) * pow(1 - light.z, 2);
    return light.z * (0.05 + 0.2 * needle(light, view, 8) * grows) * (0.9 + 0.2 * dice());
}

/* ---- Where they were taken ---- */

static weft_code whole_grid(weft_dataset_layout *layout)
{
    return synthetic_layout(TEXELS, 1, layout, NULL);
}

static weft_code allocate(int images, int views, weft_dataset_layout *layout)
{
    *layout = (weft_dataset_layout){
        .width = TEXELS, .height = 1, .image_count = images, .view_count = views, .texel_pitch_mm = 0.1};
    return weft_dataset_layout_allocate(layout, NULL);
}

static weft_code one_view(weft_dataset_layout *layout)
{
    WEFT_TRY(allocate(WEFT_UBO81_COUNT, 1, layout));
    layout->view[0] = weft_vec3_of(0, 0, 1);
    for (int i = 0; i < WEFT_UBO81_COUNT; i++)
        layout->light[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    return WEFT_OK;
}

static weft_code one_light(weft_dataset_layout *layout)
{
    WEFT_TRY(allocate(WEFT_UBO81_COUNT, WEFT_UBO81_COUNT, layout));
    for (int i = 0; i < WEFT_UBO81_COUNT; i++) {
        layout->view[i] = weft_direction_of_angles(weft_ubo81_angles(i));
        layout->light[i] = weft_unit(weft_vec3_of(1, 0.2, 0.4));
        layout->view_of_image[i] = i;
    }
    return WEFT_OK;
}

/* Lights of one vertical plane, and views of another. */
static weft_code collinear(weft_dataset_layout *layout)
{
    enum { ARC = 21 };
    WEFT_TRY(allocate(ARC * ARC, ARC, layout));
    for (int i = 0; i < ARC * ARC; i++) {
        double light = (i % ARC - 10) * 0.14, view = (i / ARC - 10) * 0.14;
        layout->light[i] = weft_vec3_of(sin(light), 0, cos(light));
        layout->view[i / ARC] = weft_vec3_of(0, sin(view), cos(view));
        layout->view_of_image[i] = i / ARC;
    }
    return WEFT_OK;
}

/* Every pair is there three times. */
static weft_code repeated(weft_dataset_layout *layout)
{
    enum { LIGHTS = 25, VIEWS = 9, TIMES = 3 };
    WEFT_TRY(allocate(LIGHTS * VIEWS * TIMES, VIEWS, layout));
    for (int i = 0; i < LIGHTS * VIEWS * TIMES; i++) {
        int pair = i / TIMES;
        layout->light[i] = weft_direction_of_angles(weft_ubo81_angles(3 * (pair % LIGHTS)));
        layout->view[pair / LIGHTS] = weft_direction_of_angles(weft_ubo81_angles(9 * (pair / LIGHTS)));
        layout->view_of_image[i] = pair / LIGHTS;
    }
    return WEFT_OK;
}

static weft_code scattered(weft_dataset_layout *layout)
{
    enum { PAIRS = 350 };
    WEFT_TRY(allocate(PAIRS, PAIRS, layout));
    for (int i = 0; i < PAIRS; i++) {
        layout->light[i] = any_direction(0.1);
        layout->view[i] = any_direction(0.1);
        layout->view_of_image[i] = i;
    }
    return WEFT_OK;
}

/* ---- All of them ---- */

const adversary adversaries[ADVERSARIES] = {
    {"noise on the grid", whole_grid, noise_only},
    {"one light is bright", whole_grid, one_bright_light},
    {"two lights are bright", whole_grid, two_bright_lights},
    {"sharper than any exponent", whole_grid, sharp},
    {"highlights are clipped", whole_grid, clipped},
    {"rims are bright", whole_grid, bright_at_the_rim},
    {"sheen grows beyond the last ring", whole_grid, sheen_that_grows},
    {"one view of a photograph", one_view, photographed},
    {"one view of noise", one_view, noise_only},
    {"one low light", one_light, noise_only},
    {"lights and views on arcs", collinear, photographed},
    {"pairs are repeated", repeated, noise_only},
    {"pairs are scattered", scattered, photographed},
    {"scattered noise", scattered, noise_only},
};

static adversary_brightness *filled_with;
static adversary_limits *filled;

static void fill(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)y, (void)mask;
    for (int i = 0; i < layout->image_count; i++) {
        weft_vec3 light = layout->light[i], view = layout->view[layout->view_of_image[i]];
        double grey = filled_with(i, light, view);
        filled->highest = fmax(filled->highest, light.z);
        for (int k = 0; k < 3; k++) {
            weft_half stored = weft_half_of_float((float)(grey * (1 - 0.2 * k) * (0.5 + 0.25 * x)));
            double value = (double)weft_float_of_half(stored);
            samples[3 * i + k] = (float)value;
            filled->r[x][k] = fmax(filled->r[x][k], value);
            filled->f[x][k] = fmax(filled->f[x][k], value / light.z);
        }
    }
}

weft_code adversary_write(const adversary *one, const char *path, adversary_limits *limits)
{
    weft_dataset_layout layout;
    dice_state = 1;
    filled_with = one->brightness;
    filled = limits;
    memset(limits, 0, sizeof *limits);
    WEFT_TRY(one->arrange(&layout));
    synthetic_dataset_write(path, &layout, fill);
    weft_dataset_layout_free(&layout);
    return WEFT_OK;
}

/* A view for a light: any, mirrored, nearly, where highlights are, or beyond the last ring. */
static weft_vec3 view_for(weft_vec3 light, long trial)
{
    if (trial % 4 == 0)
        return any_direction(0);
    if (trial % 4 == 1)
        return weft_unit(weft_add(weft_vec3_of(-light.x, -light.y, light.z), weft_scale(any_direction(0), 0.1)));
    if (trial % 4 == 2)
        return weft_unit(weft_vec3_of(dice() - 0.5, dice() - 0.5, 0.001 + 0.1 * dice()));
    return weft_vec3_of(0, 0, 1);
}

/* Of a texel: its channels share one ceiling. */
static double ceiling_of(const adversary_limits *limits, int x)
{
    double r = 0, f = 0;
    for (int k = 0; k < 3; k++) {
        r = fmax(r, limits->r[x][k]);
        f = fmax(f, limits->f[x][k]);
    }
    return fmax(f, 4 * r / limits->highest);
}

weft_code adversary_largest_share(const weft_material *material, const adversary_limits *limits, uint64_t seed,
                                  long trials, double *share, weft_error *error)
{
    weft_table_directions directions;
    *share = 0;
    dice_state = seed;
    WEFT_TRY(weft_table_directions_create(material, &directions, error));
    for (long trial = 0; trial < trials; trial++) {
        weft_vec3 light = any_direction(0), view = view_for(light, trial);
        for (int x = 0; x < TEXELS; x++) {
            weft_rgba value = weft_material_texel(material, &directions, 0, x, 0, light, view);
            const double f[3] = {value.r, value.g, value.b};
            for (int k = 0; k < 3; k++) {
                bool is_sound = isfinite(f[k]) && f[k] >= 0;
                *share = is_sound ? fmax(*share, f[k] / ceiling_of(limits, x)) : INFINITY;
            }
        }
    }
    weft_table_directions_free(&directions);
    return WEFT_OK;
}

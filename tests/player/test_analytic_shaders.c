/* The shaders draw what the evaluators of analytic cloth in C compute from the same surface points. */
#include "reflectance/microcylinder/file.h"
#include "stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = STAGE_SHADED_WIDTH, HEIGHT = STAGE_SHADED_HEIGHT };

typedef struct cloth_model {
    weft_weave weave;
    weft_weave_texels texels;
    weft_weave_layout layout;
    int noise_seed;
} cloth_model;

/* How much of the intensity noise is left to its mean. */
static double resolved_noise(const cloth_model *model, const weft_weave_point *place, double level)
{
    const weft_segment *segment = &model->weave.yarn[place->yarn].segment;
    double side = fmin(segment->width, segment->length) / model->weave.fineness;
    return model->weave.fineness > 0 ? fmin(fmax((level - log2(side) + 1) / 2, 0), 1) : 0;
}

/* log2 of the width of the footprint in cells; a long one counts as a quarter of its length at least. */
static double width_of_footprint(const weft_surface_sample *at)
{
    const float *s = at->sides;
    double longer = fmax(hypot(s[0], s[1]), hypot(s[2], s[3])), area = fabs((double)s[0] * s[3] - (double)s[1] * s[2]);
    return longer > 0 ? log2(fmax(area / longer, longer / 4)) : (double)at->level;
}

/* At a place of the footprint, -1/2 to 1/2 of its sides. */
static weft_rgb cloth_at(const cloth_model *model, const weft_surface_sample *at, double across, double up)
{
    const weft_weave_layout *layout = &model->layout;
    const float *s = at->sides;
    double u = (double)at->u + (across * s[0] + up * s[2]) / (layout->tiles_u * model->weave.tile_width);
    double v = (double)at->v + (across * s[1] + up * s[3]) / (layout->tiles_v * model->weave.tile_height);
    bool noisy = model->noise_seed != 0;
    double U = (u - floor(u)) * layout->tiles_u - layout->corner_u + noisy * floor(u) * ceil(layout->tiles_u);
    double V = (v - floor(v)) * layout->tiles_v - layout->corner_v + noisy * floor(v) * ceil(layout->tiles_v);
    weft_weave_point place = weft_weave_locate(&model->weave, U, V, (uint64_t)model->noise_seed);
    place.intensity += (1 - place.intensity) * resolved_noise(model, &place, (double)at->level);
    return weft_weave_brdf(&model->weave, &place, stage_vector(at->light), stage_vector(at->view));
}

static int places_along(float x, float y)
{
    return (int)fmin(fmax(ceil(2 * hypot((double)x, (double)y)), 1), 3);
}

static weft_rgba evaluate_cloth(void *context, const weft_surface_sample *at)
{
    cloth_model *model = context;
    weft_vec3 light = stage_vector(at->light), view = stage_vector(at->view);
    if (!(light.z > 0))
        return (weft_rgba){0, 0, 0, 1};
    double fade = fmin(fmax((width_of_footprint(at) + 1) / 2, 0), 1);
    int across = places_along(at->sides[0], at->sides[1]), up = places_along(at->sides[2], at->sides[3]);
    const weft_weave_means *noisy = &model->texels.noisy_means;
    const weft_weave_means *means = model->noise_seed && noisy->texel ? noisy : &model->texels.means;
    weft_rgb far = weft_weave_tabulated_mean(means, light, view), sum = {fade * far.r, fade * far.g, fade * far.b};
    for (int i = 0; i < across * up; i++) {
        weft_rgb near = cloth_at(model, at, (i % across + 0.5) / across - 0.5, (i / across + 0.5) / up - 0.5);
        double weight = (1 - fade) / (across * up);
        sum.r += weight * near.r;
        sum.g += weight * near.g;
        sum.b += weight * near.b;
    }
    return stage_lit((weft_rgb){WEFT_PI * sum.r, WEFT_PI * sum.g, WEFT_PI * sum.b}, light, 1);
}

/* Filaments of the warp become staples. */
static void twist_warp(weft_weave *weave)
{
    for (int i = 0; i < weave->yarn_count; i++) {
        if (!weave->yarn[i].warp)
            continue;
        weave->yarn[i].segment.psi = 0.5;
        weave->yarn[i].prepared = weft_segment_prepare(&weave->yarn[i].segment);
    }
}

static void compare_cloth(void **state, const char *name, bool twisted, double repeat, int noise_seed)
{
    stage *s = *state;
    weft_error error = {0};
    char path[512], warning[WEFT_MESSAGE_SIZE];
    cloth_model *model = calloc(1, sizeof *model);
    snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, name);
    expect_ok(weft_weave_read(path, NULL, 0, &model->weave, warning, &error), &error);
    if (twisted)
        twist_warp(&model->weave);
    expect_ok(weft_weave_texels_of(&model->weave, &model->texels, &error), &error);
    model->noise_seed = noise_seed;
    model->layout = (weft_weave_layout){2.25, 2, 0.3, -0.4};
    expect_ok(weft_player_set_weave(s->player, &model->weave, &model->layout, &error), &error);
    weft_scene scene = weft_scene_default();
    scene.repeat = repeat;
    scene.noise_seed = noise_seed;
    stage_expect_small(name, stage_compare(s->player, scene, WEFT_MODE_ANALYTIC, WIDTH, HEIGHT, evaluate_cloth, model));
    weft_weave_texels_free(&model->texels);
    weft_weave_free(&model->weave);
    free(model);
}

static void compare_weave(void **state, const char *name, double repeat, int noise_seed)
{
    compare_cloth(state, name, false, repeat, noise_seed);
}

static void analytic_equals_c_for_staple_and_filament_yarns(void **state)
{
    compare_weave(state, "cotton_denim", 2, 0);
    compare_weave(state, "silk_charmeuse", 1, 0);
}

static void analytic_equals_c_where_the_texture_fades_to_the_mean(void **state)
{
    compare_weave(state, "wool_gabardine", 7.5, 0);
    compare_weave(state, "polyester_lining", 30, 0);
}

static void analytic_equals_c_for_a_cloth_of_both_yarns(void **state)
{
    compare_cloth(state, "silk_charmeuse", true, 20, 0);
    compare_cloth(state, "silk_shantung", true, 20, 7);
}

static void noise_of_both_kinds_equals_c_near_and_far(void **state)
{
    compare_weave(state, "cotton_denim", 2, 7);
    compare_weave(state, "silk_shantung", 1.5, 7);
    compare_weave(state, "cotton_twill", 6, 1000000007);
    compare_weave(state, "polyester_lining", 20, 3);
}

static weft_image picture(stage *s, const weft_scene *scene, int width, int height, int samples)
{
    weft_error error = {0};
    weft_image image;
    expect_ok(weft_player_picture(s->player, scene, width, height, samples, NULL, &image, &error), &error);
    return image;
}

/* PSNR of a picture beside one that has SAMPLES times its pixels along each side. */
static double psnr_of(const weft_image *image, const weft_image *large, int samples)
{
    double sum = 0;
    for (int i = 0; i < 3 * image->width * image->height; i++) {
        int c = i % 3, x = i / 3 % image->width * samples, y = i / 3 / image->width * samples;
        double mean = 0;
        for (int k = 0; k < samples * samples; k++)
            mean += (double)large->pixels[3 * ((y + k / samples) * large->width + x + k % samples) + c];
        mean /= samples * samples;
        sum += ((double)image->pixels[i] - mean) * ((double)image->pixels[i] - mean);
    }
    return -10 * log10(sum / (3.0 * image->width * image->height));
}

/* A frame of a mean fades the weave by its own part of the pixel. */
static void many_samples_show_what_a_larger_picture_shows(void **state)
{
    enum { SAMPLES = 4, SMALL_WIDTH = 120, SMALL_HEIGHT = 80 };
    stage *s = *state;
    weft_error error = {0};
    weft_weave weave;
    expect_ok(weft_weave_read(WEFT_ASSETS "/weaves/wool_gabardine.wv", NULL, 0, &weave, NULL, &error), &error);
    weft_weave_layout layout = weft_weave_square(&weave);
    expect_ok(weft_player_set_weave(s->player, &weave, &layout, &error), &error);
    weft_weave_free(&weave);
    weft_scene scene = weft_scene_default();
    scene.repeat = 12;
    scene.pane_count = 1;
    scene.pane[0] = WEFT_MODE_ANALYTIC;
    scene.labels = false;
    weft_image small = picture(s, &scene, SMALL_WIDTH, SMALL_HEIGHT, SAMPLES);
    weft_image large = picture(s, &scene, SAMPLES * SMALL_WIDTH, SAMPLES * SMALL_HEIGHT, 1);
    double psnr = psnr_of(&small, &large, SAMPLES);
    printf("16 samples a pixel beside a picture four times as large: %.1f dB\n", psnr);
    assert_true(psnr > 45);
    weft_image_free(&small);
    weft_image_free(&large);
}

static weft_rgba evaluate_threads(void *context, const weft_surface_sample *at)
{
    weft_vec3 light = stage_vector(at->light);
    weft_rgb brdf = weft_microcylinder_brdf(context, WEFT_CLOTH_BY_AREA, light, stage_vector(at->view));
    return stage_lit((weft_rgb){WEFT_PI * brdf.r, WEFT_PI * brdf.g, WEFT_PI * brdf.b}, light, 1);
}

static void microcylinders_equal_c(void **state)
{
    static const char *const name[] = {"plain_matte", "satin_face", "shot"};
    stage *s = *state;
    weft_error error = {0};
    weft_scene scene = weft_scene_default();
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        char path[512];
        weft_microcylinder_description cloth;
        snprintf(path, sizeof path, "%s/microcylinder/%s.mc", WEFT_ASSETS, name[i]);
        expect_ok(weft_microcylinder_read(path, NULL, 0, &cloth, &error), &error);
        expect_ok(weft_player_set_threads(s->player, &cloth.cloth, &error), &error);
        weft_prepared_cloth prepared = weft_microcylinder_prepare(&cloth.cloth);
        stage_expect_small(
            name[i], stage_compare(s->player, scene, WEFT_MODE_ANALYTIC, WIDTH, HEIGHT, evaluate_threads, &prepared));
        scene.light[0].direction.theta_rad = weft_rad_of_deg(80);
    }
}

int test_analytic_shaders(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(analytic_equals_c_for_staple_and_filament_yarns),
        cmocka_unit_test(analytic_equals_c_where_the_texture_fades_to_the_mean),
        cmocka_unit_test(analytic_equals_c_for_a_cloth_of_both_yarns),
        cmocka_unit_test(noise_of_both_kinds_equals_c_near_and_far),
        cmocka_unit_test(many_samples_show_what_a_larger_picture_shows),
        cmocka_unit_test(microcylinders_equal_c),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}

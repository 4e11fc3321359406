/* Components fitted to datasets that are made of other formulas: mixtures of Phong highlights (Phong 1975) and
 * Lambert, which no map of the components knows. */
#include "tests/support/cmocka_all.h"

#include "btf/direction/direction.h"
#include "compress/compress.h"
#include "reflectance/components/components.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/synthetic_dataset.h"

#include <math.h>
#include <omp.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 13, HEIGHT = 9, VIEWS = 61, LIGHTS = 61, COMPONENTS = 8 };

#define NAME "cloth.btf.h5"

static weft_vec3 direction(int index)
{
    return weft_direction_of_angles(weft_ubo81_angles(index));
}

/* Two highlights whose mixture changes from texel to texel: everything is a sum of three functions. */
static void mixture(int x, int y, weft_vec3 light, weft_vec3 view, double rgb[3])
{
    weft_vec3 mirrored = weft_vec3_of(-light.x, -light.y, light.z), back = light;
    double phong = pow(fmax(0, weft_dot(mirrored, view)), 12), retro = pow(fmax(0, weft_dot(back, view)), 6);
    double a = 0.2 + 0.1 * (x % 3), b = 0.3 * (y % 4) / 3.0, c = 0.25 * ((x + y) % 2);
    rgb[0] = light.z * (a + b * phong);
    rgb[1] = light.z * (a + b * phong + c * retro);
    rgb[2] = light.z * (0.5 * a + c * retro);
}

static void fill_mixture(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    for (int i = 0; i < layout->image_count; i++) {
        double rgb[3];
        mixture(x, y, weft_unit(layout->light[i]), weft_unit(layout->view[layout->view_of_image[i]]), rgb);
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = (float)rgb[c];
    }
}

/* A third of the samples of half of the texels say nonsense, and that they do. */
static void fill_masked(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_mixture(layout, x, y, samples, mask);
    for (int i = 0; i < layout->image_count; i++) {
        if ((x + y) % 2 == 0 || (i * 7 + x * 5 + y * 3) % 3 != 0)
            continue;
        mask[i] = i % 2 ? WEFT_MASK_DARK : WEFT_MASK_SATURATED | WEFT_MASK_MISSING;
        samples[3 * i] = samples[3 * i + 1] = samples[3 * i + 2] = 900;
    }
}

/* Two thirds of the brightest channel is all that the sensor can tell. */
static void fill_clipped(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_mixture(layout, x, y, samples, mask);
    for (int i = 0; i < layout->image_count; i++)
        for (int c = 0; c < 3; c++) {
            mask[i] |= samples[3 * i + c] > 0.4f ? WEFT_MASK_SATURATED : 0;
            samples[3 * i + c] = fminf(samples[3 * i + c], 0.4f);
        }
}

/* All but 46 or so of 3721 samples of a texel are masked. */
static void fill_mostly_masked(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_mixture(layout, x, y, samples, mask);
    for (int i = 0; i < layout->image_count; i++)
        mask[i] = (i + x + y) % 81 == 0 ? 0 : WEFT_MASK_MISSING;
}

/* A highlight of another width in every texel, over a dim ground: no few functions say it. */
static void fill_widths(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    for (int i = 0; i < layout->image_count; i++) {
        weft_vec3 light = layout->light[i], view = layout->view[layout->view_of_image[i]];
        weft_vec3 axis = weft_unit(weft_vec3_of(0.05 * (x % 7) - 0.15, 0.05 * (y % 5) - 0.1, 1));
        weft_vec3 half_vector = weft_unit(weft_add(light, view));
        double shine = pow(fmax(0, weft_dot(half_vector, axis)), 10 + 17 * ((x * 3 + y * 5) % 11));
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = (float)(light.z * (0.02 + 2 * shine));
    }
}

/* A highlight that grows towards the horizon with the square of 1 / (l . h). */
static void fill_growing(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    for (int i = 0; i < layout->image_count; i++) {
        weft_vec3 light = weft_unit(layout->light[i]), view = weft_unit(layout->view[layout->view_of_image[i]]);
        weft_vec3 half_vector = weft_unit(weft_add(light, view));
        double incidence = fmax(weft_dot(light, half_vector), 0.1);
        double shine = pow(half_vector.z, 4 + 4 * ((x * 3 + y * 5) % 4)) / (incidence * incidence);
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = (float)(light.z * 0.01 + 0.1 * shine);
    }
}

/* What is held out says nonsense and does not say so. */
static int is_held(int image)
{
    return image % LIGHTS % 9 == 4 || image / LIGHTS % 11 == 5;
}

static void fill_poisoned(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_mixture(layout, x, y, samples, mask);
    for (int i = 0; i < layout->image_count; i++) {
        if (is_held(i))
            samples[3 * i] = samples[3 * i + 1] = samples[3 * i + 2] = 50;
    }
}

static void write_weighed(synthetic_fill *fill, weft_distance distance, bool weighed)
{
    weft_error error = {0};
    weft_dataset_layout layout = {.width = WIDTH,
                                  .height = HEIGHT,
                                  .image_count = VIEWS * LIGHTS,
                                  .view_count = VIEWS,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .distance = distance,
                                  .texel_pitch_mm = 0.5};
    expect_ok(weft_dataset_layout_allocate(&layout, &error), &error);
    double far = distance == WEFT_NEAR ? 500 : 1;
    for (int i = 0; i < VIEWS * LIGHTS; i++) {
        layout.light[i] = weft_scale(direction(i % LIGHTS), far);
        layout.view[i / LIGHTS] = weft_scale(direction(i / LIGHTS), far);
        layout.view_of_image[i] = i / LIGHTS;
    }
    if (weighed)
        expect_ok(weft_dataset_layout_allocate_figure(&layout, WEFT_IMAGE_WEIGHT, &error), &error);
    for (int i = 0; weighed && i < VIEWS * LIGHTS; i++)
        layout.figure[WEFT_IMAGE_WEIGHT][i] = is_held(i) ? 1e-3 : 3 + i % 2;
    synthetic_dataset_write(NAME, &layout, fill);
    weft_dataset_layout_free(&layout);
}

static void write_dataset(synthetic_fill *fill, weft_distance distance)
{
    write_weighed(fill, distance, false);
}

static weft_compress_options options_for_components(void)
{
    weft_compress_options options = weft_compress_default_options();
    options.component_count = COMPONENTS;
    return options;
}

static void fit(const weft_compress_options *options, weft_material *material, weft_compress_report *report)
{
    weft_error error = {0};
    weft_dataset *dataset = synthetic_dataset_open(NAME);
    expect_ok(weft_compress(dataset, options, NULL, material, report, &error), &error);
    weft_dataset_close(dataset);
}

/* Relative RMSE against the mixture, over `count` directions that `choose` gives. */
static double error_over(const weft_material *material, weft_vec3 (*choose)(int), int count)
{
    const weft_components *components = material->components;
    weft_component_maps maps;
    weft_error error = {0};
    float factor[3 * COMPONENTS];
    double square = 0, energy = 0;
    expect_ok(weft_component_maps_create(components, &maps, &error), &error);
    for (int i = 0; i < count; i++) {
        weft_vec3 light = choose(2 * i), view = choose(2 * i + 1);
        weft_component_factors(&maps, light, view, factor);
        for (int texel = 0; texel < WIDTH * HEIGHT; texel++) {
            int x = texel % WIDTH, y = texel / WIDTH;
            weft_rgb value = weft_components_texel(components, components->component_count, factor, 0, x, y, light.z);
            double rgb[3], found[3] = {value.r, value.g, value.b};
            mixture(x, y, light, view, rgb);
            for (int c = 0; c < 3; c++) {
                square += (found[c] - rgb[c]) * (found[c] - rgb[c]);
                energy += rgb[c] * rgb[c];
            }
        }
    }
    weft_component_maps_free(&maps);
    return sqrt(square / energy);
}

static weft_vec3 measured(int i)
{
    return direction(i * 17 % VIEWS);
}

/* Between the samples: in steps of the golden angle and of another irrational number, up to 60 degrees. */
static weft_vec3 between(int i)
{
    double cosine = 0.5 + 0.5 * fmod(i * 0.7548776662466927, 1), azimuth = 2.399963229728653 * i;
    return weft_direction_of_angles((weft_angles){acos(cosine), azimuth});
}

static void components_follow_samples_and_what_lies_between_them(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_report report;
    weft_compress_options options = options_for_components();
    write_dataset(fill_mixture, WEFT_FAR);
    fit(&options, &material, &report);
    double at = error_over(&material, measured, 60), off = error_over(&material, between, 200);
    print_message("at samples %.4f, between them %.4f, reported %.4f\n", at, off,
                  report.components.fitted.relative_rmse);
    assert_true(at < 0.009);
    assert_true(off < 0.023);
    assert_float_equal(report.components.fitted.relative_rmse, at, 0.006);
    weft_material_free(&material);
}

static void the_growth_of_a_highlight_chooses_the_map(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_report report;
    weft_compress_options options = options_for_components();
    write_dataset(fill_growing, WEFT_FAR);
    fit(&options, &material, &report);
    const weft_component_errors *trial = report.components.trial.of_form;
    print_message("light %.4f, half vector %.4f, squared %.4f; fitted %.4f\n", trial[0].screen, trial[1].screen,
                  trial[2].screen, report.components.fitted.relative_rmse);
    assert_int_equal(material.components->kind, WEFT_COMPONENTS_KRIGED_OVER_HALF_VECTOR);
    assert_true(fmin(trial[1].screen, trial[2].screen) < 0.9 * trial[0].screen);
    assert_true(material.components->incidence_power == (trial[1].screen < trial[2].screen ? 1 : 2));
    weft_material_free(&material);
}

/* A hundredth of what the components leave may go, in squares. Most of what is left here the maps leave. */
static void what_is_rounded_does_not_show(void **state)
{
    (void)state;
    weft_material exact, rounded;
    weft_compress_report of_exact, of_rounded;
    weft_compress_options options = options_for_components();
    write_dataset(fill_widths, WEFT_FAR);
    fit(&options, &rounded, &of_rounded);
    options.finer = true;
    fit(&options, &exact, &of_exact);
    double ratio = of_rounded.components.fitted.relative_rmse / of_exact.components.fitted.relative_rmse;
    print_message("%.5f of the error without rounding\n", ratio);
    assert_false(weft_components_have_differences(exact.components));
    assert_true(weft_components_have_differences(rounded.components));
    assert_true(ratio > 1.0003 && ratio < 1.002);
    weft_material_free(&exact);
    weft_material_free(&rounded);
}

/* Next to nothing is left of these: steps would be finer than half floats are. */
static void what_is_all_but_exact_is_rounded_no_finer_than_half_floats(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_options options = options_for_components();
    write_dataset(fill_mixture, WEFT_FAR);
    fit(&options, &material, NULL);
    assert_true(weft_components_have_differences(material.components));
    assert_true(error_over(&material, measured, 60) < 0.009);
    weft_material_free(&material);
}

/* Masked samples neither pull the fit nor count as black. */
static void masked_samples_leave_no_trace(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_report report;
    weft_compress_options options = options_for_components();
    options.component_count = 4; /* hardly more than the mixture needs: none is left to make up for wrong ones */
    write_dataset(fill_masked, WEFT_FAR);
    fit(&options, &material, &report);
    print_message("with masks %.4f\n", error_over(&material, between, 200));
    assert_true(error_over(&material, between, 200) < 0.025);
    assert_true(report.components.masked > 0);
    weft_material_free(&material);
}

static void clipped_samples_are_no_ceiling(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_report report;
    weft_compress_options options = options_for_components();
    write_dataset(fill_clipped, WEFT_FAR);
    fit(&options, &material, &report);
    print_message("%ld clipped: %.4f at samples, %.4f between them\n", report.components.masked,
                  error_over(&material, measured, 60), error_over(&material, between, 200));
    assert_true(report.components.masked > 0);
    assert_true(error_over(&material, between, 200) < 0.025);
    weft_material_free(&material);
}

/* The mixture, but lights of the outermost ring are twice as bright, and its views three times. */
static double outside;

static void fill_ring(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_mixture(layout, x, y, samples, mask);
    for (int i = 0; i < layout->image_count; i++) {
        weft_vec3 light = layout->light[i], view = layout->view[layout->view_of_image[i]];
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] *= (light.z < outside ? 2.0f : 1) * (view.z < outside ? 3.0f : 1);
    }
}

/* 1 - 1 / 3, 1 - 1 / 2 and 1 - 1 / 6 of them are not foreseen, while nothing inside is told of it. */
static void the_outermost_ring_stands_for_what_lies_beyond(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_report report;
    weft_compress_options options = options_for_components();
    const weft_component_trial *trial = &report.components.trial;
    write_dataset(fill_mixture, WEFT_FAR);
    fit(&options, &material, &report);
    weft_material_free(&material);
    double before = trial->of_form[0].linear;
    outside = cos(trial->outermost_deg * WEFT_PI / 180);
    print_message("from %.1f degrees on: %.3f %.3f %.3f\n", trial->outermost_deg, trial->of_outermost[0].linear,
                  trial->of_outermost[1].linear, trial->of_outermost[2].linear);
    for (int kind = 0; kind < 3; kind++)
        assert_true(trial->of_outermost[kind].linear > 0 && trial->of_outermost[kind].linear < 0.4);
    write_dataset(fill_ring, WEFT_FAR);
    fit(&options, &material, &report);
    weft_material_free(&material);
    print_message("changed: %.3f %.3f %.3f\n", trial->of_outermost[0].linear, trial->of_outermost[1].linear,
                  trial->of_outermost[2].linear);
    assert_float_equal(trial->of_outermost[0].linear, 2.0 / 3, 0.1);
    assert_float_equal(trial->of_outermost[1].linear, 1.0 / 2, 0.1);
    assert_float_equal(trial->of_outermost[2].linear, 5.0 / 6, 0.1);
    assert_true(trial->of_form[0].linear > before);
}

static void what_is_held_out_is_not_seen(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_report report;
    uint8_t held[VIEWS * LIGHTS];
    weft_compress_options options = options_for_components();
    for (int i = 0; i < VIEWS * LIGHTS; i++)
        held[i] = (uint8_t)is_held(i);
    options.held_out = held;
    write_dataset(fill_poisoned, WEFT_FAR);
    fit(&options, &material, &report);
    print_message("held out %.4f\n", error_over(&material, between, 200));
    assert_true(error_over(&material, between, 200) < 0.023);
    weft_material_free(&material);
}

/* The least error of linear light, and the least on a screen among those that lose at most a twentieth of the other;
 * both but for the 2 % that a larger exponent must be worth. */
static void the_measure_chooses_the_exponent(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_report even, screen;
    weft_compress_options options = options_for_components();
    write_dataset(fill_widths, WEFT_FAR);
    options.weights = WEFT_WEIGHTS_EVEN;
    fit(&options, &material, &even);
    weft_material_free(&material);
    options.weights = WEFT_WEIGHTS_SCREEN;
    fit(&options, &material, &screen);
    assert_true(material.components->exponent == screen.components.plan.exponent);
    weft_material_free(&material);
    const weft_component_errors *of = screen.components.trial.of_exponent;
    double linear = INFINITY, shown = INFINITY;
    for (int i = 0; i < WEFT_COMPONENT_EXPONENTS; i++) {
        print_message("exponent %g: linear %.4f, on a screen %.4f\n", (double)weft_component_exponent(i), of[i].linear,
                      of[i].screen);
        linear = of[i].linear > 0 ? fmin(linear, of[i].linear) : linear;
    }
    for (int i = 0; i < WEFT_COMPONENT_EXPONENTS; i++)
        if (of[i].linear > 0 && of[i].linear <= 1.05 * linear)
            shown = fmin(shown, of[i].screen);
    for (int i = 0; i < WEFT_COMPONENT_EXPONENTS; i++) {
        if (weft_component_exponent(i) == screen.components.plan.exponent)
            assert_true(of[i].screen * 0.96 <= shown);
        if (weft_component_exponent(i) == even.components.plan.exponent)
            assert_true(even.components.trial.of_exponent[i].linear * 0.96 <= linear);
    }
    assert_true(of[2].screen < 0.9 * of[0].screen);
    assert_true(of[3].screen < 0.98 * of[2].screen && screen.components.plan.exponent > 2);
}

static void images_of_small_weight_do_no_harm(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_options options = options_for_components();
    write_weighed(fill_poisoned, WEFT_FAR, true);
    fit(&options, &material, NULL);
    assert_true(error_over(&material, between, 200) < 0.023);
    weft_material_free(&material);
}

/* Sums over the texels of a level and its channels: squares of a texel less the mean of what it covers of level 0, the
 * narrow ones at the border included, and of these means. */
static void compare_with_means(const weft_components *components, const float *factor, int level, double light_z,
                               double *square, double *energy)
{
    const weft_components_level *at = &components->level[level];
    for (int texel = 0; texel < at->width * at->height; texel++) {
        int count = 0;
        double sum = 0;
        for (int below = 0; below < WIDTH * HEIGHT; below++) {
            if (below % WIDTH >> level != texel % at->width || below / WIDTH >> level != texel / at->width)
                continue;
            sum += weft_components_texel(components, COMPONENTS, factor, 0, below % WIDTH, below / WIDTH, light_z).g;
            count++;
        }
        double own =
            weft_components_texel(components, COMPONENTS, factor, level, texel % at->width, texel / at->width, light_z)
                .g;
        *square += (own - sum / count) * (own - sum / count);
        *energy += sum / count * sum / count;
    }
}

/* What a screen shows may cost a twentieth of linear light and no more, and a larger exponent is worth 2 %. */
static void linear_light_is_not_traded_for_the_screen(void **state)
{
    (void)state;
    weft_component_trial trial = {.of_exponent = {{0.2, 0.16}, {0, 0}, {0.209, 0.12}, {0.211, 0.1}, {0, 0}}};
    assert_int_equal(weft_component_best_exponent(&trial, true), 2);
    assert_int_equal(weft_component_best_exponent(&trial, false), 0);
    trial.of_exponent[3].linear = 0.2099;
    assert_int_equal(weft_component_best_exponent(&trial, true), 3);
    trial.of_exponent[4] = (weft_component_errors){0.19, 0.0985};
    trial.of_exponent[3].linear = 0.199;
    trial.of_exponent[2].linear = 0.199;
    assert_int_equal(weft_component_best_exponent(&trial, true), 3);
    assert_int_equal(weft_component_best_exponent(&trial, false), 4);
    trial = (weft_component_trial){0}; /* nothing was tried */
    assert_int_equal(weft_component_best_exponent(&trial, true), 2);
    assert_int_equal(weft_component_best_exponent(&trial, false), 0);
}

/* Levels are means of linear light, also of coded components, whose coefficients are no means. */
static void levels_are_means(void **state)
{
    (void)state;
    weft_material material;
    weft_component_maps maps;
    weft_error error = {0};
    weft_compress_options options = options_for_components();
    float factor[3 * COMPONENTS];
    write_dataset(fill_widths, WEFT_FAR);
    fit(&options, &material, NULL);
    const weft_components *components = material.components;
    expect_ok(weft_component_maps_create(components, &maps, &error), &error);
    assert_int_equal(components->level_count, 5);
    assert_true(components->exponent > 1);
    for (int level = 1; level < components->level_count; level++) {
        double square = 0, energy = 0;
        for (int i = 0; i < 20; i++) {
            weft_vec3 light = between(i), view = between(7 * i + 3);
            weft_component_factors(&maps, light, view, factor);
            compare_with_means(components, factor, level, light.z, &square, &energy);
        }
        print_message("level %d: %.4f from the mean\n", level, sqrt(square / energy));
        assert_true(sqrt(square / energy) < 0.09);
    }
    weft_component_maps_free(&maps);
    weft_material_free(&material);
}

/* The brightest sample of the square of 8 x 8 texels that begins at (x0, y0). */
static double brightest_of_square(int x0, int y0)
{
    double brightest = 0;
    for (int y = y0; y < y0 + 8 && y < HEIGHT; y++)
        for (int x = x0; x < x0 + 8 && x < WIDTH; x++)
            for (int i = 0; i < VIEWS * LIGHTS; i++) {
                double rgb[3];
                mixture(x, y, direction(i % LIGHTS), direction(i / LIGHTS), rgb);
                brightest = fmax(brightest, fmax(rgb[0], fmax(rgb[1], rgb[2])));
            }
    return brightest;
}

/* A step of the codes is 9 %. */
static void ceilings_are_four_times_the_brightest_sample(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_options options = options_for_components();
    write_dataset(fill_mixture, WEFT_FAR);
    fit(&options, &material, NULL);
    for (int i = 0; i < 4; i++) {
        double ratio = (double)weft_ceiling_of_code(material.components->level[0].ceiling[i]) /
                       brightest_of_square(i % 2 * 8, i / 2 * 8);
        assert_true(ratio > 3.99 && ratio < 4.4);
    }
    weft_material_free(&material);
}

/* Nothing exceeds four times the brightest sample of the square of texels, from anywhere. */
static void ceilings_hold_everywhere(void **state)
{
    (void)state;
    weft_material material;
    weft_component_maps maps;
    weft_error error = {0};
    weft_compress_options options = options_for_components();
    float factor[3 * COMPONENTS];
    write_dataset(fill_mixture, WEFT_FAR);
    fit(&options, &material, NULL);
    expect_ok(weft_component_maps_create(material.components, &maps, &error), &error);
    double brightest = 0, largest = 0, least_cosine = (double)material.components->least_cosine;
    for (int texel = 0; texel < WIDTH * HEIGHT; texel++)
        for (int i = 0; i < VIEWS * LIGHTS; i++) {
            double rgb[3];
            mixture(texel % WIDTH, texel / WIDTH, direction(i % LIGHTS), direction(i / LIGHTS), rgb);
            brightest = fmax(brightest, fmax(rgb[0], fmax(rgb[1], rgb[2])));
        }
    for (int i = 0; i < 4000; i++) {
        weft_vec3 light = weft_unit(weft_add(between(i), weft_vec3_of(0.9 * between(3 * i).x, 0, -0.49)));
        weft_vec3 view = weft_unit(weft_add(between(5 * i), weft_vec3_of(0, 0.9 * between(7 * i).x, -0.49)));
        weft_component_factors(&maps, light, view, factor);
        for (int texel = 0; texel < WIDTH * HEIGHT; texel++) {
            weft_rgb value = weft_components_texel(material.components, COMPONENTS, factor, 0, texel % WIDTH,
                                                   texel / WIDTH, light.z);
            largest = fmax(largest, fmax(value.r, fmax(value.g, value.b)));
            assert_true(value.r >= 0 && value.g >= 0 && value.b >= 0);
            assert_true(light.z > 0.02 || value.r <= 4.4 * brightest * light.z / least_cosine);
        }
    }
    print_message("brightest sample %.3f, largest value %.3f\n", brightest, largest);
    assert_true(largest <= 4.4 * brightest); /* a step of the ceiling is 9 % */
    weft_component_maps_free(&maps);
    weft_material_free(&material);
}

/* The mixture above a ground that is brighter in the right squares, three noisy or shadowed images of 3721, and every
 * tenth masked. */
static void fill_ground(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_mixture(layout, x, y, samples, mask);
    for (int i = 3; i < layout->image_count; i += 10)
        mask[i] = WEFT_MASK_MISSING;
    for (int i = 0; i < layout->image_count; i++)
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = i % 1200 == 7 ? 0 : samples[3 * i + c] + (float)(layout->light[i].z * (x >= 8));
}

/* What the mixture has without any highlight, in the darkest texel of a square. Floors are rounded down by 1/16. */
static void floors_are_what_samples_never_fall_below(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_options options = options_for_components();
    write_dataset(fill_ground, WEFT_FAR);
    fit(&options, &material, NULL);
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++) {
            double ground = (c == 2 ? 0.1 : 0.2) + (i % 2 == 1);
            double ratio = (double)weft_floor_of_code(material.components->level[0].floor[3 * i + c]) / ground;
            assert_true(ratio > 15.0 / 16 && ratio < 1.001);
        }
    weft_material_free(&material);
}

/* Components that ring, eight for highlights of all widths, stay above the ground where nobody photographed. */
static void floors_keep_the_ground_from_ringing(void **state)
{
    (void)state;
    weft_material material;
    weft_component_maps maps;
    weft_error error = {0};
    weft_compress_options options = options_for_components();
    float factor[3 * COMPONENTS];
    long held_up = 0, all = 0;
    write_dataset(fill_widths, WEFT_FAR);
    fit(&options, &material, NULL);
    expect_ok(weft_component_maps_create(material.components, &maps, &error), &error);
    for (int i = 0; i < 300; i++) {
        weft_vec3 light = between(i), view = between(3 * i + 1);
        weft_component_factors(&maps, light, view, factor);
        for (int texel = 0; texel < WIDTH * HEIGHT; texel++, all++) {
            weft_rgb value = weft_components_texel(material.components, COMPONENTS, factor, 0, texel % WIDTH,
                                                   texel / WIDTH, light.z);
            assert_true((double)value.g >= 0.0187 * (double)light.z);
            held_up += (double)value.g < 0.0201 * (double)light.z;
        }
    }
    print_message("%ld of %ld values held to a floor\n", held_up, all);
    assert_true(held_up > all / 20);
    weft_component_maps_free(&maps);
    weft_material_free(&material);
}

/* A dozen photographs do not say how dark a texel gets. */
static void few_photographs_have_no_floor(void **state)
{
    (void)state;
    weft_material material;
    weft_compress_options options = options_for_components();
    write_dataset(fill_mostly_masked, WEFT_FAR);
    fit(&options, &material, NULL);
    for (int i = 0; i < 3; i++)
        assert_int_equal(material.components->level[0].floor[i], 0);
    weft_material_free(&material);
}

static void the_same_bytes_for_any_number_of_threads(void **state)
{
    (void)state;
    weft_material one, three;
    weft_compress_options options = options_for_components();
    int threads = omp_get_max_threads();
    write_dataset(fill_masked, WEFT_FAR);
    omp_set_num_threads(1);
    fit(&options, &one, NULL);
    omp_set_num_threads(3);
    fit(&options, &three, NULL);
    omp_set_num_threads(threads);
    for (int k = 0; k < one.components->level_count; k++)
        assert_memory_equal(one.components->level[k].coefficient, three.components->level[k].coefficient,
                            (size_t)(one.level[k].width * one.level[k].height * COMPONENTS));
    assert_memory_equal(one.components->value, three.components->value,
                        VIEWS * LIGHTS * COMPONENTS * 3 * sizeof(weft_half));
    weft_material_free(&one);
    weft_material_free(&three);
}

static void odd_numbers_are_refused(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material material;
    weft_compress_options options = options_for_components();
    write_dataset(fill_mixture, WEFT_FAR);
    weft_dataset *dataset = synthetic_dataset_open(NAME);
    options.component_count = 6;
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "multiple of 4"));
    options.component_count = 68;
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_USAGE);
    weft_dataset_close(dataset);
}

int test_components(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(components_follow_samples_and_what_lies_between_them),
        cmocka_unit_test(what_is_rounded_does_not_show),
        cmocka_unit_test(what_is_all_but_exact_is_rounded_no_finer_than_half_floats),
        cmocka_unit_test(the_growth_of_a_highlight_chooses_the_map),
        cmocka_unit_test(masked_samples_leave_no_trace),
        cmocka_unit_test(clipped_samples_are_no_ceiling),
        cmocka_unit_test(the_outermost_ring_stands_for_what_lies_beyond),
        cmocka_unit_test(what_is_held_out_is_not_seen),
        cmocka_unit_test(images_of_small_weight_do_no_harm),
        cmocka_unit_test(the_measure_chooses_the_exponent),
        cmocka_unit_test(linear_light_is_not_traded_for_the_screen),
        cmocka_unit_test(levels_are_means),
        cmocka_unit_test(ceilings_are_four_times_the_brightest_sample),
        cmocka_unit_test(ceilings_hold_everywhere),
        cmocka_unit_test(floors_are_what_samples_never_fall_below),
        cmocka_unit_test(floors_keep_the_ground_from_ringing),
        cmocka_unit_test(few_photographs_have_no_floor),
        cmocka_unit_test(the_same_bytes_for_any_number_of_threads),
        cmocka_unit_test(odd_numbers_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}

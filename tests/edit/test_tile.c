/* weft tile on cloth whose tile is known. */
#include "btf/direction/direction.h"
#include "edit/tile/search_steps.h"
#include "edit/tile/tile.h"
#include "tests/compare/fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const char *const input = "tile.btf.h5", *const output = "tile.tile.btf.h5";

/* ---- Cloth ---- */

/* Standard deviation of what the datasets show, relative to the value. */
static double noise;

/* Mixes a state well (Steele, Lea and Flood 2014). */
static uint64_t mixed(uint64_t state)
{
    state = (state ^ state >> 30) * 0xbf58476d1ce4e5b9u;
    state = (state ^ state >> 27) * 0x94d049bb133111ebu;
    return state ^ state >> 31;
}

/* A deviate that depends on place and directions alone: sum of four uniforms, of unit variance. */
static double deviate(int x, int y, weft_vec3 light, weft_vec3 view)
{
    const double part[] = {x, y, light.x, light.y, view.x, view.y};
    uint64_t state = 0;
    double sum = 0;
    for (int i = 0; i < 6; i++)
        state = mixed(state + (uint64_t)(int64_t)(65536 * part[i]) + 0x9e3779b97f4a7c15u);
    for (int i = 0; i < 4; i++) {
        state = mixed(state + 0x9e3779b97f4a7c15u);
        sum += (double)(state >> 40) / (1 << 24) - 0.5;
    }
    return sum * sqrt(3);
}

static weft_rgb noisy(weft_rgb value, int x, int y, weft_vec3 light, weft_vec3 view)
{
    double factor = fmax(1 + noise * deviate(x, y, light, view), 0);
    return (weft_rgb){factor * value.r, factor * value.g, factor * value.b};
}

/* A smooth tile without symmetry. */
static weft_rgb waves(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double u = 2 * WEFT_PI * (x + 0.5 - fixture_cloth.left) / fixture_cloth.width,
           v = 2 * WEFT_PI * (y + 0.5 - fixture_cloth.top) / fixture_cloth.height;
    double value = 0.5 + 0.2 * light.z * sin(u) * cos(v) + 0.1 * sin(2 * u + v) + 0.1 * view.z * cos(u - 2 * v);
    return noisy((weft_rgb){value, 0.5 * value, 0.25 * value}, x, y, light, view);
}

static weft_rgb woven(int x, int y, weft_vec3 light, weft_vec3 view)
{
    return noisy(fixture_woven(x, y, light, view), x, y, light, view);
}

static weft_rgb only_noise(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double value = 0.5 + 0.1 * deviate(x, y, light, view);
    return (weft_rgb){value, value, value};
}

static void read_weave(const char *name)
{
    char path[512];
    weft_error error = {0};
    snprintf(path, sizeof path, "%s/weaves/%s", WEFT_ASSETS, name);
    expect_ok(weft_weave_read(path, NULL, 0, &fixture_cloth.weave, NULL, &error), &error);
}

static weft_code find(const weft_weave *weave, weft_tile_report *report, weft_error *error)
{
    weft_dataset *dataset;
    expect_ok(weft_dataset_open(input, &dataset, error), error);
    weft_code code = weft_tile_find(dataset, weave, NULL, report, error);
    if (code == WEFT_OK)
        code = weft_tile_write(dataset, output, NULL, report, error);
    weft_dataset_close(dataset);
    return code;
}

/* Distance of two places that repeat. */
static double apart(double a, double b, double period)
{
    double turns = (a - b) / period;
    return fabs(turns - round(turns)) * period;
}

static void expect_near(const char *what, double found, double wanted, double within)
{
    if (!(fabs(found - wanted) <= within))
        fail_msg("%s is %.4f, not %.4f to %.4f", what, found, wanted, within);
}

/* ---- Tests ---- */

static void the_period_is_found_to_a_twentieth_of_a_texel_under_noise(void **state)
{
    (void)state;
    static const double size[][2] = {{9.37, 13.82}, {12, 10}, {21.33, 32}};
    for (int i = 0; i < 3; i++) {
        fixture_cloth.width = size[i][0], fixture_cloth.height = size[i][1], fixture_cloth.left = 3.3,
        fixture_cloth.top = 5.9, noise = 0.2;
        fixture_far_dataset(input, 70, 66, 2, waves, FIXTURE_MASK_ONE);
        weft_tile_report report;
        weft_error error = {0};
        expect_ok(find(NULL, &report, &error), &error);
        expect_near("width", report.tile.width, fixture_cloth.width, 0.05);
        expect_near("height", report.tile.height, fixture_cloth.height, 0.05);
        expect_near("width in mm", report.width_mm, fixture_cloth.width, 0.05);
        expect_near("tiles along u", report.tiles_x, 70 / fixture_cloth.width, 0.05);
    }
}

/* Twills look the same some cells further along both axes: the likeness tells that it is one of these places. */
static void the_weave_gives_the_phase_to_a_twentieth_of_a_texel_under_noise(void **state)
{
    (void)state;
    static const char *const name[] = {"wool_gabardine.wv", "cotton_denim.wv", "polyester_lining.wv"};
    for (int i = 0; i < 3; i++) {
        read_weave(name[i]);
        double cell_x = i < 2 ? 2.11 : 8.44, cell_y = i < 2 ? 2.07 : 8.28;
        fixture_cloth.width = cell_x * fixture_cloth.weave.tile_width,
        fixture_cloth.height = cell_y * fixture_cloth.weave.tile_height;
        fixture_cloth.left = 4.27, fixture_cloth.top = 7.61, noise = 0.15;
        fixture_far_dataset(input, 96, 96, 2, woven, FIXTURE_MASK_NONE);
        weft_tile_report report;
        weft_error error = {0};
        expect_ok(find(&fixture_cloth.weave, &report, &error), &error);
        expect_near("width", report.tile.width, fixture_cloth.width, 0.05);
        expect_near("height", report.tile.height, fixture_cloth.height, 0.05);
        expect_near("left", apart(report.tile.left, fixture_cloth.left, cell_x), 0, 0.05);
        expect_near("top", apart(report.tile.top, fixture_cloth.top, cell_y), 0, 0.05);
        expect_near("likeness", report.likeness, 1, 0.08);
        weft_weave_free(&fixture_cloth.weave);
    }
}

/* Sum over the texels and channels of a dataset, of image `image`. */
static double mean_of_image(const char *path, int image)
{
    weft_dataset *dataset;
    weft_error error = {0};
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t images = (size_t)layout->image_count, texels = (size_t)layout->width * (size_t)layout->height;
    weft_half *samples = malloc(3 * texels * images * sizeof *samples);
    uint8_t *mask = malloc(texels * images);
    double sum = 0;
    expect_ok(weft_dataset_read_block(dataset, 0, 0, layout->width, layout->height, samples, mask, &error), &error);
    for (size_t i = 0; i < texels; i++) {
        assert_int_equal(mask[i * images + (size_t)image], 0);
        sum += (double)weft_float_of_half(samples[3 * (i * images + (size_t)image)]);
    }
    weft_dataset_close(dataset);
    free(samples);
    free(mask);
    return sum / (double)texels;
}

static void the_mean_tile_is_free_of_noise_and_keeps_the_mean(void **state)
{
    (void)state;
    fixture_cloth.width = 12, fixture_cloth.height = 10, fixture_cloth.left = fixture_cloth.top = 0, noise = 0;
    fixture_far_dataset(input, 96, 80, 2, waves, FIXTURE_MASK_NONE);
    weft_tile_report report;
    weft_error error = {0};
    expect_ok(find(NULL, &report, &error), &error);
    assert_int_equal(report.texels_x, 12);
    assert_int_equal(report.texels_y, 10);
    expect_near("residual share", report.residual_share, 0, 0.05);
    expect_near("mean of image 5", mean_of_image(output, 5), mean_of_image(input, 5), 1e-3);
    noise = 0.1;
    fixture_far_dataset(input, 96, 80, 2, waves, FIXTURE_MASK_NONE);
    expect_ok(find(NULL, &report, &error), &error);
    expect_near("residual relative to the mean", report.residual_relative, 0.1, 0.02);
}

static void a_sample_masked_in_one_tile_comes_from_the_others(void **state)
{
    (void)state;
    fixture_cloth.width = 12, fixture_cloth.height = 10, fixture_cloth.left = fixture_cloth.top = 0, noise = 0;
    fixture_far_dataset(input, 36, 30, 2, waves, FIXTURE_MASK_ONE);
    weft_tile_report report;
    weft_error error = {0};
    expect_ok(find(NULL, &report, &error), &error);
    assert_int_equal(report.empty_count, 0);
    mean_of_image(output, 0); /* checks the mask */
}

static weft_rgb striped(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)x, (void)light, (void)view;
    double value = y / 3 % 2 ? 0.1 : 0.4;
    return (weft_rgb){value, value, value};
}

/* A row that a registration misses beside the frame would else be a step that no tile has. */
static void a_masked_texel_looks_like_its_neighbours(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_tile_pictures pictures;
    weft_error error = {0};
    fixture_far_dataset(input, 12, 12, 1, striped, FIXTURE_MASK_ONE);
    expect_ok(weft_dataset_open(input, &dataset, &error), &error);
    expect_ok(weft_tile_pictures_read(dataset, NULL, &pictures, &error), &error);
    assert_int_equal(pictures.count, 1);
    assert_true(pictures.mask[0] != 0 && pictures.value[1] > 0.3f);
    assert_float_equal(pictures.value[0], pictures.value[1], 1e-6);
    weft_tile_pictures_free(&pictures);
    weft_dataset_close(dataset);
}

static void expect_refusal(const char *with)
{
    weft_tile_report report;
    weft_error error = {0};
    remove(output);
    assert_int_equal(find(fixture_cloth.weave.yarn ? &fixture_cloth.weave : NULL, &report, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, with))
        fail_msg("'%s' does not say '%s'", error.message, with);
    assert_int_not_equal(access(output, F_OK), 0);
}

static void what_has_no_tile_is_refused(void **state)
{
    (void)state;
    fixture_far_dataset(input, 64, 64, 2, only_noise, FIXTURE_MASK_NONE);
    expect_refusal("does not repeat along u");
    fixture_cloth.width = 40, fixture_cloth.height = 10, fixture_cloth.left = fixture_cloth.top = noise = 0;
    fixture_far_dataset(input, 60, 60, 2, waves, FIXTURE_MASK_NONE);
    expect_refusal("does not repeat along u");
    fixture_far_dataset(input, 6, 60, 2, waves, FIXTURE_MASK_NONE);
    expect_refusal("6 x 60 texels");
    fixture_near_dataset(input, 16, 4, waves);
    expect_refusal("near lights");
}

static void another_weave_is_refused(void **state)
{
    (void)state;
    read_weave("cotton_denim.wv");
    fixture_cloth.width = 15.5, fixture_cloth.height = 31, fixture_cloth.left = fixture_cloth.top = 2, noise = 0;
    fixture_far_dataset(input, 64, 64, 3, woven, FIXTURE_MASK_NONE);
    weft_weave_free(&fixture_cloth.weave);
    read_weave("silk_shantung.wv");
    expect_refusal("does not look like the weave 'Silk shantung'");
    weft_weave_free(&fixture_cloth.weave);
}

static void the_command_says_what_it_did(void **state)
{
    (void)state;
    fixture_cloth.width = 12, fixture_cloth.height = 10, fixture_cloth.left = fixture_cloth.top = 0, noise = 0;
    fixture_far_dataset(input, 36, 30, 2, waves, FIXTURE_MASK_NONE);
    remove(output);
    assert_int_equal(system(WEFT_PROGRAM " tile tile.btf.h5 -o tile.tile.btf.h5 | grep -q 'tiles: 3.00 x 3.00'"), 0);
    assert_int_equal(access(output, F_OK), 0);
    assert_int_equal(
        system(WEFT_PROGRAM " tile tile.btf.h5 -o tile.tile.btf.h5 --json | grep -q '\"texels\":\\[12,10\\]'"), 0);
    assert_int_equal(WEXITSTATUS(system(WEFT_PROGRAM " tile tile.btf.h5 -o tile.btf.h5 2>/dev/null")), 2);
    assert_int_equal(WEXITSTATUS(system(WEFT_PROGRAM " tile missing.btf.h5 -o tile.tile.btf.h5 2>/dev/null")), 1);
}

int test_tile(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_period_is_found_to_a_twentieth_of_a_texel_under_noise),
        cmocka_unit_test(the_weave_gives_the_phase_to_a_twentieth_of_a_texel_under_noise),
        cmocka_unit_test(the_mean_tile_is_free_of_noise_and_keeps_the_mean),
        cmocka_unit_test(a_sample_masked_in_one_tile_comes_from_the_others),
        cmocka_unit_test(a_masked_texel_looks_like_its_neighbours),
        cmocka_unit_test(what_has_no_tile_is_refused),
        cmocka_unit_test(another_weave_is_refused),
        cmocka_unit_test(the_command_says_what_it_did),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

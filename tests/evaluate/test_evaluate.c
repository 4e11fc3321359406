/* The public functions of include/weft/evaluate.h and material.h against the evaluators behind them. */
#include "evaluate/model.h"
#include "tests/btf/material/components_example.h"
#include "tests/compare/fixture.h"
#include "weft/version.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { COUNT = 300 };

static double uv[COUNT][2], level[COUNT], light[COUNT][3], view[COUNT][3], brdf[COUNT][3];

static weft_rgb ramp(int x, int y)
{
    return (weft_rgb){0.1 * (x + 1), 0.2, 0.05 * (y + 1)};
}

static weft_rgb constant(int x, int y, weft_vec3 l, weft_vec3 v)
{
    (void)x, (void)y, (void)l, (void)v;
    return (weft_rgb){0.5, 0.25, 0.125};
}

static weft_model *open_model(const char *path)
{
    weft_model *model = NULL;
    weft_error error = {0};
    expect_ok(weft_model_open(path, NULL, &model, &error), &error);
    return model;
}

/* Directions of any length, some of them below the horizon. */
static int ask_anything(void **state)
{
    (void)state;
    for (int i = 0; i < COUNT; i++) {
        double theta = 0.006 * i, phi = 0.7 * i, length = 1 + i % 3;
        uv[i][0] = 0.017 * i - 1;
        uv[i][1] = 0.31 * i;
        level[i] = 0.01 * i;
        light[i][0] = length * sin(theta) * cos(phi);
        light[i][1] = length * sin(theta) * sin(phi);
        light[i][2] = length * cos(theta);
        view[i][0] = 0.3;
        view[i][1] = 0.1 * (i % 7);
        view[i][2] = i % 50 == 0 ? -1 : 1;
    }
    return 0;
}

static void expect_as_one_by_one(weft_model *model, bool has_levels)
{
    weft_error error = {0};
    expect_ok(weft_evaluate(model, COUNT, *uv, has_levels ? level : NULL, *light, *view, *brdf, &error), &error);
    for (int i = 0; i < COUNT; i++) {
        const weft_query query = {.light = weft_unit(weft_vec3_of(light[i][0], light[i][1], light[i][2])),
                                  .view = weft_unit(weft_vec3_of(view[i][0], view[i][1], view[i][2])),
                                  .has_place = true,
                                  .u = uv[i][0],
                                  .v = uv[i][1],
                                  .level = has_levels ? level[i] : 0};
        weft_rgb one;
        expect_ok(weft_model_brdf(model, &query, &one, &error), &error);
        assert_true(memcmp(&one, brdf[i], sizeof one) == 0);
    }
}

static void arrays_are_evaluated_as_one_by_one(void **state)
{
    (void)state;
    static const char *const weaves[] = {"cotton_denim.wv", "silk_shantung.wv"};
    components_write_example("components.weft");
    weft_model *model = open_model("components.weft");
    expect_as_one_by_one(model, true);
    weft_model_close(model);
    for (int i = 0; i < 2; i++) {
        char path[4096];
        snprintf(path, sizeof path, WEFT_ASSETS "/weaves/%s", weaves[i]);
        model = open_model(path);
        expect_as_one_by_one(model, false);
        weft_model_close(model);
    }
    fixture_far_dataset("model.btf.h5", 2, 2, 3, constant, FIXTURE_MASK_NONE);
    model = open_model("model.btf.h5");
    expect_as_one_by_one(model, false);
    assert_null(weft_model_material(model));
    weft_model_close(model);
    unlink("model.btf.h5");
    unlink("components.weft");
}

static void a_mean_and_an_opacity_need_less(void **state)
{
    (void)state;
    weft_error error = {0};
    double opacity[COUNT];
    fixture_diffuse_material("model.weft", 4, 2, ramp);
    weft_model *model = open_model("model.weft");
    expect_ok(weft_evaluate(model, 2, NULL, NULL, *light, view[1], *brdf, &error), &error);
    assert_float_equal(brdf[0][0] * WEFT_PI, 0.25, 1e-3);
    expect_ok(weft_evaluate_opacity(model, COUNT, *uv, level, *view, opacity, &error), &error);
    for (int i = 0; i < COUNT; i++)
        assert_true(opacity[i] == (view[i][2] > 0 ? 1 : 0));
    assert_int_equal(weft_evaluate_opacity(model, COUNT, NULL, NULL, *view, opacity, &error), WEFT_BAD_USAGE);
    assert_int_equal(weft_evaluate_half_width(model, 1, NULL, *light, view[1], *brdf, *brdf, &error), WEFT_BAD_USAGE);
    weft_model_close(model);
    unlink("model.weft");
}

static void footprints_choose_the_level_as_opengl_does(void **state)
{
    (void)state;
    components_write_example("components.weft"); /* 5 x 3 texels */
    weft_model *model = open_model("components.weft");
    int last = weft_model_level_count(model) - 1;
    assert_true(last >= 2);
    assert_float_equal(weft_model_level_of_footprint(model, (double[4]){1 / 5., 0, 0, 1 / 3.}), 0, 1e-12);
    assert_float_equal(weft_model_level_of_footprint(model, (double[4]){1e-9, 0, 0, 0}), 0, 0);
    assert_float_equal(weft_model_level_of_footprint(model, (double[4]){1 / 5., 0, 0, 2 / 3.}), 1, 1e-12);
    assert_float_equal(weft_model_level_of_footprint(model, (double[4]){3 / 5., 4 / 3., 0, 0}),
                       log2(5) < last ? log2(5) : last, 1e-12);
    assert_float_equal(weft_model_level_of_footprint(model, (double[4]){1e9, 0, 0, 0}), last, 0);
    weft_model_close(model);
    model = open_model(WEFT_ASSETS "/weaves/cotton_denim.wv");
    assert_int_equal(weft_model_level_count(model), 1);
    assert_float_equal(weft_model_level_of_footprint(model, (double[4]){1, 0, 0, 1}), 0, 0);
    weft_model_close(model);
    unlink("components.weft");
}

static void expect_refusal(weft_model *model, const double *places, const double *levels, const double *lights,
                           const char *what)
{
    weft_error error = {0};
    assert_int_equal(weft_evaluate(model, 1, places, levels, lights, view[1], *brdf, &error), WEFT_BAD_USAGE);
    if (!strstr(error.message, what))
        fail_msg("'%s' does not say '%s'", error.message, what);
}

static void nonsense_is_refused_before_anything_is_computed(void **state)
{
    (void)state;
    weft_error error = {0};
    fixture_diffuse_material("model.weft", 4, 2, ramp);
    weft_model *model = open_model("model.weft");
    expect_refusal(model, uv[1], &(double){-0.5}, light[1], "level -0.5");
    expect_refusal(model, uv[1], &(double){NAN}, light[1], "level");
    expect_refusal(model, uv[1], NULL, (double[3]){0, 0, 0}, "light 0, 0, 0");
    expect_refusal(model, uv[1], NULL, (double[3]){INFINITY, 0, 0}, "light inf");
    expect_refusal(model, (double[2]){0, NAN}, NULL, light[1], "u, v");
    weft_model_close(model);
    model = open_model(WEFT_ASSETS "/weaves/cotton_denim.wv");
    expect_refusal(model, uv[1], &(double){1}, light[1], "only a .weft");
    weft_model_close(model);
    unlink("model.weft");
    assert_int_equal(weft_model_open("absent.weft", NULL, &model, &error), WEFT_MISSING);
    assert_int_equal(weft_class_of(WEFT_MISSING), WEFT_BAD_INPUT);
    assert_int_equal(weft_class_of(WEFT_DAMAGED), WEFT_BAD_INPUT);
    assert_int_equal(weft_class_of(WEFT_NOT_SUPPORTED), WEFT_BAD_INPUT);
    assert_int_equal(weft_class_of(WEFT_BAD_USAGE), WEFT_BAD_USAGE);
    assert_int_equal(weft_class_of(WEFT_OUT_OF_MEMORY), WEFT_SYSTEM);
}

static void a_material_tells_what_it_holds(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material *material = NULL;
    assert_int_equal(weft_material_open("absent.weft", &material, &error), WEFT_MISSING);
    components_write_example("components.weft");
    expect_ok(weft_material_open("components.weft", &material, &error), &error);
    assert_int_equal(weft_material_component_count(material), 8);
    assert_int_equal(weft_material_width(material, 0), 5);
    assert_int_equal(weft_material_height(material, 1), 2);
    int levels = weft_material_level_count(material);
    weft_material_drop_finest(material);
    assert_int_equal(weft_material_level_count(material), levels - 1);
    assert_int_equal(weft_material_width(material, 0), 3);
    assert_int_equal(weft_material_metadata(material)[0], '{');
    weft_material_close(material);
    weft_material_close(NULL);
    unlink("components.weft");
    char version[32];
    snprintf(version, sizeof version, "%d.%d.%d", WEFT_VERSION_MAJOR, WEFT_VERSION_MINOR, WEFT_VERSION_PATCH);
    assert_string_equal(weft_version(), version);
}

int test_evaluate(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_are_evaluated_as_one_by_one),
        cmocka_unit_test(a_mean_and_an_opacity_need_less),
        cmocka_unit_test(footprints_choose_the_level_as_opengl_does),
        cmocka_unit_test(nonsense_is_refused_before_anything_is_computed),
        cmocka_unit_test(a_material_tells_what_it_holds),
    };
    return cmocka_run_group_tests(tests, ask_anything, NULL);
}

#include "btf/direction/direction.h"
#include "evaluate/model.h"
#include "reflectance/components/components.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/btf/material/components_example.h"
#include "tests/compare/fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const weft_vec3 light = {0.36, 0.48, 0.8}, view = {-0.6, 0, 0.8};

static weft_rgb ramp(int x, int y)
{
    return (weft_rgb){0.1 * (x + 1), 0.2, 0.05 * (y + 1)};
}

static weft_rgb constant(int x, int y, weft_vec3 l, weft_vec3 v)
{
    (void)x, (void)y, (void)l, (void)v;
    return (weft_rgb){0.5, 0.25, 0.125};
}

static weft_model *open_model(const char *path, const weft_model_options *options)
{
    static const weft_model_options none = {0};
    weft_model *model = NULL;
    weft_error error = {0};
    expect_ok(weft_model_open(path, options ? options : &none, &model, &error), &error);
    return model;
}

static weft_rgb brdf_of(weft_model *model, weft_query query)
{
    weft_rgb brdf;
    weft_error error = {0};
    expect_ok(weft_model_brdf(model, &query, &brdf, &error), &error);
    return brdf;
}

static void a_material_is_what_its_evaluator_says_over_pi(void **state)
{
    (void)state;
    fixture_diffuse_material("model.weft", 4, 2, ramp);
    weft_material material;
    expect_ok(weft_material_read("model.weft", &material, NULL), &(weft_error){0});
    weft_model *model = open_model("model.weft", NULL);
    weft_query query = {.light = light, .view = view, .has_place = true, .u = 0.3, .v = 0.6};
    weft_rgba expected = weft_material_sample(&material, NULL, 0, 0.3, 0.6, light, view);
    weft_rgb brdf = brdf_of(model, query);
    assert_float_equal(brdf.r, expected.r / WEFT_PI, 1e-9);
    assert_float_equal(brdf.b, expected.b / WEFT_PI, 1e-9);
    weft_model_close(model);
    weft_material_free(&material);
    unlink("model.weft");
}

static void without_a_place_a_material_is_the_mean_of_its_texels(void **state)
{
    (void)state;
    fixture_diffuse_material("model.weft", 4, 2, ramp);
    weft_model *model = open_model("model.weft", NULL);
    weft_rgb brdf = brdf_of(model, (weft_query){.light = light, .view = view});
    assert_float_equal(brdf.r * WEFT_PI, 0.25, 1e-3);
    assert_float_equal(brdf.g * WEFT_PI, 0.2, 1e-3);
    assert_float_equal(brdf.b * WEFT_PI, 0.075, 1e-3);
    weft_model_close(model);
    unlink("model.weft");
}

/* A material that has both is its components, or its lobes where those are asked for. */
static void components_come_before_lobes(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material material;
    weft_component_maps maps;
    float factor[3 * WEFT_COMPONENTS_MAX];
    components_write_example("components.weft");
    expect_ok(weft_material_read("components.weft", &material, &error), &error);
    expect_ok(weft_component_maps_create(material.components, &maps, &error), &error);
    const weft_query place = {.light = light, .view = view, .has_place = true, .u = 0.31, .v = 0.77, .level = 0.4};
    weft_model *model = open_model("components.weft", NULL);
    weft_model *lobes = open_model("components.weft", &(weft_model_options){.lobes = true});
    weft_component_factors(&maps, light, view, factor);
    weft_rgb r = weft_components_sample(material.components, 8, factor, 0.4, 0.31, 0.77, light.z);
    assert_true(r.g > 0);
    assert_float_equal(brdf_of(model, place).g, r.g / (WEFT_PI * light.z), 1e-9);
    assert_true(fabs(brdf_of(lobes, place).g - brdf_of(model, place).g) > 1e-3);
    /* However low the light, nothing fades but by its cosine. */
    const double low[2] = {1e-4, 1e-9};
    double at_low[2];
    for (int i = 0; i < 2; i++) {
        weft_query grazing = place;
        grazing.light = weft_unit(weft_vec3_of(1, 0, (weft_real)low[i]));
        at_low[i] = brdf_of(model, grazing).g;
    }
    assert_true(at_low[0] > 0 && fabs(at_low[1] / at_low[0] - 1) < 0.01);
    /* The mean is that of the texels. */
    double sum = 0;
    for (int i = 0; i < 15; i++)
        sum += weft_components_texel(material.components, 8, factor, 0, i % 5, i / 5, light.z).b;
    assert_float_equal(brdf_of(model, (weft_query){.light = light, .view = view}).b, sum / (15 * WEFT_PI * light.z),
                       1e-9);
    weft_model_close(model);
    weft_model_close(lobes);
    weft_component_maps_free(&maps);
    weft_material_free(&material);
}

static void a_dataset_is_divided_by_pi_and_the_cosine(void **state)
{
    (void)state;
    fixture_far_dataset("model.btf.h5", 2, 2, 3, constant, FIXTURE_MASK_NONE);
    weft_model *model = open_model("model.btf.h5", NULL);
    weft_vec3 near_top = weft_direction_of_angles((weft_angles){0.2, 1});
    weft_rgb at_place =
        brdf_of(model, (weft_query){.light = near_top, .view = near_top, .has_place = true, .u = 0.1, .v = 0.9});
    weft_rgb mean = brdf_of(model, (weft_query){.light = near_top, .view = near_top});
    assert_float_equal(at_place.g, 0.25 / WEFT_PI, 1e-4);
    assert_float_equal(mean.b, 0.125 / WEFT_PI, 1e-4);
    weft_model_close(model);
    unlink("model.btf.h5");
}

static void a_weave_is_evaluated_in_its_tile_and_as_its_mean(void **state)
{
    (void)state;
    static const char *const path = WEFT_ASSETS "/weaves/cotton_denim.wv";
    weft_weave weave;
    char warning[WEFT_MESSAGE_SIZE];
    weft_error error = {0};
    expect_ok(weft_weave_read(path, NULL, 0, &weave, warning, &error), &error);
    weft_model *model = open_model(path, NULL);
    weft_rgb brdf = brdf_of(model, (weft_query){.light = light, .view = view, .has_place = true, .u = 0.37, .v = -1.2});
    weft_weave_point point = weft_weave_locate(&weave, 0.37, -1.2, 0);
    weft_rgb expected = weft_weave_brdf(&weave, &point, light, view);
    assert_float_equal(brdf.r, expected.r, 1e-12);
    weft_rgb mean = brdf_of(model, (weft_query){.light = light, .view = view});
    assert_float_equal(mean.b, weft_weave_mean_brdf(&weave, light, view).b, 1e-12);
    weft_model_close(model);
    weft_weave_free(&weave);
}

static void noise_only_counts_when_it_is_asked_for(void **state)
{
    (void)state;
    static const char *const path = WEFT_ASSETS "/weaves/silk_shantung.wv";
    weft_weave weave;
    weft_error error = {0};
    char warning[WEFT_MESSAGE_SIZE];
    expect_ok(weft_weave_read(path, NULL, 0, &weave, warning, &error), &error);
    weft_model *model = open_model(path, &(weft_model_options){.noise_seed = 7});
    for (int i = 0; i < 50; i++) {
        weft_weave_point point = weft_weave_locate(&weave, 0.13 * i, 0.29 * i, 7);
        weft_rgb expected = weft_weave_brdf(&weave, &point, light, view);
        weft_rgb brdf =
            brdf_of(model, (weft_query){.light = light, .view = view, .has_place = true, .u = 0.13 * i, .v = 0.29 * i});
        assert_float_equal(brdf.g, expected.g, 1e-12);
    }
    weft_model_close(model);
    weft_weave_free(&weave);
}

static void only_a_material_has_levels(void **state)
{
    (void)state;
    weft_model *model = open_model(WEFT_ASSETS "/weaves/cotton_denim.wv", NULL);
    weft_rgb brdf;
    weft_error error = {0};
    weft_query query = {.light = light, .view = view, .level = 1};
    assert_int_equal(weft_model_brdf(model, &query, &brdf, &error), WEFT_BAD_INPUT);
    weft_model_close(model);
}

/* ---- Tables ---- */

static weft_code evaluate(const char *table_text, char **text, weft_error *error)
{
    FILE *file = fopen("model.csv", "w");
    fputs(table_text, file);
    fclose(file);
    fixture_diffuse_material("model.weft", 4, 2, ramp);
    weft_model *model = open_model("model.weft", NULL);
    weft_csv table;
    expect_ok(weft_csv_read("model.csv", true, &table, error), error);
    size_t size;
    FILE *output = open_memstream(text, &size);
    weft_code code = weft_model_evaluate_table(model, &table, NULL, output, error);
    fclose(output);
    weft_csv_free(&table);
    weft_model_close(model);
    unlink("model.csv");
    unlink("model.weft");
    return code;
}

static void rows_come_back_with_the_value_appended(void **state)
{
    (void)state;
    char *text = NULL;
    weft_error error = {0};
    expect_ok(
        evaluate("name,vx,vy,vz,lx,ly,lz,u,v\nfirst,0,0,2,0,0,1,0.125,0.75\nbelow,0,0,1,0,0,-1,0,0\n", &text, &error),
        &error);
    char expected[256];
    double rho = (double)weft_float_of_half(weft_half_of_float(0.1f));
    snprintf(expected, sizeof expected, "name,vx,vy,vz,lx,ly,lz,u,v,r,g,b\nfirst,0,0,2,0,0,1,0.125,0.75,%.9g,",
             rho / WEFT_PI);
    assert_memory_equal(text, expected, strlen(expected));
    assert_non_null(strstr(text, "\nbelow,0,0,1,0,0,-1,0,0,0,0,0\n"));
    free(text);
}

static void expect_refusal(const char *table, const char *what)
{
    char *text = NULL;
    weft_error error = {0};
    assert_int_equal(evaluate(table, &text, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, what))
        fail_msg("'%s' does not say '%s'", error.message, what);
    free(text);
}

static void tables_that_make_no_sense_are_refused_with_their_line(void **state)
{
    (void)state;
    expect_refusal("lx,ly,lz,vx,vy\n0,0,1,0,0\n", "vz");
    expect_refusal("lx,ly,lz,vx,vy,vz,u\n0,0,1,0,0,1,0\n", "u and v");
    expect_refusal("lx,ly,lz,vx,vy,vz\n0,0,1,0,0,1\n0,0,0,0,0,1\n", "model.csv:3");
    expect_refusal("lx,ly,lz,vx,vy,vz\n0,0,1,0,0,east\n", "model.csv:2: 'east'");
    expect_refusal("lx,ly,lz,vx,vy,vz,level\n0,0,1,0,0,1,-1\n", "model.csv:2: level -1");
}

int test_model(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_material_is_what_its_evaluator_says_over_pi),
        cmocka_unit_test(without_a_place_a_material_is_the_mean_of_its_texels),
        cmocka_unit_test(components_come_before_lobes),
        cmocka_unit_test(a_dataset_is_divided_by_pi_and_the_cosine),
        cmocka_unit_test(a_weave_is_evaluated_in_its_tile_and_as_its_mean),
        cmocka_unit_test(noise_only_counts_when_it_is_asked_for),
        cmocka_unit_test(only_a_material_has_levels),
        cmocka_unit_test(rows_come_back_with_the_value_appended),
        cmocka_unit_test(tables_that_make_no_sense_are_refused_with_their_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

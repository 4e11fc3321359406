/* The shaders draw what the evaluators in C compute from the same surface points. Floors: RMSE below 1/255, largest
 * difference below 4/255, of 8-bit sRGB values. */
#include "stage.h"

#include "evaluate/raw_btf.h"
#include "player/draw/player_parts.h"
#include "player/gl/context.h"
#include "reflectance/components/components.h"
#include "reflectance/lafortune/lafortune.h"
#include "reflectance/microcylinder/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 320, HEIGHT = 240 };

static weft_vec3 vector(const float v[3])
{
    return weft_vec3_of((weft_real)v[0], (weft_real)v[1], (weft_real)v[2]);
}

static weft_rgba lit(weft_rgb brdf_pi, weft_vec3 light, double opacity)
{
    double cosine = fmax(light.z, 0);
    return (weft_rgba){brdf_pi.r * cosine, brdf_pi.g * cosine, brdf_pi.b * cosine, opacity};
}

/* Between texels graphics cards keep 8 bits of the fraction; the software rasteriser keeps more. Maps of components
 * that are divided by the square of a small incidence show it. */
static bool filters_coarsely(void)
{
    return !strstr(weft_gl_renderer(), "llvmpipe");
}

static void expect_small(const char *what, stage_difference difference)
{
    printf("%s: RMSE %.4f/255, largest %g/255 over %ld pixels\n", what, difference.rmse, difference.largest,
           difference.pixels);
    assert_true(difference.pixels > WIDTH * HEIGHT / 5);
    assert_true(difference.rmse < 1);
    assert_true(difference.largest < (filters_coarsely() ? 8 : 4));
}

/* ---- Compressed ---- */

typedef struct material_model {
    weft_material material;
    weft_table_directions directions;
} material_model;

static weft_rgba evaluate_material(void *context, const weft_surface_sample *at)
{
    material_model *model = context;
    /* Opacity does not depend on the light, but the evaluator has none for a light below the horizon. */
    weft_vec3 light = vector(at->light), above = light.z > 0 ? light : weft_vec3_of(0, 0, 1);
    weft_rgba value = weft_material_sample(&model->material, &model->directions, (weft_real)at->level, (weft_real)at->u,
                                           (weft_real)at->v, above, vector(at->view));
    return lit((weft_rgb){value.r, value.g, value.b}, light, value.a);
}

/* Multiplies a material by `gain`: rho by it, C by gain^(1/N). */
static void darken(weft_material *material, double gain)
{
    for (int k = 0; k < material->level_count; k++) {
        weft_material_level *level = &material->level[k];
        size_t texels = (size_t)level->width * (size_t)level->height;
        for (size_t i = 0; i < 4 * texels; i++)
            level->diffuse[i] = weft_half_of_float(weft_float_of_half(level->diffuse[i]) * (float)gain);
        for (size_t i = 0; i < 3 * (size_t)material->lobe_count * texels; i++) {
            weft_half *code = level->lobe + 4 * i;
            double factor = pow(gain, 1 / (double)weft_float_of_half(code[3]));
            for (int c = 0; c < 3; c++)
                code[c] = weft_half_of_float(weft_float_of_half(code[c]) * (float)factor);
        }
    }
}

/* Draws a material made darker by `gain`, at an exposure that makes up for it. */
static void compare_dark_material(void **state, const char *what, double gain, int lobes, int views, int lights,
                                  weft_scene scene)
{
    stage *s = *state;
    weft_error error = {0};
    material_model model = {0};
    stage_material(20, 13, lobes, views, lights, &model.material);
    darken(&model.material, gain);
    scene.exposure /= gain;
    expect_ok(weft_table_directions_create(&model.material, &model.directions, &error), &error);
    expect_ok(weft_player_set_material(s->player, &model.material, &error), &error);
    expect_small(what, stage_compare(s->player, scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, evaluate_material, &model));
    weft_table_directions_free(&model.directions);
    weft_material_free(&model.material);
}

static void compare_material(void **state, const char *what, int lobes, int views, int lights, weft_scene scene)
{
    compare_dark_material(state, what, 1, lobes, views, lights, scene);
}

static void compressed_equals_c_with_two_lobes_and_81_views(void **state)
{
    compare_material(state, "2 lobes, 81 views", 2, 81, 0, weft_scene_default());
}

static void compressed_equals_c_between_levels(void **state)
{
    weft_scene scene = weft_scene_default();
    scene.repeat = 37;
    compare_material(state, "minified", 2, 81, 0, scene);
    scene.level_choice = WEFT_LEVEL_FIXED;
    scene.level = 1.37;
    compare_material(state, "level 1.37", 2, 81, 0, scene);
}

static void compressed_equals_c_under_grazing_light_from_behind(void **state)
{
    weft_scene scene = weft_scene_default();
    scene.light[0].direction = (weft_angles){weft_rad_of_deg(85), weft_rad_of_deg(100)};
    scene.exposure = 3;
    compare_material(state, "grazing", 3, 37, 0, scene);
}

static void compressed_equals_c_without_lobes_or_table(void **state)
{
    compare_material(state, "no lobes, no table", 0, 0, 0, weft_scene_default());
    compare_material(state, "1 lobe, 1 view", 1, 1, 0, weft_scene_default());
    compare_material(state, "1 lobe, 2 views", 1, 2, 0, weft_scene_default());
}

static void compressed_equals_c_with_a_light_table(void **state)
{
    weft_scene scene = weft_scene_default();
    compare_material(state, "81 views, 81 lights", 2, 81, 81, scene);
    compare_material(state, "33 lights, no views", 1, 0, 33, scene);
    scene.light[0].direction = (weft_angles){weft_rad_of_deg(70), weft_rad_of_deg(200)};
    scene.repeat = 37;
    compare_material(state, "81 views, 60 lights, minified", 2, 81, 60, scene);
}

/* A third of the texels has a ceiling that its highlight is above, another third one that it never reaches. */
static void set_ceilings(weft_material *material)
{
    for (int k = 0; k < material->level_count; k++) {
        weft_material_level *level = &material->level[k];
        for (size_t i = 0; i < (size_t)level->width * (size_t)level->height; i++)
            weft_material_set_ceiling(level, i, i % 3 == 0 ? 0 : i % 3 == 1 ? 0.2f : 100);
    }
}

static void compare_under_ceilings(void **state, const char *what, int views, weft_scene scene)
{
    stage *s = *state;
    weft_error error = {0};
    material_model model = {0};
    stage_material(20, 13, 2, views, 0, &model.material);
    set_ceilings(&model.material);
    expect_ok(weft_table_directions_create(&model.material, &model.directions, &error), &error);
    expect_ok(weft_player_set_material(s->player, &model.material, &error), &error);
    expect_small(what, stage_compare(s->player, scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, evaluate_material, &model));
    weft_table_directions_free(&model.directions);
    weft_material_free(&model.material);
}

static void compressed_equals_c_under_ceilings(void **state)
{
    weft_scene scene = weft_scene_default();
    compare_under_ceilings(state, "ceilings, 81 views", 81, scene);
    scene.repeat = 37;
    compare_under_ceilings(state, "ceilings, no views, minified", 0, scene);
}

/* ---- Components ---- */

typedef struct component_model {
    material_model lobes; /* which have the opacity */
    weft_component_maps maps;
    weft_material_relief relief;
    int count;
} component_model;

static weft_vec3 nearest_of_table(const component_model *model, int stored)
{
    const weft_material *material = &model->lobes.material;
    weft_vec3 nearest = vector((const float[]){0, 0, 1});
    for (int i = 0; i < material->view_count; i++)
        if (i == 0 ||
            weft_dot(material->view[i], model->relief.view[stored]) > weft_dot(nearest, model->relief.view[stored]))
            nearest = material->view[i];
    return nearest;
}

static weft_real opacity_at(const component_model *model, weft_real level, weft_real u, weft_real v, weft_vec3 light,
                            weft_vec3 view)
{
    return weft_material_sample(&model->lobes.material, &model->lobes.directions, level, u, v, light, view).a;
}

/* What each stored view knows of it, in its direction as the table has it. */
static weft_real opacity_through(const component_model *model, const weft_surface_sample *at)
{
    weft_vec3 light = vector(at->light), view = vector(at->view);
    weft_real level = (weft_real)at->level, u = (weft_real)at->u, v = (weft_real)at->v;
    weft_real share = weft_material_relief_share(&model->relief, level);
    weft_real sum = (1 - share) * opacity_at(model, level, u, v, light, view);
    int index[3];
    weft_relief_tap tap[3];
    if (!(share > 0))
        return sum;
    weft_material_relief_taps(&model->relief, u, v, view, index, tap);
    for (int i = 0; i < 3; i++) {
        if (tap[i].weight > 0)
            sum += share * tap[i].weight *
                   opacity_at(model, level, tap[i].u, tap[i].v, light, nearest_of_table(model, index[i]));
    }
    return sum;
}

static weft_rgba evaluate_components(void *context, const weft_surface_sample *at)
{
    component_model *model = context;
    weft_rgb value =
        weft_components_sample_through(&model->maps, &model->relief, model->count, (weft_real)at->level,
                                       (weft_real)at->u, (weft_real)at->v, vector(at->light), vector(at->view));
    return (weft_rgba){value.r, value.g, value.b, opacity_through(model, at)};
}

typedef enum surface_shape { FLAT, PLANE, HILLS } surface_shape;

static stage_difference difference_of_components(void **state, weft_components_kind kind, int component_count,
                                                 int views, surface_shape shape, weft_scene scene)
{
    stage *s = *state;
    weft_error error = {0};
    component_model model = {.count =
                                 scene.components < component_count ? (scene.components + 3) / 4 * 4 : component_count};
    weft_material *material = &model.lobes.material;
    stage_material(20, 13, 1, views, 0, material);
    stage_components(kind, component_count, material);
    if (shape != FLAT)
        stage_heights(shape == HILLS, 2, material);
    expect_ok(weft_table_directions_create(material, &model.lobes.directions, &error), &error);
    expect_ok(weft_component_maps_create(material->components, &model.maps, &error), &error);
    expect_ok(weft_component_maps_keep_views(&model.maps, &error), &error);
    expect_ok(weft_material_relief_create(material, &model.relief, &error), &error);
    expect_ok(weft_player_set_material(s->player, material, &error), &error);
    stage_difference result =
        stage_compare(s->player, scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, evaluate_components, &model);
    weft_material_relief_free(&model.relief);
    weft_component_maps_free(&model.maps);
    weft_table_directions_free(&model.lobes.directions);
    weft_material_free(material);
    return result;
}

static void compare_components(void **state, const char *what, weft_components_kind kind, int component_count,
                               int views, weft_scene scene)
{
    expect_small(what, difference_of_components(state, kind, component_count, views, FLAT, scene));
}

static void components_equal_c(void **state)
{
    weft_scene scene = weft_scene_default();
    compare_components(state, "8 components over the light", WEFT_COMPONENTS_OF_LIGHT, 8, 0, scene);
    compare_components(state, "16 components over the half vector", WEFT_COMPONENTS_OF_HALF_VECTOR, 16, 0, scene);
    scene.light[0].direction = (weft_angles){weft_rad_of_deg(80), weft_rad_of_deg(100)};
    compare_components(state, "4 components under grazing light", WEFT_COMPONENTS_OF_HALF_VECTOR, 4, 0, scene);
    compare_components(state, "4 components, squared incidence", WEFT_COMPONENTS_OF_HALF_VECTOR_SQUARED, 4, 0, scene);
}

static void components_equal_c_between_levels(void **state)
{
    weft_scene scene = weft_scene_default();
    scene.repeat = 37;
    compare_components(state, "components, minified", WEFT_COMPONENTS_OF_LIGHT, 8, 0, scene);
    scene.level_choice = WEFT_LEVEL_FIXED;
    scene.level = 1.37;
    compare_components(state, "components, level 1.37", WEFT_COMPONENTS_OF_HALF_VECTOR, 8, 0, scene);
}

static void components_through_holes_equal_c(void **state)
{
    compare_components(state, "components with opacity", WEFT_COMPONENTS_OF_HALF_VECTOR, 8, 37, weft_scene_default());
}

/* A pixel on the edge of a hill may see either side of it, as single precision has it. */
static void expect_alike(const char *what, stage_difference difference)
{
    printf("%s: RMSE %.4f/255, largest %g/255 over %ld pixels\n", what, difference.rmse, difference.largest,
           difference.pixels);
    assert_true(difference.pixels > WIDTH * HEIGHT / 8);
    assert_true(difference.rmse < 0.2);
}

static void components_through_heights_equal_c(void **state)
{
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_NONE;
    expect_alike("components through hills",
                 difference_of_components(state, WEFT_COMPONENTS_OF_LIGHT, 8, 0, HILLS, scene));
    expect_alike("components through a plane",
                 difference_of_components(state, WEFT_COMPONENTS_OF_HALF_VECTOR, 8, 0, PLANE, scene));
    expect_alike("components through hills, squared incidence",
                 difference_of_components(state, WEFT_COMPONENTS_OF_HALF_VECTOR_SQUARED, 4, 0, HILLS, scene));
    expect_alike("components with opacity through hills",
                 difference_of_components(state, WEFT_COMPONENTS_OF_HALF_VECTOR, 4, 37, HILLS, scene));
}

/* Level 1 is seen through heights, level 2 is not. */
static void heights_count_on_their_levels(void **state)
{
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_FIXED;
    scene.level = 1.37;
    expect_alike("components through hills, level 1.37",
                 difference_of_components(state, WEFT_COMPONENTS_OF_LIGHT, 8, 0, HILLS, scene));
    scene.level = 2;
    expect_alike("components, level 2", difference_of_components(state, WEFT_COMPONENTS_OF_LIGHT, 8, 0, HILLS, scene));
}

/* So much, at least, the tests above would see were the heights not used. */
static void heights_of_layers_that_are_switched_off_are_not_used(void **state)
{
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_NONE;
    scene.relief = false;
    stage_difference off = difference_of_components(state, WEFT_COMPONENTS_OF_LIGHT, 8, 0, HILLS, scene);
    printf("heights of components against none: RMSE %.4f/255\n", off.rmse);
    assert_true(off.rmse > 3);
}

static void the_first_layers_alone_equal_c(void **state)
{
    weft_scene scene = weft_scene_default();
    scene.components = 8;
    compare_components(state, "8 of 16 components", WEFT_COMPONENTS_OF_LIGHT, 16, 0, scene);
}

/* Half floats below 6.1e-5 are subnormal. */
static void compressed_equals_c_in_the_dark(void **state)
{
    compare_dark_material(state, "1e-4 as bright", 1e-4, 2, 81, 0, weft_scene_default());
    compare_dark_material(state, "1e-6 as bright", 1e-6, 0, 0, 0, weft_scene_default());
}

/* ---- Raw ---- */

typedef struct raw_model {
    weft_dataset *dataset;
    weft_raw_btf *raw;
} raw_model;

static const char *const raw_path = "test_shaders.btf.h5";

static weft_rgba lit_raw(weft_rgb brdf, weft_vec3 light)
{
    return lit((weft_rgb){brdf.r * WEFT_PI, brdf.g * WEFT_PI, brdf.b * WEFT_PI}, light, 1);
}

static weft_rgba evaluate_raw(void *context, const weft_surface_sample *at)
{
    raw_model *model = context;
    weft_rgb brdf = {0};
    weft_error error = {0};
    weft_vec3 light = vector(at->light), view = vector(at->view);
    expect_ok(weft_raw_btf_sample(model->raw, (weft_real)at->u, (weft_real)at->v, light, view, &brdf, &error), &error);
    return lit_raw(brdf, light);
}

static weft_rgba evaluate_raw_mean(void *context, const weft_surface_sample *at)
{
    raw_model *model = context;
    weft_rgb brdf = {0};
    weft_error error = {0};
    weft_vec3 light = vector(at->light);
    expect_ok(weft_raw_btf_mean(model->raw, light, vector(at->view), &brdf, &error), &error);
    return lit_raw(brdf, light);
}

static raw_model open_written(stage *s, weft_raw_format format, size_t bytes)
{
    weft_raw_limits limits = weft_raw_texture_limits(format);
    limits.bytes = bytes;
    weft_error error = {0};
    raw_model model;
    int skipped;
    expect_ok(weft_dataset_open(raw_path, &model.dataset, &error), &error);
    expect_ok(weft_raw_btf_create(model.dataset, &model.raw, &error), &error);
    expect_ok(weft_player_set_dataset(s->player, model.dataset, NULL, &skipped, &error), &error);
    weft_raw_texture_free(&s->player->raw);
    expect_ok(weft_raw_texture_upload(model.dataset, &limits, NULL, &s->player->raw, &error), &error);
    return model;
}

static raw_model open_raw(stage *s, int size, int views, int lights, weft_values values, weft_raw_format format,
                          size_t bytes)
{
    stage_dataset(raw_path, size, views, lights, values, false);
    return open_written(s, format, bytes);
}

/* The same with hills of 0.6 mm on a material of `size` / 2 mm, or only a plane. */
static raw_model open_relief(stage *s, int size, bool hills)
{
    weft_dataset_heights heights = {2 * size, 2 * size, 8, malloc((size_t)(4 * size * size) * sizeof(float))};
    weft_error error = {0};
    for (int i = 0; i < 4 * size * size; i++) {
        double u = (i % (2 * size) + 0.5) / (2 * size), v = 1 - (i / (2 * size) + 0.5) / (2 * size);
        heights.value[i] = (float)(-0.4 + 0.3 * sin(2 * WEFT_PI * u) * cos(2 * WEFT_PI * v + 1));
    }
    stage_dataset(raw_path, size, 37, 19, WEFT_REFLECTANCE_COSINE, false);
    expect_ok(weft_dataset_put_relief(raw_path, raw_path, -0.4, hills ? &heights : NULL, "{}", &error), &error);
    weft_dataset_heights_free(&heights);
    return open_written(s, WEFT_RAW_HALF, SIZE_MAX);
}

static void close_raw(raw_model *model)
{
    weft_raw_btf_free(model->raw);
    weft_dataset_close(model->dataset);
    unlink(raw_path);
}

static void raw_equals_c_interpolation_in_views_and_lights(void **state)
{
    stage *s = *state;
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_NONE;
    raw_model model = open_raw(s, 8, 81, 81, WEFT_REFLECTANCE_COSINE, WEFT_RAW_HALF, SIZE_MAX);
    expect_small("raw 81 x 81", stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate_raw, &model));
    close_raw(&model);
    model = open_raw(s, 5, 19, 37, WEFT_REFLECTANCE, WEFT_RAW_HALF, SIZE_MAX);
    expect_small("raw 19 x 37", stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate_raw, &model));
    close_raw(&model);
}

static void raw_through_heights_equals_c(void **state)
{
    stage *s = *state;
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_NONE;
    for (int hills = 0; hills < 2; hills++) {
        raw_model model = open_relief(s, 8, hills);
        expect_small(hills ? "raw through hills" : "raw through a plane",
                     stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate_raw, &model));
        close_raw(&model);
    }
}

/* So much, at least, the test above would see were they not used. */
static void heights_that_are_switched_off_are_not_used(void **state)
{
    stage *s = *state;
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_NONE;
    scene.relief = false;
    raw_model model = open_relief(s, 8, true);
    stage_difference off = stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate_raw, &model);
    printf("heights against none: RMSE %.4f/255\n", off.rmse);
    assert_true(off.rmse > 3);
    close_raw(&model);
}

static void raw_with_a_shared_exponent_equals_c_too(void **state)
{
    stage *s = *state;
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_NONE;
    raw_model model = open_raw(s, 6, 37, 37, WEFT_REFLECTANCE_COSINE, WEFT_RAW_SHARED_EXPONENT, SIZE_MAX);
    expect_small("raw packed", stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate_raw, &model));
    close_raw(&model);
}

static void the_last_raw_level_is_the_mean_of_all_texels(void **state)
{
    stage *s = *state;
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_FIXED;
    scene.level = 99;
    raw_model model = open_raw(s, 8, 19, 37, WEFT_REFLECTANCE_COSINE, WEFT_RAW_HALF, SIZE_MAX);
    expect_small("raw mean", stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate_raw_mean, &model));
    close_raw(&model);
}

static void a_dataset_that_does_not_fit_loses_its_finest_levels_first(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_raw_texture texture;
    weft_raw_limits small = weft_raw_texture_limits(WEFT_RAW_HALF);
    small.bytes = (size_t)49 * 4;
    raw_model model = open_raw(s, 8, 7, 7, WEFT_REFLECTANCE_COSINE, WEFT_RAW_HALF, (size_t)49 * 16 * 8 * 8);
    assert_int_equal(s->player->raw.plan.skipped_levels, 1);
    assert_int_equal(s->player->raw.plan.layout.area[0].width, 4);
    assert_int_equal(weft_raw_texture_upload(model.dataset, &small, NULL, &texture, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "too many images for graphics memory: 49"));
    weft_raw_texture_free(&texture);
    close_raw(&model);
}

/* ---- Analytic ---- */

typedef struct cloth_model {
    weft_weave weave;
    weft_triangulation *directions;
    weft_rgb mean[WEFT_UBO81_COUNT][WEFT_UBO81_COUNT];
    weft_weave_layout layout;
    int noise_seed;
} cloth_model;

static weft_rgb mean_brdf(const cloth_model *model, weft_vec3 light, weft_vec3 view)
{
    weft_rgb sum = {0};
    weft_barycentric l = weft_triangulation_lookup(model->directions, light);
    weft_barycentric v = weft_triangulation_lookup(model->directions, view);
    for (int i = 0; i < 9; i++) {
        if (l.index[i % 3] < 0 || v.index[i / 3] < 0)
            continue;
        weft_rgb value = model->mean[v.index[i / 3]][l.index[i % 3]];
        double weight = l.weight[i % 3] * v.weight[i / 3];
        sum.r += weight * value.r;
        sum.g += weight * value.g;
        sum.b += weight * value.b;
    }
    return sum;
}

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
    return weft_weave_brdf(&model->weave, &place, vector(at->light), vector(at->view));
}

static int places_along(float x, float y)
{
    return (int)fmin(fmax(ceil(2 * hypot((double)x, (double)y)), 1), 3);
}

static weft_rgba evaluate_cloth(void *context, const weft_surface_sample *at)
{
    cloth_model *model = context;
    weft_vec3 light = vector(at->light), view = vector(at->view);
    if (!(light.z > 0))
        return (weft_rgba){0, 0, 0, 1};
    double fade = fmin(fmax((width_of_footprint(at) + 1) / 2, 0), 1);
    int across = places_along(at->sides[0], at->sides[1]), up = places_along(at->sides[2], at->sides[3]);
    weft_rgb far = mean_brdf(model, light, view), sum = {fade * far.r, fade * far.g, fade * far.b};
    for (int i = 0; i < across * up; i++) {
        weft_rgb near = cloth_at(model, at, (i % across + 0.5) / across - 0.5, (i / across + 0.5) / up - 0.5);
        double weight = (1 - fade) / (across * up);
        sum.r += weight * near.r;
        sum.g += weight * near.g;
        sum.b += weight * near.b;
    }
    return lit((weft_rgb){WEFT_PI * sum.r, WEFT_PI * sum.g, WEFT_PI * sum.b}, light, 1);
}

/* Means of the tile: exact ones, but under noise those that test_weave_texels.c holds against the noisy texture. */
static void tabulate_means(cloth_model *model, const weft_vec3 direction[WEFT_UBO81_COUNT])
{
    weft_weave_texels texels;
    weft_error error = {0};
    expect_ok(weft_weave_texels_of(&model->weave, &texels, &error), &error);
    for (int i = 0; i < WEFT_UBO81_COUNT * WEFT_UBO81_COUNT; i++) {
        int view = i / WEFT_UBO81_COUNT, light = i % WEFT_UBO81_COUNT;
        const float *noisy = texels.noisy_mean ? texels.noisy_mean[i] : NULL;
        model->mean[view][light] = model->noise_seed && noisy
                                       ? (weft_rgb){(weft_real)noisy[0], (weft_real)noisy[1], (weft_real)noisy[2]}
                                       : weft_weave_mean_brdf(&model->weave, direction[light], direction[view]);
    }
    weft_weave_texels_free(&texels);
}

static void compare_weave(void **state, const char *name, double repeat, int noise_seed)
{
    stage *s = *state;
    weft_error error = {0};
    char path[512], warning[WEFT_MESSAGE_SIZE];
    cloth_model *model = calloc(1, sizeof *model);
    weft_vec3 direction[WEFT_UBO81_COUNT];
    for (int i = 0; i < WEFT_UBO81_COUNT; i++)
        direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, name);
    expect_ok(weft_weave_read(path, NULL, 0, &model->weave, warning, &error), &error);
    expect_ok(weft_triangulation_build(direction, WEFT_UBO81_COUNT, &model->directions, &error), &error);
    model->noise_seed = noise_seed;
    tabulate_means(model, direction);
    model->layout = (weft_weave_layout){2.25, 2, 0.3, -0.4};
    expect_ok(weft_player_set_weave(s->player, &model->weave, &model->layout, &error), &error);
    weft_scene scene = weft_scene_default();
    scene.repeat = repeat;
    scene.noise_seed = noise_seed;
    expect_small(name, stage_compare(s->player, scene, WEFT_MODE_ANALYTIC, WIDTH, HEIGHT, evaluate_cloth, model));
    weft_triangulation_free(model->directions);
    weft_weave_free(&model->weave);
    free(model);
}

static void analytic_equals_c_for_staple_and_filament_yarns(void **state)
{
    compare_weave(state, "cotton_denim", 4, 0);
    compare_weave(state, "silk_charmeuse", 2, 0);
}

static void analytic_equals_c_where_the_texture_fades_to_the_mean(void **state)
{
    compare_weave(state, "wool_gabardine", 15, 0);
    compare_weave(state, "polyester_lining", 60, 0);
}

static void noise_of_both_kinds_equals_c_near_and_far(void **state)
{
    compare_weave(state, "cotton_denim", 4, 7);
    compare_weave(state, "silk_shantung", 3, 7);
    compare_weave(state, "cotton_twill", 12, 1000000007);
    compare_weave(state, "polyester_lining", 40, 3);
}

static weft_rgba evaluate_threads(void *context, const weft_surface_sample *at)
{
    weft_vec3 light = vector(at->light);
    weft_rgb brdf = weft_microcylinder_brdf(context, WEFT_CLOTH_BY_AREA, light, vector(at->view));
    return lit((weft_rgb){WEFT_PI * brdf.r, WEFT_PI * brdf.g, WEFT_PI * brdf.b}, light, 1);
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
        expect_small(name[i],
                     stage_compare(s->player, scene, WEFT_MODE_ANALYTIC, WIDTH, HEIGHT, evaluate_threads, &prepared));
        scene.light[0].direction.theta_rad = weft_rad_of_deg(80);
    }
}

/* The plane from above: u and v run over it as often as square texels fit. */
static void texels_are_square_on_the_mesh(void **state)
{
    stage *s = *state;
    weft_material material;
    weft_mesh plane, drape;
    weft_surface_sample *surface;
    weft_error error = {0};
    stage_material(16, 8, 0, 0, 0, &material);
    expect_ok(weft_player_set_material(s->player, &material, &error), &error);
    expect_ok(weft_mesh_plane(&plane, &error), &error);
    expect_ok(weft_player_set_mesh(s->player, &plane, &error), &error);
    weft_scene scene = weft_scene_default();
    scene.orbit = (weft_orbit){weft_rad_of_deg(-90), weft_rad_of_deg(90), 3, 0, 0};
    scene.repeat = 3;
    expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, 64, 64, &surface, &error), &error);
    const weft_surface_sample *middle = &surface[32 * 64 + 32], *right = middle + 8, *up = middle - 8 * 64;
    assert_true(right->u > middle->u);
    assert_float_equal((double)(up->v - middle->v), 2 * (double)(right->u - middle->u), 1e-4);
    free(surface);
    expect_ok(weft_mesh_drape(&drape, &error), &error);
    expect_ok(weft_player_set_mesh(s->player, &drape, &error), &error);
    weft_mesh_free(&drape);
    weft_mesh_free(&plane);
    weft_material_free(&material);
}

int test_shaders(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_are_square_on_the_mesh),
        cmocka_unit_test(compressed_equals_c_with_two_lobes_and_81_views),
        cmocka_unit_test(compressed_equals_c_between_levels),
        cmocka_unit_test(compressed_equals_c_under_grazing_light_from_behind),
        cmocka_unit_test(compressed_equals_c_without_lobes_or_table),
        cmocka_unit_test(compressed_equals_c_with_a_light_table),
        cmocka_unit_test(compressed_equals_c_under_ceilings),
        cmocka_unit_test(compressed_equals_c_in_the_dark),
        cmocka_unit_test(components_equal_c),
        cmocka_unit_test(components_equal_c_between_levels),
        cmocka_unit_test(components_through_holes_equal_c),
        cmocka_unit_test(components_through_heights_equal_c),
        cmocka_unit_test(heights_count_on_their_levels),
        cmocka_unit_test(heights_of_layers_that_are_switched_off_are_not_used),
        cmocka_unit_test(the_first_layers_alone_equal_c),
        cmocka_unit_test(raw_equals_c_interpolation_in_views_and_lights),
        cmocka_unit_test(raw_through_heights_equals_c),
        cmocka_unit_test(heights_that_are_switched_off_are_not_used),
        cmocka_unit_test(raw_with_a_shared_exponent_equals_c_too),
        cmocka_unit_test(the_last_raw_level_is_the_mean_of_all_texels),
        cmocka_unit_test(a_dataset_that_does_not_fit_loses_its_finest_levels_first),
        cmocka_unit_test(analytic_equals_c_for_staple_and_filament_yarns),
        cmocka_unit_test(analytic_equals_c_where_the_texture_fades_to_the_mean),
        cmocka_unit_test(noise_of_both_kinds_equals_c_near_and_far),
        cmocka_unit_test(microcylinders_equal_c),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}

/* The shaders draw what the evaluators of materials and datasets in C compute from the same surface points. */
#include "stage.h"

#include "evaluate/model.h"
#include "player/draw/player_parts.h"
#include "reflectance/components/components.h"
#include "reflectance/lafortune/lafortune.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = STAGE_SHADED_WIDTH, HEIGHT = STAGE_SHADED_HEIGHT };

/* ---- Compressed ---- */

typedef struct material_model {
    weft_material material;
    weft_table_directions directions;
} material_model;

static weft_rgba evaluate_material(void *context, const weft_surface_sample *at)
{
    material_model *model = context;
    /* Opacity does not depend on the light, but the evaluator has none for a light below the horizon. */
    weft_vec3 light = stage_vector(at->light), above = light.z > 0 ? light : weft_vec3_of(0, 0, 1);
    weft_rgba value = weft_material_sample(&model->material, &model->directions, (weft_real)at->level, (weft_real)at->u,
                                           (weft_real)at->v, above, stage_vector(at->view));
    return stage_lit((weft_rgb){value.r, value.g, value.b}, light, value.a);
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
    stage_expect_small(what,
                       stage_compare(s->player, scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, evaluate_material, &model));
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
    scene.repeat = 18;
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
    scene.repeat = 18;
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
    stage_expect_small(what,
                       stage_compare(s->player, scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, evaluate_material, &model));
    weft_table_directions_free(&model.directions);
    weft_material_free(&model.material);
}

static void compressed_equals_c_under_ceilings(void **state)
{
    weft_scene scene = weft_scene_default();
    compare_under_ceilings(state, "ceilings, 81 views", 81, scene);
    scene.repeat = 18;
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
    weft_vec3 nearest = stage_vector((const float[]){0, 0, 1});
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
    weft_vec3 light = stage_vector(at->light), view = stage_vector(at->view);
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
    weft_rgb value = weft_components_sample_through(&model->maps, &model->relief, model->count, (weft_real)at->level,
                                                    (weft_real)at->u, (weft_real)at->v, stage_vector(at->light),
                                                    stage_vector(at->view));
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
    stage_expect_small(what, difference_of_components(state, kind, component_count, views, FLAT, scene));
}

static void components_equal_c(void **state)
{
    weft_scene scene = weft_scene_default();
    compare_components(state, "8 components over the light", WEFT_COMPONENTS_OF_LIGHT, 8, 0, scene);
    compare_components(state, "16 components over the half vector", WEFT_COMPONENTS_OF_HALF_VECTOR, 16, 0, scene);
    scene.light[0].direction = (weft_angles){weft_rad_of_deg(80), weft_rad_of_deg(100)};
    compare_components(state, "4 components under grazing light", WEFT_COMPONENTS_OF_HALF_VECTOR, 4, 0, scene);
    compare_components(state, "4 components, squared incidence", WEFT_COMPONENTS_OF_HALF_VECTOR_SQUARED, 4, 0, scene);
    compare_components(state, "8 coded components, grazing", WEFT_COMPONENTS_KRIGED_OVER_HALF_VECTOR, 8, 0, scene);
    compare_components(state, "8 coded components over the light", WEFT_COMPONENTS_KRIGED_OVER_LIGHT, 8, 0, scene);
}

static void components_equal_c_between_levels(void **state)
{
    weft_scene scene = weft_scene_default();
    scene.repeat = 18;
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
    return stage_lit((weft_rgb){brdf.r * WEFT_PI, brdf.g * WEFT_PI, brdf.b * WEFT_PI}, light, 1);
}

static weft_rgba evaluate_raw(void *context, const weft_surface_sample *at)
{
    raw_model *model = context;
    weft_rgb brdf = {0};
    weft_error error = {0};
    weft_vec3 light = stage_vector(at->light), view = stage_vector(at->view);
    expect_ok(weft_raw_btf_sample(model->raw, (weft_real)at->u, (weft_real)at->v, light, view, &brdf, &error), &error);
    return lit_raw(brdf, light);
}

static weft_rgba evaluate_raw_mean(void *context, const weft_surface_sample *at)
{
    raw_model *model = context;
    weft_rgb brdf = {0};
    weft_error error = {0};
    weft_vec3 light = stage_vector(at->light);
    expect_ok(weft_raw_btf_mean(model->raw, light, stage_vector(at->view), &brdf, &error), &error);
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
    stage_expect_small("raw 81 x 81",
                       stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate_raw, &model));
    close_raw(&model);
    model = open_raw(s, 5, 19, 37, WEFT_REFLECTANCE, WEFT_RAW_HALF, SIZE_MAX);
    stage_expect_small("raw 19 x 37",
                       stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate_raw, &model));
    close_raw(&model);
}

static void raw_through_heights_equals_c(void **state)
{
    stage *s = *state;
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_NONE;
    for (int hills = 0; hills < 2; hills++) {
        raw_model model = open_relief(s, 8, hills);
        stage_expect_small(hills ? "raw through hills" : "raw through a plane",
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
    stage_expect_small("raw packed",
                       stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate_raw, &model));
    close_raw(&model);
}

static void the_last_raw_level_is_the_mean_of_all_texels(void **state)
{
    stage *s = *state;
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_FIXED;
    scene.level = 99;
    raw_model model = open_raw(s, 8, 19, 37, WEFT_REFLECTANCE_COSINE, WEFT_RAW_HALF, SIZE_MAX);
    stage_expect_small("raw mean",
                       stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate_raw_mean, &model));
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
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}

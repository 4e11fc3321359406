/* The same dataset in every format: what is drawn is what the evaluator in C finds in the file. */
#include "../stage.h"
#include "evaluate/model.h"
#include "player/draw/player_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 200, HEIGHT = 150, VIEWS = 19, LIGHTS = 19 };

static const char *const path = "test_raw_formats.btf.h5";

static const weft_raw_format formats[] = {WEFT_RAW_HALF, WEFT_RAW_SHARED_EXPONENT, WEFT_RAW_BC6H};
enum { FORMATS = sizeof formats / sizeof *formats };

/* Floors in 8-bit sRGB values: sixteen places on a line between two colours are less than half floats. */
static const double rmse_floor = 1, largest_floor[FORMATS] = {4, 4, 8};

/* ---- A dyed cloth that shines white ---- */

static float sample_of(const weft_dataset_layout *layout, int image, int x, int y, int channel)
{
    static const double dye[3] = {0.5, 0.3, 0.12};
    weft_vec3 l = layout->light[image], v = layout->view[layout->view_of_image[image]];
    double thread = 0.6 + 0.4 * sin(x * 1.3) * cos(y * 0.9), gloss = fmax(0, l.z * v.z - l.x * v.x - l.y * v.y);
    return (float)((dye[channel] * thread * (1 + 0.3 * v.x) + 0.3 * thread * pow(gloss, 6)) * l.z);
}

static void put_images(weft_dataset_writer *writer, const weft_dataset_layout *layout)
{
    weft_error error = {0};
    int texels = layout->width * layout->height;
    weft_half *sample = calloc((size_t)texels, 3 * sizeof *sample);
    assert_non_null(sample);
    for (int image = 0; image < layout->image_count; image++) {
        for (int i = 0; i < 3 * texels; i++)
            sample[i] =
                weft_half_of_float(sample_of(layout, image, i / 3 % layout->width, i / 3 / layout->width, i % 3));
        expect_ok(weft_dataset_writer_put_image(writer, image, sample, NULL, &error), &error);
    }
    free(sample);
}

/* Views near the normal see half through every texel, others a quarter; from `holes` on texels are whole. */
static float opacity_of(const weft_dataset_layout *layout, int x, int view, int holes)
{
    return x >= holes ? 1 : layout->view[view].z > 0.9 ? 0.5f : 0.75f;
}

static void put_opacity(weft_dataset_writer *writer, const weft_dataset_layout *layout, int holes)
{
    weft_error error = {0};
    size_t count = (size_t)layout->width * (size_t)layout->height * VIEWS;
    float *opacity = calloc(count, sizeof *opacity);
    assert_non_null(opacity);
    for (size_t i = 0; i < count; i++)
        opacity[i] = opacity_of(layout, (int)(i / VIEWS) % layout->width, (int)(i % VIEWS), holes);
    expect_ok(weft_dataset_writer_put_opacity(writer, opacity, &error), &error);
    free(opacity);
}

/* holes -1: no opacity. */
static weft_dataset *make_dataset(int width, int height, int holes)
{
    weft_error error = {0};
    weft_dataset_writer *writer;
    weft_dataset *dataset;
    weft_dataset_layout layout = {.width = width,
                                  .height = height,
                                  .image_count = VIEWS * LIGHTS,
                                  .view_count = VIEWS,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .texel_pitch_mm = 0.5};
    expect_ok(weft_dataset_layout_allocate(&layout, &error), &error);
    for (int i = 0; i < layout.image_count; i++) {
        layout.light[i] = weft_direction_of_angles(weft_ubo81_angles(i % LIGHTS));
        layout.view[i / LIGHTS] = weft_direction_of_angles(weft_ubo81_angles(i / LIGHTS));
        layout.view_of_image[i] = i / LIGHTS;
    }
    expect_ok(weft_dataset_writer_create(path, &layout, &writer, &error), &error);
    put_images(writer, &layout);
    if (holes >= 0)
        put_opacity(writer, &layout, holes);
    expect_ok(weft_dataset_writer_finish(writer, NULL, &error), &error);
    weft_dataset_layout_free(&layout);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    return dataset;
}

static void close_dataset(weft_dataset *dataset)
{
    weft_dataset_close(dataset);
    unlink(path);
}

/* False where the driver lacks it. */
static bool show(weft_player *player, weft_dataset *dataset, weft_raw_format format)
{
    weft_raw_texture texture;
    weft_error error = {0};
    const weft_raw_limits limits = weft_raw_texture_limits(format);
    if (format == WEFT_RAW_BC6H && !limits.has_bc6h)
        return false;
    expect_ok(weft_raw_texture_upload(dataset, &limits, NULL, &texture, &error), &error);
    assert_int_equal(texture.plan.tiles[WEFT_RAW_SAMPLES].format, format);
    weft_player_take_raw(player, &texture, (const double[2]){0, 0});
    return true;
}

/* ---- Against the evaluator ---- */

static weft_rgba evaluate(void *context, const weft_surface_sample *at)
{
    weft_rgb brdf = {0};
    weft_error error = {0};
    weft_vec3 light = weft_vec3_of((weft_real)at->light[0], (weft_real)at->light[1], (weft_real)at->light[2]);
    weft_vec3 view = weft_vec3_of((weft_real)at->view[0], (weft_real)at->view[1], (weft_real)at->view[2]);
    expect_ok(weft_raw_btf_sample(context, (weft_real)at->u, (weft_real)at->v, light, view, &brdf, &error), &error);
    double scale = WEFT_PI * fmax(light.z, 0);
    return (weft_rgba){brdf.r * scale, brdf.g * scale, brdf.b * scale, 1};
}

static void compare(stage *s, int width, int height)
{
    weft_raw_btf *raw;
    weft_error error = {0};
    weft_scene scene = weft_scene_default();
    scene.level_choice = WEFT_LEVEL_NONE;
    weft_dataset *dataset = make_dataset(width, height, -1);
    expect_ok(weft_raw_btf_create(dataset, &raw, &error), &error);
    for (int i = 0; i < FORMATS; i++) {
        if (!show(s->player, dataset, formats[i]))
            continue;
        stage_difference difference = stage_compare(s->player, scene, WEFT_MODE_RAW, WIDTH, HEIGHT, evaluate, raw);
        printf("%d x %d as %s: RMSE %.4f/255, largest %g/255 over %ld pixels\n", width, height,
               weft_raw_format_name(formats[i]), difference.rmse, difference.largest, difference.pixels);
        assert_true(difference.pixels > WIDTH * HEIGHT / 5);
        assert_true(difference.rmse < rmse_floor);
        assert_true(difference.largest < largest_floor[width * height == 1 ? 0 : i]);
    }
    weft_raw_btf_free(raw);
    close_dataset(dataset);
}

static void every_format_is_near_the_evaluator(void **state)
{
    compare(*state, 16, 16);
}

static void sizes_that_no_block_divides_are_filled_up(void **state)
{
    compare(*state, 5, 7);
    compare(*state, 2, 3);
}

static void one_texel_is_exact_in_every_format(void **state)
{
    compare(*state, 1, 1);
}

/* ---- Opacity ---- */

static weft_scene scene_from_above(void)
{
    weft_scene scene = weft_scene_default();
    scene.orbit =
        (weft_orbit){.azimuth_rad = weft_rad_of_deg(-90), .elevation_rad = weft_rad_of_deg(90), .distance = 3};
    scene.light[0].direction = (weft_angles){0, 0};
    scene.repeat = 1;
    scene.labels = false;
    scene.pane_count = 1;
    scene.pane[0] = WEFT_MODE_RAW;
    return scene;
}

static double value_of_middle(weft_player *player, const weft_scene *scene)
{
    weft_image image;
    weft_error error = {0};
    expect_ok(weft_player_picture(player, scene, 49, 49, 1, NULL, &image, &error), &error);
    double value = (double)image.pixels[3 * (24 * 49 + 24)];
    weft_image_free(&image);
    return value;
}

static void set_plane(weft_player *player)
{
    weft_mesh plane;
    weft_error error = {0};
    expect_ok(weft_mesh_plane(&plane, &error), &error);
    expect_ok(weft_player_set_mesh(player, &plane, &error), &error);
    weft_mesh_free(&plane);
}

/* The background by itself, the whole cloth and the cloth with holes: its reflectance is that of the whole texel. */
static void holes_show_the_background_in_every_format(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    set_plane(player);
    weft_scene scene = scene_from_above(), away = scene;
    away.orbit.pan_right = 20;
    weft_dataset *dataset = make_dataset(4, 4, 0);
    assert_true(show(player, dataset, WEFT_RAW_HALF));
    assert_true(player->raw.opaque);
    double background = value_of_middle(player, &away), whole = value_of_middle(player, &scene);
    close_dataset(dataset);
    assert_true(background > 0.01);
    dataset = make_dataset(4, 4, 4);
    for (int i = 0; i < FORMATS; i++) {
        if (!show(player, dataset, formats[i]))
            continue;
        assert_false(player->raw.opaque);
        for (int stochastic = 0; stochastic < 2; stochastic++) {
            scene.filter = stochastic ? WEFT_FILTER_STOCHASTIC : WEFT_FILTER_EXACT;
            assert_float_equal(value_of_middle(player, &scene), whole + background * (1 - 128 / 255.0), 0.03 * whole);
        }
    }
    close_dataset(dataset);
}

static void opacity_is_interpolated_between_texels_and_levels(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    set_plane(player);
    weft_scene scene = scene_from_above(), away = scene;
    away.orbit.pan_right = 20;
    weft_dataset *whole_dataset = make_dataset(4, 4, 0);
    scene.level_choice = WEFT_LEVEL_FIXED;
    scene.level = 2;
    assert_true(show(player, whole_dataset, WEFT_RAW_HALF));
    double background = value_of_middle(player, &away), whole = value_of_middle(player, &scene);
    close_dataset(whole_dataset);
    weft_dataset *dataset = make_dataset(4, 4, 1);
    assert_true(show(player, dataset, WEFT_RAW_HALF));
    assert_float_equal(value_of_middle(player, &scene), whole + background * 0.125, 0.01 * whole);
    close_dataset(dataset);
}

int test_raw_formats(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_is_near_the_evaluator),
        cmocka_unit_test(sizes_that_no_block_divides_are_filled_up),
        cmocka_unit_test(one_texel_is_exact_in_every_format),
        cmocka_unit_test(holes_show_the_background_in_every_format),
        cmocka_unit_test(opacity_is_interpolated_between_texels_and_levels),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}

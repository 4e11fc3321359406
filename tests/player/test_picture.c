/* Layouts, filters and lights of whole pictures. */
#include "base/numeric/error_summary.h"
#include "base/picture/colour.h"
#include "player/scene/environment.h"
#include "player/scene/false_colour.h"
#include "stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 160, HEIGHT = 120, PIXELS = WIDTH * HEIGHT };

static const char *const dataset_path = "test_picture.btf.h5";

static void set_models(weft_player *player)
{
    weft_error error = {0};
    weft_material material;
    weft_dataset *dataset;
    int skipped;
    stage_material(20, 13, 2, 81, 0, &material);
    expect_ok(weft_player_set_material(player, &material, &error), &error);
    weft_material_free(&material);
    stage_dataset(dataset_path, 8, 19, 37, WEFT_REFLECTANCE_COSINE, false);
    expect_ok(weft_dataset_open(dataset_path, &dataset, &error), &error);
    expect_ok(weft_player_set_dataset(player, dataset, NULL, &skipped, &error), &error);
    weft_dataset_close(dataset);
    unlink(dataset_path);
}

static int open_with_models(void **state)
{
    stage_open(state);
    set_models(((stage *)*state)->player);
    return 0;
}

static weft_scene scene_of(weft_mode mode)
{
    weft_scene scene = weft_scene_default();
    scene.pane[0] = mode;
    scene.labels = false;
    return scene;
}

static weft_image draw_of_size(void **state, weft_scene scene, int width, int height, int samples)
{
    stage *s = *state;
    weft_error error = {0};
    weft_image image;
    expect_ok(weft_player_picture(s->player, &scene, width, height, samples, NULL, &image, &error), &error);
    return image;
}

static weft_image draw(void **state, weft_scene scene, int samples)
{
    return draw_of_size(state, scene, WIDTH, HEIGHT, samples);
}

static double relative_rmse(const weft_image *a, const weft_image *b)
{
    weft_error_sums sums = {0};
    for (int i = 0; i < 3 * a->width * a->height; i++)
        weft_error_sums_add_value(&sums, (double)b->pixels[i], (double)a->pixels[i]);
    return weft_error_sums_relative_rmse(&sums);
}

static void a_wipe_shows_one_mode_left_of_the_divider_and_another_right_of_it(void **state)
{
    weft_scene scene = scene_of(WEFT_MODE_RAW);
    weft_image first = draw(state, scene, 1), second = draw(state, scene_of(WEFT_MODE_COMPRESSED), 1);
    scene.layout = WEFT_LAYOUT_WIPE;
    scene.pane[1] = WEFT_MODE_COMPRESSED;
    scene.divider = 0.4;
    weft_image wipe = draw(state, scene, 1);
    for (int i = 0; i < 3 * PIXELS; i++) {
        bool left = i / 3 % WIDTH < 0.4 * WIDTH;
        assert_float_equal(wipe.pixels[i], left ? first.pixels[i] : second.pixels[i], 0);
    }
    weft_image_free(&first);
    weft_image_free(&second);
    weft_image_free(&wipe);
}

static void a_difference_is_signed_and_vanishes_for_equal_modes(void **state)
{
    weft_scene scene = scene_of(WEFT_MODE_RAW);
    weft_image first = draw(state, scene, 2), second = draw(state, scene_of(WEFT_MODE_COMPRESSED), 2);
    scene.layout = WEFT_LAYOUT_DIFFERENCE;
    scene.pane[1] = WEFT_MODE_COMPRESSED;
    weft_image difference = draw(state, scene, 2);
    int brighter = 0, darker = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        assert_float_equal(difference.pixels[i], second.pixels[i] - first.pixels[i], 1e-6);
        brighter += difference.pixels[i] > 0.01f;
        darker += difference.pixels[i] < -0.01f;
    }
    assert_true(brighter > 100 && darker > 100);
    weft_image_free(&difference);
    scene.pane[1] = WEFT_MODE_RAW;
    difference = draw(state, scene, 2);
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_float_equal(difference.pixels[i], 0, 0);
    weft_image_free(&first);
    weft_image_free(&second);
    weft_image_free(&difference);
}

static void set_mesh(void **state, const char *name, bool coarse)
{
    stage *s = *state;
    weft_error error = {0};
    weft_mesh mesh;
    expect_ok(weft_mesh_open(name, &mesh, &error), &error);
    mesh.coarse_count = coarse ? mesh.coarse_count : 0;
    expect_ok(weft_player_set_mesh(s->player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
}

/* One frame is far off; the mean comes near, since every choice has the probability of its weight. */
static void expect_the_same_mean(void **state, weft_scene scene, int samples, double most)
{
    enum { SIDE = 72 };
    set_mesh(state, "plane", true);
    scene.filter = WEFT_FILTER_EXACT;
    scene.repeat = 6;
    weft_image exact = draw_of_size(state, scene, SIDE, SIDE, samples);
    scene.filter = WEFT_FILTER_STOCHASTIC;
    weft_image one = draw_of_size(state, scene, SIDE, SIDE, 1), mean = draw_of_size(state, scene, SIDE, SIDE, samples);
    set_mesh(state, "drape", true);
    double far = relative_rmse(&one, &exact), near = relative_rmse(&mean, &exact);
    printf("%s: one frame %.2f %%, mean of %d %.3f %%\n", weft_mode_name(scene.pane[0]), 100 * far, samples * samples,
           100 * near);
    assert_true(far > 5 * near);
    assert_true(near < most);
    weft_image_free(&exact);
    weft_image_free(&one);
    weft_image_free(&mean);
}

static void stochastic_frames_have_the_exact_mean(void **state)
{
    expect_the_same_mean(state, scene_of(WEFT_MODE_COMPRESSED), 10, 0.013);
    expect_the_same_mean(state, scene_of(WEFT_MODE_RAW), 8, 0.006);
}

/* What is held to bounds in each frame is not the same as a mean that is. */
static void take_bounds_away(weft_material *material)
{
    for (int k = 0; k < material->level_count; k++) {
        size_t squares = weft_ceiling_count(material->level[k].width, material->level[k].height);
        memset(material->components->level[k].ceiling, 255, squares);
        memset(material->components->level[k].floor, 0, 3 * squares);
    }
}

/* With hills, if there are levels that are seen through them. */
static void set_components(void **state, int levels_through)
{
    stage *s = *state;
    weft_error error = {0};
    weft_material material;
    stage_material(20, 13, 1, 37, 0, &material);
    stage_components(WEFT_COMPONENTS_OF_HALF_VECTOR, 8, &material);
    take_bounds_away(&material);
    if (levels_through > 0)
        stage_heights(true, levels_through, &material);
    expect_ok(weft_player_set_material(s->player, &material, &error), &error);
    weft_material_free(&material);
}

static void stochastic_layers_have_the_exact_mean(void **state)
{
    set_components(state, 0);
    expect_the_same_mean(state, scene_of(WEFT_MODE_COMPRESSED), 8, 0.013);
}

/* Level 1 is seen through heights, level 2 is not. */
static void stochastic_layers_through_heights_have_the_exact_mean(void **state)
{
    weft_scene scene = scene_of(WEFT_MODE_COMPRESSED);
    set_components(state, 2);
    expect_the_same_mean(state, scene, 8, 0.008);
    scene.level_choice = WEFT_LEVEL_FIXED;
    scene.level = 1.37;
    expect_the_same_mean(state, scene, 8, 0.008);
}

static void nothing_gets_brighter_in_shadow_and_some_of_it_dark(void **state)
{
    weft_scene scene = scene_of(WEFT_MODE_COMPRESSED);
    scene.light[0].direction = (weft_angles){weft_rad_of_deg(65), weft_rad_of_deg(-160)};
    weft_image lit = draw(state, scene, 1);
    scene.shadows = true;
    weft_image shadowed = draw(state, scene, 1);
    int dark = 0, same = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        assert_true(shadowed.pixels[i] <= lit.pixels[i] + 1e-6f);
        dark += lit.pixels[i] > 0.05f && shadowed.pixels[i] < 0.01f;
        same += lit.pixels[i] > 0.1f && fabsf(shadowed.pixels[i] - lit.pixels[i]) < 1e-6f;
    }
    printf("%d channels in shadow, %d bright ones untouched\n", dark, same);
    assert_true(dark > 300);
    assert_true(same > 1000);
    weft_image_free(&lit);
    weft_image_free(&shadowed);
}

static void lights_add_up(void **state)
{
    weft_scene scene = scene_of(WEFT_MODE_RAW);
    weft_light first = scene.light[0], second = {{weft_rad_of_deg(30), 1}, {0.5, 1, 2}};
    weft_image a = draw(state, scene, 1);
    scene.light[0] = second;
    weft_image b = draw(state, scene, 1);
    scene.light[0] = first;
    scene.light[1] = second;
    scene.light_count = 2;
    weft_image both = draw(state, scene, 1);
    scene.light_count = 0;
    weft_image none = draw(state, scene, 1);
    for (int i = 0; i < 3 * PIXELS; i++) {
        bool covered = none.pixels[i] == 0; /* the background is not black */
        if (covered)
            assert_float_equal(both.pixels[i], a.pixels[i] + b.pixels[i], 1e-5f);
    }
    weft_image_free(&a);
    weft_image_free(&b);
    weft_image_free(&both);
    weft_image_free(&none);
}

/* Under a white sky a matt surface shows its albedo, whatever its slope. */
static void a_matt_surface_under_a_white_sky_shows_its_albedo(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_material material;
    weft_image sky;
    expect_ok(weft_material_create(1, 1, 0, 0, 0, true, &material, &error), &error);
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_frame_encode(&frame, material.level[0].frame);
    for (int c = 0; c < 3; c++)
        material.level[0].diffuse[c] = weft_half_of_float(0.5f);
    expect_ok(weft_player_set_material(s->player, &material, &error), &error);
    weft_material_free(&material);
    expect_ok(weft_image_create(64, 32, &sky, &error), &error);
    for (int i = 0; i < 3 * 64 * 32; i++)
        sky.pixels[i] = 1;
    expect_ok(weft_player_set_environment(s->player, &sky, WEFT_ENVIRONMENT_REGIONS, &error), &error);
    weft_image_free(&sky);
    weft_scene scene = scene_of(WEFT_MODE_COMPRESSED);
    scene.environment = scene.environment_reference = true;
    scene.light_count = 0;
    weft_image image = draw(state, scene, 1);
    int covered = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (image.pixels[3 * i] > 0.9f)
            continue; /* the sky itself */
        covered++;
        if (fabsf(image.pixels[3 * i] - 0.5f) > 0.02f && image.pixels[3 * i] < 0.6f)
            fail_msg("albedo %g instead of 0.5 at %d, %d", (double)image.pixels[3 * i], i % WIDTH, i / WIDTH);
    }
    assert_true(covered > PIXELS / 5);
    weft_image_free(&image);
    expect_ok(weft_player_set_environment(s->player, NULL, WEFT_ENVIRONMENT_REGIONS, &error), &error);
    set_models(s->player);
}

static void switches_of_the_material_take_its_parts_away(void **state)
{
    weft_scene scene = scene_of(WEFT_MODE_COMPRESSED);
    weft_image whole = draw(state, scene, 1);
    scene.lobe[0] = scene.lobe[1] = false;
    weft_image matt = draw(state, scene, 1);
    scene.view_table = false;
    weft_image without_table = draw(state, scene, 1);
    int less = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        less += matt.pixels[i] < whole.pixels[i] - 1e-3f;
        assert_true(matt.pixels[i] <= whole.pixels[i] + 1e-6f);
    }
    assert_true(less > 1000);
    assert_true(relative_rmse(&without_table, &matt) > 0.05);
    weft_image_free(&whole);
    weft_image_free(&matt);
    weft_image_free(&without_table);
}

static void what_is_shown_rises_with_radiance_and_keeps_highlights_apart(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_image image;
    weft_scene scene = weft_scene_default();
    scene.tone = WEFT_TONE_SOFT;
    expect_ok(weft_image_create(64, 1, &image, &error), &error);
    for (int i = 0; i < 3 * 64; i++)
        image.pixels[i] = 0.1f * (float)(i / 3);
    weft_scene_show(&scene, &image);
    for (int x = 1; x < 64; x++)
        assert_true(image.pixels[3 * x] > image.pixels[3 * (x - 1)]);
    assert_true(image.pixels[3 * 63] < 1);
    weft_image_free(&image);
}

/* White without a difference, red above, blue below, ever darker. */
static void differences_are_told_by_hue_and_darkness(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_image image;
    weft_scene scene = weft_scene_default();
    scene.layout = WEFT_LAYOUT_DIFFERENCE;
    expect_ok(weft_image_create(41, 1, &image, &error), &error);
    for (int x = 0; x < 41; x++) {
        for (int c = 0; c < 3; c++)
            image.pixels[3 * x + c] = WEFT_SCENE_FULL_DIFFERENCE * (float)(x - 20) / 20;
    }
    weft_scene_show(&scene, &image);
    const float *zero = image.pixels + 3 * 20;
    assert_true(zero[0] > 0.95f && zero[0] == zero[1] && zero[1] == zero[2]);
    for (int x = 21; x < 41; x++) {
        const float *above = image.pixels + 3 * x, *below = image.pixels + 3 * (40 - x);
        assert_true(above[0] > above[2] && below[2] > below[0]);
        assert_true(weft_luminance(above) < weft_luminance(above - 3));
        assert_true(weft_luminance(below) < weft_luminance(below + 3));
    }
    weft_image_free(&image);
}

/* What the shaders show in false colour is what the C twins, and with them the swatches of the panel, say of it. */
static void false_colours_are_those_of_their_legends(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_surface_sample *at;
    double last_view, last_light;
    weft_scene scene = scene_of(WEFT_MODE_RAW);
    scene.light[0].direction.theta_rad = weft_rad_of_deg(75);
    weft_image plain = draw(state, scene, 1);
    scene.show_extrapolation = true;
    weft_image tinted = draw(state, scene, 1);
    scene.show_extrapolation = false;
    scene.show_level = true;
    weft_image levels = draw(state, scene, 1);
    weft_player_last_ring(s->player, WEFT_MODE_RAW, &last_view, &last_light);
    expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_RAW, WIDTH, HEIGHT, &at, &error), &error);
    long covered = 0, beyond[2] = {0};
    for (int i = 0; i < PIXELS; i++) {
        if (at[i].covered == 0)
            continue;
        bool view = (double)at[i].view[2] < cos(last_view) - 1e-3;
        bool light = at[i].light[2] > 0 && (double)at[i].light[2] < cos(last_light) - 1e-3;
        float level[3], tint[3];
        weft_level_shown(plain.pixels + 3 * i, at[i].level, level);
        weft_extrapolation_shown(plain.pixels + 3 * i, (weft_missing){.view = view, .light = light}, tint);
        for (int c = 0; c < 3; c++) {
            assert_float_equal(levels.pixels[3 * i + c], level[c], 1e-5);
            assert_float_equal(tinted.pixels[3 * i + c], tint[c], 1e-5);
        }
        covered++;
        beyond[0] += view;
        beyond[1] += light;
    }
    assert_true(covered > PIXELS / 5 && beyond[0] > 100 && beyond[1] > 100);
    free(at);
    weft_image_free(&plain);
    weft_image_free(&tinted);
    weft_image_free(&levels);
}

static void read_screen(const weft_canvas *canvas, const weft_scene *scene, uint8_t *rgba)
{
    GLuint buffer, texture;
    weft_error error = {0};
    const weft_texture_format bytes = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    expect_ok(weft_gl_texture(bytes, WIDTH, HEIGHT, 0, NULL, &texture, &error), &error);
    glGenFramebuffers(1, &buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, buffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    weft_canvas_present(canvas, scene, 0);
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    glDeleteFramebuffers(1, &buffer);
    glDeleteTextures(1, &texture);
}

static void the_window_shows_differences_as_saved_pictures_do(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_scene scene = scene_of(WEFT_MODE_RAW);
    scene.layout = WEFT_LAYOUT_DIFFERENCE;
    scene.pane[1] = WEFT_MODE_COMPRESSED;
    weft_canvas canvas;
    weft_image image;
    static uint8_t rgba[4 * PIXELS];
    expect_ok(weft_canvas_create(WIDTH, HEIGHT, &canvas, &error), &error);
    weft_canvas_begin_frame(&canvas);
    expect_ok(weft_player_draw(s->player, &scene, WIDTH, HEIGHT, (weft_sampling){0}, &error), &error);
    weft_canvas_end_frame(&canvas);
    expect_ok(weft_canvas_read(&canvas, &image, &error), &error);
    read_screen(&canvas, &scene, rgba);
    weft_scene_show(&scene, &image);
    for (int i = 0; i < PIXELS; i++) {
        const uint8_t *shown = rgba + 4 * ((HEIGHT - 1 - i / WIDTH) * WIDTH + i % WIDTH);
        for (int c = 0; c < 3; c++)
            assert_float_equal((float)shown[c], 255 * image.pixels[3 * i + c], 0.6);
    }
    weft_image_free(&image);
    weft_canvas_free(&canvas);
}

static weft_image frame_of_components(void **state, int components, bool interactive)
{
    stage *s = *state;
    weft_error error = {0};
    weft_scene scene = scene_of(WEFT_MODE_COMPRESSED);
    weft_canvas canvas;
    weft_image image;
    scene.components = components;
    scene.filter = interactive ? WEFT_FILTER_AUTO : WEFT_FILTER_STOCHASTIC;
    expect_ok(weft_canvas_create(WIDTH, HEIGHT, &canvas, &error), &error);
    weft_canvas_begin_frame(&canvas);
    weft_sampling sampling = {.frame = 3, .interactive = interactive};
    expect_ok(weft_player_draw(s->player, &scene, WIDTH, HEIGHT, sampling, &error), &error);
    weft_canvas_end_frame(&canvas);
    expect_ok(weft_canvas_read(&canvas, &image, &error), &error);
    weft_canvas_free(&canvas);
    return image;
}

static void an_interactive_frame_has_the_first_sixteen_components(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_material material;
    size_t size = sizeof(float) * 3 * PIXELS;
    stage_material(8, 8, 1, 0, 0, &material);
    stage_components(WEFT_COMPONENTS_OF_LIGHT, 32, &material);
    expect_ok(weft_player_set_material(s->player, &material, &error), &error);
    weft_material_free(&material);
    weft_image interactive = frame_of_components(state, 64, true), first = frame_of_components(state, 16, false),
               all = frame_of_components(state, 64, false), few = frame_of_components(state, 8, true);
    assert_memory_equal(interactive.pixels, first.pixels, size);
    assert_memory_not_equal(interactive.pixels, all.pixels, size);
    assert_memory_not_equal(interactive.pixels, few.pixels, size);
    weft_image *const image[] = {&interactive, &first, &all, &few};
    for (int i = 0; i < 4; i++)
        weft_image_free(image[i]);
}

static void coarse_triangles_of_a_small_picture_hardly_change_it(void **state)
{
    weft_scene scene = scene_of(WEFT_MODE_COMPRESSED);
    weft_image coarse = draw(state, scene, 1), sampled = draw(state, scene, 6);
    set_mesh(state, "drape", false);
    weft_image fine = draw(state, scene, 1), fine_sampled = draw(state, scene, 6);
    set_mesh(state, "drape", true);
    double mean = 0;
    for (int i = 0; i < 3 * PIXELS; i++)
        mean += fabs((double)coarse.pixels[i] - (double)fine.pixels[i]) / (3 * PIXELS);
    assert_true(mean > 0 && mean < 0.01);
    /* Thirty-six times the pixels are worth the finer ones. */
    assert_memory_equal(sampled.pixels, fine_sampled.pixels, 3 * PIXELS * sizeof *fine_sampled.pixels);
    weft_image_free(&coarse);
    weft_image_free(&sampled);
    weft_image_free(&fine);
    weft_image_free(&fine_sampled);
}

int test_picture(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wipe_shows_one_mode_left_of_the_divider_and_another_right_of_it),
        cmocka_unit_test(a_difference_is_signed_and_vanishes_for_equal_modes),
        cmocka_unit_test(stochastic_frames_have_the_exact_mean),
        cmocka_unit_test(stochastic_layers_have_the_exact_mean),
        cmocka_unit_test(stochastic_layers_through_heights_have_the_exact_mean),
        cmocka_unit_test(nothing_gets_brighter_in_shadow_and_some_of_it_dark),
        cmocka_unit_test(lights_add_up),
        cmocka_unit_test(a_matt_surface_under_a_white_sky_shows_its_albedo),
        cmocka_unit_test(switches_of_the_material_take_its_parts_away),
        cmocka_unit_test(coarse_triangles_of_a_small_picture_hardly_change_it),
        cmocka_unit_test(what_is_shown_rises_with_radiance_and_keeps_highlights_apart),
        cmocka_unit_test(differences_are_told_by_hue_and_darkness),
        cmocka_unit_test(false_colours_are_those_of_their_legends),
        cmocka_unit_test(the_window_shows_differences_as_saved_pictures_do),
        cmocka_unit_test(an_interactive_frame_has_the_first_sixteen_components),
    };
    return cmocka_run_group_tests(tests, open_with_models, stage_close);
}

/* The frames of a picture that moves: small ones enlarged, and few lights in the place of many. */
#include "player/draw/pace.h"
#include "player/scene/environment.h"
#include "stage.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 160, HEIGHT = 120, PIXELS = WIDTH * HEIGHT, WIDE = 3 * WIDTH };

static const weft_pace whole = {.exact_ms = 1000}, half = {.exact_ms = 1000, .step = 3};

static int open_with_material(void **state)
{
    stage_open(state);
    weft_error error = {0};
    weft_material material;
    stage_material(20, 13, 2, 81, 0, &material);
    expect_ok(weft_player_set_material(((stage *)*state)->player, &material, &error), &error);
    weft_material_free(&material);
    return 0;
}

static weft_scene scene_of_cloth(void)
{
    weft_scene scene = weft_scene_default();
    scene.filter = WEFT_FILTER_EXACT;
    scene.labels = false;
    return scene;
}

static weft_image moving(void **state, const weft_scene *scene, const weft_pace *pace, weft_canvas *canvas)
{
    stage *s = *state;
    weft_error error = {0};
    weft_image image;
    expect_ok(weft_player_draw_interactive(s->player, scene, pace, canvas, &error), &error);
    expect_ok(weft_canvas_read(canvas, &image, &error), &error);
    return image;
}

static weft_canvas canvas_of(int width, int height)
{
    weft_error error = {0};
    weft_canvas canvas;
    expect_ok(weft_canvas_create(width, height, &canvas, &error), &error);
    return canvas;
}

/* RMS over the inner pixels, `b` being moved to the right and down. */
static double difference(const weft_image *a, const weft_image *b, int right, int down)
{
    double sum = 0;
    for (int y = 2; y < HEIGHT - 2; y++) {
        for (int x = 2; x < WIDTH - 2; x++) {
            double d = (double)a->pixels[3 * (y * WIDTH + x)] - (double)b->pixels[3 * ((y - down) * WIDTH + x - right)];
            sum += d * d;
        }
    }
    return sqrt(sum / PIXELS);
}

static void a_small_frame_shows_the_same_at_the_same_places(void **state)
{
    static const int shift[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    weft_scene scene = scene_of_cloth();
    scene.repeat = 0.5; /* texels of several pixels */
    weft_canvas canvas = canvas_of(WIDTH, HEIGHT);
    weft_image all = moving(state, &scene, &whole, &canvas);
    assert_int_equal(canvas.drawn_width, WIDTH);
    weft_image small = moving(state, &scene, &half, &canvas);
    assert_int_equal(canvas.drawn_width, WIDTH / 2);
    assert_int_equal(canvas.drawn_height, HEIGHT / 2);
    assert_memory_not_equal(all.pixels, small.pixels, sizeof(float) * 3 * PIXELS);
    double here = difference(&all, &small, 0, 0), sum_all = 0, sum_small = 0;
    for (int i = 0; i < 4; i++)
        assert_true(1.2 * here < difference(&all, &small, shift[i][0], shift[i][1]));
    for (int i = 0; i < 3 * PIXELS; i++) {
        sum_all += (double)all.pixels[i];
        sum_small += (double)small.pixels[i];
    }
    assert_float_equal(sum_small / sum_all, 1, 0.02);
    weft_image_free(&all);
    weft_image_free(&small);
    weft_canvas_free(&canvas);
}

/* Of an empty picture, up to its edges, whatever was drawn before. */
static void enlarging_keeps_what_is_smooth(void **state)
{
    weft_scene scene = scene_of_cloth();
    weft_canvas canvas = canvas_of(WIDTH, HEIGHT);
    double far = 500 * scene.orbit.distance;
    scene.orbit.distance *= 0.3;
    weft_image before = moving(state, &scene, &whole, &canvas);
    scene.orbit.distance = far;
    weft_image all = moving(state, &scene, &whole, &canvas);
    for (int step = 1; step < 6; step++) {
        weft_image small = moving(state, &scene, &(weft_pace){.exact_ms = 1000, .step = step}, &canvas);
        for (int i = 0; i < 3 * PIXELS; i++) {
            /* The mesh is a pixel in the middle. */
            bool is_beside = i / 3 % WIDTH < WIDTH / 3 || i / 3 % WIDTH > 2 * WIDTH / 3;
            if (is_beside)
                assert_float_equal(small.pixels[i], all.pixels[i], 1e-3);
        }
        weft_image_free(&small);
    }
    weft_image_free(&before);
    weft_image_free(&all);
    weft_canvas_free(&canvas);
}

/* Which pixels the words of a picture cover. */
static void find_words(void **state, const weft_pace *pace, bool covered[WIDE * HEIGHT])
{
    weft_scene scene = scene_of_cloth();
    scene.layout = WEFT_LAYOUT_WIPE;
    scene.pane[1] = WEFT_MODE_COMPRESSED;
    weft_canvas canvas = canvas_of(WIDE, HEIGHT);
    weft_image plain = moving(state, &scene, pace, &canvas);
    scene.labels = true;
    weft_image worded = moving(state, &scene, pace, &canvas);
    for (int i = 0; i < WIDE * HEIGHT; i++)
        covered[i] = memcmp(&plain.pixels[3 * i], &worded.pixels[3 * i], 3 * sizeof(float)) != 0;
    weft_image_free(&plain);
    weft_image_free(&worded);
    weft_canvas_free(&canvas);
}

static void words_stay_sharp(void **state)
{
    static bool all[WIDE * HEIGHT], small[WIDE * HEIGHT];
    find_words(state, &whole, all);
    find_words(state, &half, small);
    int words = 0;
    for (int i = 0; i < WIDE * HEIGHT; i++)
        words += all[i];
    assert_true(words > 500);
    assert_memory_equal(all, small, sizeof all);
}

static void a_narrow_picture_keeps_a_pixel_for_every_pane(void **state)
{
    weft_scene scene = scene_of_cloth();
    scene.layout = WEFT_LAYOUT_PANES;
    scene.pane_count = 3;
    scene.pane[0] = scene.pane[1] = scene.pane[2] = WEFT_MODE_COMPRESSED;
    for (int width = 3; width < 20; width++) {
        weft_canvas canvas = canvas_of(width, 7);
        weft_image image = moving(state, &scene, &(weft_pace){.exact_ms = 1000, .step = 5}, &canvas);
        assert_int_equal(canvas.drawn_width, (int)fmax(3, lround(width / 4.0)));
        weft_image_free(&image);
        weft_canvas_free(&canvas);
    }
}

static weft_image at_rest(void **state, const weft_scene *scene, weft_canvas *canvas)
{
    stage *s = *state;
    weft_error error = {0};
    weft_image image;
    weft_canvas_clear(canvas);
    for (int i = 0; i < 3; i++) {
        weft_canvas_begin_frame(canvas);
        const weft_sampling sampling = {.shift_x = 0.25 * i, .frame = i};
        expect_ok(weft_player_draw(s->player, scene, WIDTH, HEIGHT, sampling, &error), &error);
        weft_canvas_end_frame(canvas);
    }
    expect_ok(weft_canvas_read(canvas, &image, &error), &error);
    return image;
}

static void a_picture_at_rest_keeps_nothing_of_small_frames(void **state)
{
    weft_scene scene = scene_of_cloth();
    weft_canvas canvas = canvas_of(WIDTH, HEIGHT), fresh = canvas_of(WIDTH, HEIGHT);
    weft_image small = moving(state, &scene, &half, &canvas), after = at_rest(state, &scene, &canvas),
               alone = at_rest(state, &scene, &fresh);
    assert_int_equal(canvas.drawn_width, WIDTH);
    assert_memory_equal(after.pixels, alone.pixels, sizeof(float) * 3 * PIXELS);
    weft_image_free(&small);
    weft_image_free(&after);
    weft_image_free(&alone);
    weft_canvas_free(&canvas);
    weft_canvas_free(&fresh);
}

/* ---- Few lights ---- */

/* Reflectance is the same in all directions. */
static void set_matt(weft_player *player)
{
    weft_error error = {0};
    weft_material material;
    expect_ok(weft_material_create(1, 1, 0, 0, 0, true, &material, &error), &error);
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_frame_encode(&frame, material.level[0].frame);
    for (int c = 0; c < 3; c++)
        material.level[0].diffuse[c] = weft_half_of_float(0.5f);
    expect_ok(weft_player_set_material(player, &material, &error), &error);
    weft_material_free(&material);
}

/* Grey, many times as bright on one side as on the other. */
static void set_sky(weft_player *player)
{
    weft_error error = {0};
    weft_image sky;
    expect_ok(weft_image_create(64, 32, &sky, &error), &error);
    for (int i = 0; i < 64 * 32; i++) {
        for (int c = 0; c < 3; c++)
            sky.pixels[3 * i + c] = 0.05f + (float)(i % 64 > 40) * 2 + (float)(i / 64 < 4) * 3;
    }
    expect_ok(weft_player_set_environment(player, &sky, WEFT_ENVIRONMENT_REGIONS, &error), &error);
    weft_image_free(&sky);
}

static weft_image mean_of_moving(void **state, const weft_scene *scene, int frames, weft_canvas *canvas)
{
    weft_image mean = moving(state, scene, &whole, canvas);
    for (int frame = 1; frame < frames; frame++) {
        weft_image image = moving(state, scene, &whole, canvas);
        for (int i = 0; i < 3 * PIXELS; i++)
            mean.pixels[i] += (image.pixels[i] - mean.pixels[i]) / (float)(frame + 1);
        weft_image_free(&image);
    }
    return mean;
}

/* Relative, but that dark pixels count as if they were brighter by 0.1. */
static double largest_difference(const weft_image *a, const weft_image *b)
{
    double largest = 0;
    for (int i = 0; i < 3 * PIXELS; i++)
        largest = fmax(largest, fabs((double)a->pixels[i] - (double)b->pixels[i]) / (0.1 + (double)b->pixels[i]));
    return largest;
}

static void few_lights_have_the_mean_of_all_of_them(void **state)
{
    stage *s = *state;
    weft_scene scene = scene_of_cloth();
    weft_canvas canvas = canvas_of(WIDTH, HEIGHT);
    set_matt(s->player);
    set_sky(s->player);
    scene.environment = true;
    for (int lights = 0; lights < 2; lights++) {
        scene.light_count = lights;
        weft_image all = moving(state, &scene, &(weft_pace){0}, &canvas), few = moving(state, &scene, &whole, &canvas),
                   mean = mean_of_moving(state, &scene, 50, &canvas);
        double one = largest_difference(&few, &all), many = largest_difference(&mean, &all);
        printf("two lights of 48: one frame %.3f off, mean of 50 %.4f\n", one, many);
        assert_true(one > 0.05 && one < 1);
        assert_true(many < 0.05);
        weft_image_free(&all);
        weft_image_free(&few);
        weft_image_free(&mean);
    }
    weft_canvas_free(&canvas);
}

int test_moving(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_small_frame_shows_the_same_at_the_same_places),
        cmocka_unit_test(enlarging_keeps_what_is_smooth),
        cmocka_unit_test(words_stay_sharp),
        cmocka_unit_test(a_narrow_picture_keeps_a_pixel_for_every_pane),
        cmocka_unit_test(a_picture_at_rest_keeps_nothing_of_small_frames),
        cmocka_unit_test(few_lights_have_the_mean_of_all_of_them),
    };
    return cmocka_run_group_tests(tests, open_with_material, stage_close);
}

/* The light that a picture begins in: shadows without acne, no grain in the mean, folds neither black nor white. */
#include "base/numeric/statistics.h"
#include "player/draw/canvas.h"
#include "player/draw/pace.h"
#include "player/scene/surroundings.h"
#include "studio.h"
#include "tests/support/suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* No part of a ball hides another from a light that it faces. */
static void a_ball_casts_no_shadow_on_its_lit_side(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    long lit = 0;
    double darkest = 1;
    studio_show(s->player, "sphere");
    for (int i = 0; i < 24; i++) {
        weft_surface_sample *at;
        weft_scene scene = weft_scene_default();
        scene.shadows = true;
        scene.orbit.distance = 1.5 + 0.3 * i;
        scene.light[0].direction = (weft_angles){weft_rad_of_deg(3.7 * i), weft_rad_of_deg(-160 + 13 * i)};
        expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error),
                  &error);
        for (int k = 0; k < PIXELS; k++) {
            /* At its rim a ball of triangles shows their backs. */
            if (at[k].covered == 0 || at[k].light[2] < 0.03f || at[k].view[2] < 0.05f)
                continue;
            lit++;
            darkest = fmin(darkest, (double)at[k].key_share);
        }
        free(at);
    }
    printf("%ld pixels, the least share of the light is %.4f\n", lit, darkest);
    assert_true(lit > 100000);
    assert_true(darkest > 0.999);
}

/* Pixels that see part of the key light, but neither nearly all nor nearly nothing of it. */
static long partly_shaded(weft_player *player, double key_size_deg)
{
    weft_error error = {0};
    weft_surface_sample *at;
    weft_scene scene = weft_scene_default();
    long count = 0;
    scene.shadows = true;
    scene.key_size_rad = weft_rad_of_deg(key_size_deg);
    expect_ok(weft_player_read_surface(player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error), &error);
    for (int k = 0; k < PIXELS; k++)
        count += at[k].covered > 0 && at[k].key_share > 0.2f && at[k].key_share < 0.8f;
    free(at);
    return count;
}

static void a_large_key_light_has_a_penumbra_in_the_first_frame(void **state)
{
    stage *s = *state;
    studio_show(s->player, "drape");
    long small = partly_shaded(s->player, 0), large = partly_shaded(s->player, 9);
    printf("%ld pixels are partly shaded from a key light of 9 degrees, %ld from one without size\n", large, small);
    assert_true(large > 3 * small);
}

static float largest_step(const weft_image *image, const weft_surface_sample *at, float quantile, float *value)
{
    size_t count = 0;
    for (int k = 0; k < PIXELS - 1; k++) {
        if (at[k].covered > 0 && at[k + 1].covered > 0)
            value[count++] = fabsf(image->pixels[3 * k] - image->pixels[3 * k + 3]);
    }
    return weft_quantile_of_floats(value, count, quantile);
}

/* What shadows change from a pixel to the next, where the ball is lit and not seen from the rim. */
static float largest_added_step(const weft_image image[2], const weft_surface_sample *at)
{
    float largest = 0;
    for (int k = 0; k < PIXELS - 1; k++) {
        bool inside = at[k].covered > 0 && at[k + 1].covered > 0 && fminf(at[k].view[2], at[k + 1].view[2]) > 0.05f;
        float before = image[0].pixels[3 * k] - image[0].pixels[3 * k + 3];
        float after = image[1].pixels[3 * k] - image[1].pixels[3 * k + 3];
        largest = inside ? fmaxf(largest, fabsf(after - before)) : largest;
    }
    return largest;
}

/* Shadows of triangles on the cloth that they make up would be its strongest edges. */
static void smooth_cloth_has_no_stronger_edge_with_shadows_than_without(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    float *value = malloc(PIXELS * sizeof *value);
    studio_show(s->player, "sphere");
    for (int i = 0; i < 8; i++) {
        weft_image image[2];
        weft_surface_sample *at;
        weft_scene scene = weft_scene_default();
        scene.light[0].direction = (weft_angles){weft_rad_of_deg(11 * i), weft_rad_of_deg(-70 + 40 * i)};
        expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error),
                  &error);
        for (int k = 0; k < 2; k++) {
            scene.shadows = k;
            expect_ok(weft_player_picture(s->player, &scene, WIDTH, HEIGHT, 1, NULL, &image[k], &error), &error);
        }
        float added = largest_added_step(image, at), usual = largest_step(&image[0], at, 0.99f, value);
        print_message("light %d: shadows add a step of %.5f, 99th percentile of steps %.5f\n", i, (double)added,
                      (double)usual);
        assert_true(added < usual);
        free(at);
        weft_image_free(&image[0]);
        weft_image_free(&image[1]);
    }
    free(value);
}

/* The mean of the squares of what a picture lacks, of blocks of so many pixels in the mean. */
static double lack(const weft_image *image, const weft_image *whole, int across, int up)
{
    double sum = 0;
    for (int y = 0; y + up <= HEIGHT; y += up) {
        for (int x = 0; x + across <= WIDTH; x += across) {
            double block = 0;
            for (int k = 0; k < across * up; k++) {
                int at = 3 * ((y + k / across) * WIDTH + x + k % across);
                block += (double)(image->pixels[at] - whole->pixels[at]) / (across * up);
            }
            sum += block * block * across * up / PIXELS;
        }
    }
    return sum;
}

/* What a frame lacks is grain, which is gone where eight pixels are looked at together: the whole picture leans little.
 */
static void neighbouring_pixels_are_lit_from_other_places(void **state)
{
    stage *s = *state;
    studio_show(s->player, "drape");
    weft_scene scene = studio_scene(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    scene.shadows = scene.ground = false;
    scene.light_count = 0;
    weft_image one = studio_picture(s->player, &scene);
    scene.environment_reference = true;
    weft_image all = studio_picture(s->player, &scene);
    double grain = lack(&one, &all, 1, 1), rest = lack(&one, &all, 4, 2);
    printf("a frame lacks %.2e, of which %.2e remain in blocks of eight pixels\n", grain, rest);
    assert_true(rest < 0.1 * grain);
    weft_image_free(&one);
    weft_image_free(&all);
}

static weft_image frame_of(weft_player *player, const weft_scene *scene, weft_sampling sampling)
{
    weft_error error = {0};
    weft_canvas canvas;
    weft_image image;
    expect_ok(weft_canvas_create(WIDTH, HEIGHT, &canvas, &error), &error);
    weft_canvas_begin_frame(&canvas);
    expect_ok(weft_player_draw(player, scene, WIDTH, HEIGHT, sampling, &error), &error);
    weft_canvas_end_frame(&canvas);
    expect_ok(weft_canvas_read(&canvas, &image, &error), &error);
    weft_canvas_free(&canvas);
    return image;
}

/* Green of 255 that the darkest hundredth of the pixels shows whose middle and whose neighbours lie on cloth. */
static double dark_on_screen(weft_player *player, const weft_scene *scene, weft_image *image)
{
    weft_error error = {0};
    weft_surface_sample *at;
    float dark[PIXELS];
    size_t count = 0;
    expect_ok(weft_player_read_surface(player, scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error), &error);
    weft_scene_show(scene, image);
    for (int k = WIDTH; k < PIXELS - WIDTH; k++) {
        bool is_inside = at[k].covered > 0 && at[k - 1].covered > 0 && at[k + 1].covered > 0 &&
                         at[k - WIDTH].covered > 0 && at[k + WIDTH].covered > 0;
        if (is_inside)
            dark[count++] = image->pixels[3 * k + 1];
    }
    free(at);
    weft_image_free(image);
    return 255 * (double)weft_quantile_of_floats(dark, count, 0.01);
}

/* Before the means of many frames: few directions of the environment cast shadows, and a fold may see none of them. */
static void folds_are_not_black_in_the_frames_that_stand_alone(void **state)
{
    stage *s = *state;
    studio_show(s->player, "drape");
    weft_scene scene = studio_scene(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    scene.light_count = 0;
    weft_image moving = frame_of(s->player, &scene, (weft_sampling){.frame = -1, .interactive = true}),
               first = frame_of(s->player, &scene, weft_sampling_converging(0)),
               whole = studio_picture(s->player, &scene);
    double of_moving = dark_on_screen(s->player, &scene, &moving), of_first = dark_on_screen(s->player, &scene, &first),
           of_whole = dark_on_screen(s->player, &scene, &whole);
    print_message("the darkest hundredth: %.0f moving, %.0f of the first frame, %.0f of the whole picture\n", of_moving,
                  of_first, of_whole);
    assert_true(of_moving > 12 && of_first > 12);
}

/* On the screen, of 255: deep in a fold, facing away from every lamp. */
static void unlit_folds_are_not_black_and_lit_ones_not_white(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_surface_sample *at;
    for (int i = 0; i < (suite_argument ? 3 : 1); i++) {
        studio_show(s->player, "drape");
        weft_scene scene = studio_scene(s->player, weft_surroundings_names[i], WEFT_ENVIRONMENT_SMOOTH_REGIONS);
        scene.tone = WEFT_TONE_SOFT;
        weft_image image = studio_picture(s->player, &scene);
        expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error),
                  &error);
        weft_scene_show(&scene, &image);
        float darkest = 1, brightest = 0;
        for (int k = 0; k < PIXELS; k++) {
            for (int c = 0; at[k].covered > 0 && c < 3; c++) {
                darkest = fminf(darkest, image.pixels[3 * k + c]);
                brightest = fmaxf(brightest, image.pixels[3 * k + c]);
            }
        }
        print_message("%s: from %.0f to %.0f of 255\n", weft_surroundings_names[i], 255 * (double)darkest,
                      255 * (double)brightest);
        assert_true(darkest > 12.0f / 255 && brightest < 250.0f / 255);
        free(at);
        weft_image_free(&image);
    }
}

int test_studio(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_casts_no_shadow_on_its_lit_side),
        cmocka_unit_test(a_large_key_light_has_a_penumbra_in_the_first_frame),
        cmocka_unit_test(smooth_cloth_has_no_stronger_edge_with_shadows_than_without),
        cmocka_unit_test(neighbouring_pixels_are_lit_from_other_places),
        cmocka_unit_test(folds_are_not_black_in_the_frames_that_stand_alone),
        cmocka_unit_test(unlit_folds_are_not_black_and_lit_ones_not_white),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}

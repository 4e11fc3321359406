/* A picture at rest has no hatch. Neighbouring pixels are lit from other places; what they lack after half a second
 * must not repeat every few pixels. Measured as waves of two to four pixels in what the picture lacks of a much longer
 * mean, which has seen everything. */
#include "player/draw/pace.h"
#include "player/scene/environment.h"
#include "player/scene/surroundings.h"
#include "stage.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 240, HEIGHT = 160, PIXELS = WIDTH * HEIGHT, FRAMES = 16 };

/* Sides of a block of pixels, and of the largest pattern that repeats in it. */
enum { BLOCK = 16, PERIOD = 4, WAVES = PERIOD * PERIOD };

/* Shining cloth of one smooth texel on a drape: what changes from a pixel to the next is shading. */
static void show_smooth_cloth(weft_player *player, float exponent)
{
    weft_error error = {0};
    weft_material material;
    expect_ok(weft_material_create(1, 1, 1, 0, 0, true, &material, &error), &error);
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_frame_encode(&frame, material.level[0].frame);
    for (int c = 0; c < 3; c++) {
        const float lobe[4] = {-1, -1, 1, exponent};
        material.level[0].diffuse[c] = weft_half_of_float(0.1f);
        for (int k = 0; k < 4; k++)
            material.level[0].lobe[4 * c + k] = weft_half_of_float(lobe[k]);
    }
    material.texel_pitch_mm = 1;
    expect_ok(weft_player_set_material(player, &material, &error), &error);
    weft_material_free(&material);
}

static weft_scene scene_of(weft_player *player, const char *name)
{
    weft_error error = {0};
    weft_image map;
    weft_scene scene = weft_scene_default();
    expect_ok(weft_surroundings_map(name, &map, &error), &error);
    expect_ok(weft_player_set_environment(player, &map, WEFT_ENVIRONMENT_SMOOTH_REGIONS, &error), &error);
    weft_image_free(&map);
    weft_surroundings_light(name, &scene);
    scene.pane[0] = WEFT_MODE_COMPRESSED;
    scene.shadows = scene.ground = true;
    return scene;
}

/* As a window shows it after so many frames. */
static weft_image at_rest(weft_player *player, const weft_scene *scene, int frames)
{
    weft_error error = {0};
    weft_canvas canvas;
    weft_image image;
    expect_ok(weft_canvas_create(WIDTH, HEIGHT, &canvas, &error), &error);
    for (int i = 0; i < frames; i++) {
        weft_canvas_begin_frame(&canvas);
        expect_ok(weft_player_draw(player, scene, WIDTH, HEIGHT, weft_sampling_converging(i), &error), &error);
        weft_canvas_end_frame(&canvas);
    }
    expect_ok(weft_canvas_read(&canvas, &image, &error), &error);
    weft_canvas_free(&canvas);
    weft_scene_show(scene, &image);
    return image;
}

/* How much of a wave of `across` and `up` turns in PERIOD pixels a block has: the square of its amplitude. */
static double wave_in_block(const float *value, int across, int up)
{
    double real = 0, imaginary = 0;
    for (int y = 0; y < BLOCK; y++) {
        for (int x = 0; x < BLOCK; x++) {
            double turn = 2 * WEFT_PI * (across * x + up * y) / PERIOD;
            real += (double)value[y * WIDTH + x] * cos(turn) / (BLOCK * BLOCK);
            imaginary += (double)value[y * WIDTH + x] * sin(turn) / (BLOCK * BLOCK);
        }
    }
    return real * real + imaginary * imaginary;
}

static bool is_all(const bool *part)
{
    for (int i = 0; i < BLOCK * BLOCK; i++) {
        if (!part[i / BLOCK * WIDTH + i % BLOCK])
            return false;
    }
    return true;
}

/* The root of the mean over the blocks of a part of the picture, of the wave that they have most of. */
static double hatch_of(const float *value, const bool *part)
{
    double sum[WAVES] = {0}, most = 0;
    int blocks = 0;
    for (int y = 0; y + BLOCK <= HEIGHT; y += BLOCK) {
        for (int x = 0; x + BLOCK <= WIDTH; x += BLOCK) {
            int at = y * WIDTH + x;
            if (!is_all(part + at))
                continue;
            blocks++;
            for (int wave = 1; wave < WAVES; wave++)
                sum[wave] += wave_in_block(value + at, wave % PERIOD, wave / PERIOD);
        }
    }
    assert_true(blocks > 20);
    for (int wave = 1; wave < WAVES; wave++)
        most = fmax(most, sum[wave] / blocks);
    return sqrt(most);
}

/* Levels of 255 of the screen. */
static void find_lack(const weft_image *few, const weft_image *many, float *lack)
{
    for (int i = 0; i < PIXELS; i++)
        lack[i] = 255 * (few->pixels[3 * i + 1] - many->pixels[3 * i + 1]);
}

/* Where soft shadows lie, away from their silhouettes: on the ground, or on the cloth. */
static void find_part(weft_player *player, const weft_scene *scene, bool on_cloth, bool *part)
{
    weft_error error = {0};
    weft_surface_sample *at;
    expect_ok(weft_player_read_surface(player, scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error), &error);
    for (int i = 0; i < PIXELS; i++) {
        part[i] = true;
        for (int k = 0; k < 9; k++) {
            int x = i % WIDTH + k % 3 - 1, y = i / WIDTH + k / 3 - 1;
            bool inside = x >= 0 && x < WIDTH && y >= 0 && y < HEIGHT;
            part[i] = part[i] && inside && (at[inside ? y * WIDTH + x : 0].covered > 0) == on_cloth;
        }
    }
    free(at);
}

/* A level of the screen is not seen; a fifth of one is what noise has. Without the exchange of kinds from block to
 * block the cloth has 0.4; where neighbours see other shadows the ground has 0.5 and more. */
static void a_picture_at_rest_has_no_hatch(void **state)
{
    static const char *const names[] = {"studio", "overcast"};
    stage *s = *state;
    float *lack = malloc(PIXELS * sizeof *lack);
    bool *part = malloc(PIXELS * sizeof *part);
    show_smooth_cloth(s->player, 40);
    for (int i = 0; i < (suite_argument ? 2 : 1); i++) {
        weft_scene scene = scene_of(s->player, names[i]);
        weft_image few = at_rest(s->player, &scene, FRAMES), all = at_rest(s->player, &scene, 4 * FRAMES);
        find_lack(&few, &all, lack);
        for (int on_cloth = 0; on_cloth < 2; on_cloth++) {
            find_part(s->player, &scene, on_cloth, part);
            double hatch = hatch_of(lack, part);
            printf("%s, %s: a hatch of %.3f levels of 255\n", names[i], on_cloth ? "cloth" : "ground", hatch);
            assert_true(hatch < 0.2);
        }
        weft_image_free(&few);
        weft_image_free(&all);
    }
    free(lack);
    free(part);
}

/* Of four pixels, what those on one diagonal have more than those on the other: root mean square. An edge has little.
 */
static double grain_of(const float *lack, const bool *part)
{
    double sum = 0;
    long count = 0;
    for (int i = 0; i < PIXELS - WIDTH - 1; i++) {
        double more = (double)(lack[i] - lack[i + 1] - lack[i + WIDTH] + lack[i + WIDTH + 1]) / 4;
        sum += part[i] ? more * more : 0;
        count += part[i];
    }
    return sqrt(sum / (double)count);
}

static weft_image picture_of(weft_player *player, weft_scene scene, bool is_reference)
{
    weft_error error = {0};
    weft_image image;
    scene.environment_reference = is_reference;
    scene.shadows = scene.ground = false;
    scene.light_count = 0;
    expect_ok(weft_player_picture(player, &scene, WIDTH, HEIGHT, 6, NULL, &image, &error), &error);
    weft_scene_show(&scene, &image);
    return image;
}

/* It has time. A grain of 0.08 levels of 255, and three times as much where its neighbouring pixels are lit from other
 * places. */
static void a_picture_that_is_saved_is_smooth(void **state)
{
    stage *s = *state;
    float *lack = malloc(PIXELS * sizeof *lack);
    bool *part = malloc(PIXELS * sizeof *part);
    show_smooth_cloth(s->player, 40);
    weft_scene scene = scene_of(s->player, "studio");
    weft_image saved = picture_of(s->player, scene, false), all = picture_of(s->player, scene, true);
    find_lack(&saved, &all, lack);
    find_part(s->player, &scene, true, part);
    double grain = grain_of(lack, part);
    printf("a grain of %.3f levels of 255\n", grain);
    assert_true(grain < 0.15);
    weft_image_free(&saved);
    weft_image_free(&all);
    free(lack);
    free(part);
}

int test_hatch(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_at_rest_has_no_hatch),
        cmocka_unit_test(a_picture_that_is_saved_is_smooth),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}

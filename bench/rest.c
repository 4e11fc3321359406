/* What a picture that has just come to rest lacks, part by part: 365 x 200 in the studio, the frames that a window
 * draws at rest, against many. FLIP and RMSE of what the screen shows, and processor time of a frame. 0 frames: one
 * that moves. Usage: bench_rest NAME.weft|CLOTH.wv [FRAMES...] */
#include "bench/measure.h"
#include "compare/pictures/picture_quality.h"
#include "player/draw/pace.h"
#include "player/gl/context.h"
#include "player/scene/environment.h"
#include "player/scene/surroundings.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 365, HEIGHT = 200, MANY = 4 * WEFT_ENVIRONMENT_STRATA, REGIONS = 3, MOST_COUNTS = 8 };

static void stop_on(weft_code code, const weft_error *error)
{
    bench_stop_on("bench_rest", code, error);
}

/* How many frames are looked at. */
typedef struct frame_counts {
    int count, frames[MOST_COUNTS];
} frame_counts;

/* As the screen shows the mean of so many frames. *ms receives the processor time of one. */
static weft_image shown(weft_player *player, const weft_scene *scene, weft_canvas *canvas, int frames, double *ms)
{
    weft_error error = {0};
    weft_image image;
    double start = bench_now_ms(CLOCK_PROCESS_CPUTIME_ID);
    weft_canvas_clear(canvas);
    for (int i = 0; i < (frames > 0 ? frames : 1); i++) {
        weft_sampling moving = {.frame = -1, .interactive = true};
        weft_canvas_begin_frame(canvas);
        stop_on(
            weft_player_draw(player, scene, WIDTH, HEIGHT, frames > 0 ? weft_sampling_converging(i) : moving, &error),
            &error);
        weft_canvas_end_frame(canvas);
    }
    stop_on(weft_canvas_read(canvas, &image, &error), &error);
    *ms = (bench_now_ms(CLOCK_PROCESS_CPUTIME_ID) - start) / (frames > 0 ? frames : 1);
    weft_scene_show(scene, &image);
    return image;
}

/* Bit 0 of all pixels, 1 of those on cloth, 2 of those beside it. */
static void find_regions(weft_player *player, const weft_scene *scene, uint8_t *regions)
{
    weft_error error = {0};
    weft_surface_sample *at;
    stop_on(weft_player_read_surface(player, scene, scene->pane[0], WIDTH, HEIGHT, &at, &error), &error);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        regions[i] = at[i].covered > 0 ? 3 : 5;
    free(at);
}

static double levels(const weft_picture_quality *quality)
{
    return 255 * pow(10, -quality->psnr_db / 20);
}

static void print_lack(const char *what, int frames, const weft_image *few, double ms, const weft_image *many,
                       const uint8_t *regions)
{
    weft_error error = {0};
    weft_picture_quality q[REGIONS];
    long pixels[REGIONS];
    stop_on(weft_picture_quality_by_region(many, few, regions, REGIONS, q, pixels, &error), &error);
    printf("%-32s %3d frames: RMSE of 255 levels %.2f (cloth %.2f, beside it %.2f), FLIP %.4f (cloth %.4f, beside it "
           "%.4f), %.1f ms of processor a frame\n",
           what, frames, levels(&q[0]), levels(&q[1]), levels(&q[2]), q[0].flip, q[1].flip, q[2].flip, ms);
    fflush(stdout);
}

/* The last that moved was the camera; or, where `is_new`, the lights. */
static void move(weft_player *player, const weft_scene *scene, bool is_new, weft_canvas *canvas)
{
    weft_error error = {0};
    weft_scene moved = *scene;
    moved.orbit.azimuth_rad += 0.01;
    moved.light[0].direction.phi_rad += is_new ? 0.01 : 0;
    moved.environment_turn_rad += is_new ? 0.01 : 0;
    weft_canvas_clear(canvas);
    weft_canvas_begin_frame(canvas);
    stop_on(weft_player_draw(player, &moved, WIDTH, HEIGHT, (weft_sampling){.frame = -1, .interactive = true}, &error),
            &error);
    weft_canvas_end_frame(canvas);
}

static void judge(weft_player *player, const weft_scene *scene, const char *what, bool is_new,
                  const frame_counts *counts, weft_canvas *canvas)
{
    static uint8_t regions[WIDTH * HEIGHT];
    double ms;
    weft_image many = shown(player, scene, canvas, MANY, &ms);
    find_regions(player, scene, regions);
    for (int i = 0; i < counts->count; i++) {
        move(player, scene, is_new, canvas);
        weft_image few = shown(player, scene, canvas, counts->frames[i], &ms);
        print_lack(what, counts->frames[i], &few, ms, &many, regions);
        weft_image_free(&few);
    }
    weft_image_free(&many);
}

static bool is_material(const char *path)
{
    size_t length = strlen(path);
    return length > 5 && strcmp(path + length - 5, ".weft") == 0;
}

static weft_mode load(weft_player *player, const char *path)
{
    weft_error error = {0};
    weft_mesh mesh;
    stop_on(weft_mesh_drape(&mesh, &error), &error);
    stop_on(weft_player_set_mesh(player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
    if (is_material(path)) {
        weft_material material;
        stop_on(weft_material_read(path, &material, &error), &error);
        stop_on(weft_player_set_material(player, &material, &error), &error);
        weft_material_free(&material);
        return WEFT_MODE_COMPRESSED;
    }
    weft_weave weave;
    char warning[WEFT_MESSAGE_SIZE];
    stop_on(weft_weave_read(path, NULL, 0, &weave, warning, &error), &error);
    stop_on(weft_player_set_weave(player, &weave, &(weft_weave_layout){.tiles_u = 4, .tiles_v = 4}, &error), &error);
    weft_weave_free(&weave);
    return WEFT_MODE_ANALYTIC;
}

static weft_scene studio(weft_player *player, weft_mode mode)
{
    weft_error error = {0};
    weft_image map;
    weft_scene scene = weft_scene_default();
    stop_on(weft_surroundings_map("studio", &map, &error), &error);
    stop_on(weft_player_set_environment(player, &map, WEFT_ENVIRONMENT_SMOOTH_REGIONS, &error), &error);
    weft_image_free(&map);
    weft_surroundings_light("studio", &scene);
    scene.pane[0] = mode;
    scene.repeat = mode == WEFT_MODE_ANALYTIC ? 100 : 8;
    scene.shadows = scene.ground = true;
    return scene;
}

static void judge_all(weft_player *player, weft_scene scene, const frame_counts *counts, weft_canvas *canvas)
{
    weft_scene part = scene;
    judge(player, &part, "studio", false, counts, canvas);
    judge(player, &part, "studio, the lights moved last", true, counts, canvas);
    part.ground = false;
    judge(player, &part, "without the ground", false, counts, canvas);
    part = scene;
    part.key_size_rad = 0;
    judge(player, &part, "key light without size", false, counts, canvas);
    part = scene;
    part.shadows = false;
    judge(player, &part, "without shadows", false, counts, canvas);
    part.environment = false;
    judge(player, &part, "without shadows and environment", false, counts, canvas);
    part.shadows = true;
    judge(player, &part, "without the environment", false, counts, canvas);
}

static bool read_counts(int argc, char **argv, frame_counts *counts)
{
    *counts = (frame_counts){.count = 4, .frames = {1, 4, 6, 16}};
    if (argc > MOST_COUNTS)
        return false;
    if (argc > 0)
        counts->count = argc;
    for (int i = 0; i < argc; i++) {
        counts->frames[i] = atoi(argv[i]);
        if (counts->frames[i] < 0)
            return false;
    }
    return true;
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    weft_headless *headless;
    weft_player *player;
    weft_canvas canvas;
    frame_counts counts;
    if (argc < 2 || !read_counts(argc - 2, argv + 2, &counts)) {
        fprintf(stderr, "Usage: bench_rest NAME.weft|CLOTH.wv [FRAMES...]\n");
        return 2;
    }
    stop_on(weft_headless_create(WEFT_GL_CORE, &headless, &error), &error);
    stop_on(weft_player_create(&player, &error), &error);
    stop_on(weft_canvas_create(WIDTH, HEIGHT, &canvas, &error), &error);
    judge_all(player, studio(player, load(player, argv[1])), &counts, &canvas);
    weft_canvas_free(&canvas);
    weft_player_free(player);
    weft_headless_free(headless);
    return 0;
}

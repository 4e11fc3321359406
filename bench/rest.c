/* What a picture that has just come to rest lacks, part by part: 365 x 200 in the studio, the frames that a window
 * draws at rest, against many. FLIP and RMSE of what the screen shows, and processor time of a frame. Usage: bench_rest
 * NAME.weft|CLOTH.wv [FRAMES] */
#include "bench/measure.h"
#include "player/draw/resting.h"
#include "player/gl/context.h"
#include "player/scene/environment.h"
#include "player/scene/surroundings.h"
#include "study/error/picture_quality.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 365, HEIGHT = 200, MANY = WEFT_ENVIRONMENT_PARTS, REGIONS = 3 };

static void stop_on(weft_code code, const weft_error *error)
{
    bench_stop_on("bench_rest", code, error);
}

/* As the screen shows the mean of so many frames. *ms receives the processor time of one. */
static weft_image shown(weft_player *player, const weft_scene *scene, weft_canvas *canvas, int frames, double *ms)
{
    weft_error error = {0};
    weft_image image;
    double start = bench_now_ms(CLOCK_PROCESS_CPUTIME_ID);
    weft_canvas_clear(canvas);
    for (int i = 0; i < frames; i++) {
        weft_canvas_begin_frame(canvas);
        stop_on(weft_player_draw(player, scene, WIDTH, HEIGHT, weft_sampling_at_rest(i), &error), &error);
        weft_canvas_end_frame(canvas);
    }
    stop_on(weft_canvas_read(canvas, &image, &error), &error);
    *ms = (bench_now_ms(CLOCK_PROCESS_CPUTIME_ID) - start) / frames;
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

static void judge(weft_player *player, const weft_scene *scene, const char *what, int frames, weft_canvas *canvas)
{
    static uint8_t regions[WIDTH * HEIGHT];
    weft_error error = {0};
    weft_picture_quality q[REGIONS];
    long pixels[REGIONS];
    double ms, many_ms;
    weft_image few = shown(player, scene, canvas, frames, &ms);
    weft_image many = shown(player, scene, canvas, MANY, &many_ms);
    find_regions(player, scene, regions);
    stop_on(weft_picture_quality_by_region(&many, &few, regions, REGIONS, q, pixels, &error), &error);
    printf("%-32s %3d frames: RMSE of 255 levels %.2f, FLIP %.4f (cloth %.4f, beside it %.4f), %.1f ms of processor a "
           "frame (%.1f)\n",
           what, frames, 255 * pow(10, -q[0].psnr_db / 20), q[0].flip, q[1].flip, q[2].flip, ms, many_ms);
    fflush(stdout);
    weft_image_free(&few);
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

static void judge_all(weft_player *player, weft_scene scene, int frames, weft_canvas *canvas)
{
    weft_scene part = scene;
    judge(player, &part, "studio", frames, canvas);
    part.ground = false;
    judge(player, &part, "without the ground", frames, canvas);
    part = scene;
    part.key_size_rad = 0;
    judge(player, &part, "key light without size", frames, canvas);
    part = scene;
    part.shadows = false;
    judge(player, &part, "without shadows", frames, canvas);
    part.environment = false;
    judge(player, &part, "without shadows and environment", frames, canvas);
    part.shadows = true;
    judge(player, &part, "without the environment", frames, canvas);
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    weft_headless *headless;
    weft_player *player;
    weft_canvas canvas;
    int frames = argc > 2 ? atoi(argv[2]) : 16;
    if (argc < 2 || frames < 1) {
        fprintf(stderr, "Usage: bench_rest NAME.weft|CLOTH.wv [FRAMES]\n");
        return 2;
    }
    stop_on(weft_headless_create(WEFT_GL_CORE, &headless, &error), &error);
    stop_on(weft_player_create(&player, &error), &error);
    stop_on(weft_canvas_create(WIDTH, HEIGHT, &canvas, &error), &error);
    judge_all(player, studio(player, load(player, argv[1])), frames, &canvas);
    weft_canvas_free(&canvas);
    weft_player_free(player);
    weft_headless_free(headless);
    return 0;
}

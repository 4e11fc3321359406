/* Frame times of the player, each mode at 730 x 400 or another size, from the scene to what a window would show: median
 * of FRAMES frames by the wall and by the GPU's own timestamps, and the mean processor time. "moving": the frames that
 * the window draws while things move, with as many pixels as it has time for, and with all of them. Usage: bench_player
 * [--size WxH] [NAME.weft] [NAME.btf.h5] [CLOTH.wv TILES] [MAP.exr] */
#include "base/numeric/statistics.h"
#include "bench/fetches.h"
#include "bench/measure.h"
#include "compare/pictures/picture_quality.h"
#include "player/draw/pace.h"
#include "player/gl/context.h"
#include "player/scene/environment.h"
#include "player/scene/surroundings.h"
#include "reflectance/lafortune/lafortune.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 41, WARM_UP = 15 };

static int width = 730, height = 400;

static void stop_on(weft_code code, const weft_error *error)
{
    bench_stop_on("bench_player", code, error);
}

/* What stands for the window. */
static void create_screen(GLuint *buffer, GLuint *texture)
{
    weft_error error = {0};
    const weft_texture_format format = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    stop_on(weft_gl_texture(format, width, height, 0, NULL, texture, &error), &error);
    glGenFramebuffers(1, buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, *buffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *texture, 0);
}

static void draw(weft_player *player, const weft_scene *scene, const weft_pace *pace, weft_canvas *canvas,
                 GLuint screen)
{
    weft_error error = {0};
    stop_on(weft_player_draw_interactive(player, scene, pace, canvas, &error), &error);
    glBindFramebuffer(GL_FRAMEBUFFER, screen);
    weft_canvas_present(canvas, scene, 0);
}

/* Everything is evaluated, or what is while things move. */
static const weft_pace calm = {0}, interactive = {.exact_ms = 1000};

/* The camera turns a little between frames, so that no driver can reuse one. */
static void time_frames(weft_player *player, weft_scene scene, const char *what, weft_pace pace, bool adapts,
                        weft_canvas *canvas)
{
    double wall[FRAMES], gpu[FRAMES], cpu_ms = 0;
    GLuint query[2], screen, screen_texture;
    glGenQueries(2, query);
    create_screen(&screen, &screen_texture);
    for (int frame = -WARM_UP; frame < FRAMES; frame++) {
        GLuint64 begin, end;
        scene.orbit.azimuth_rad += 0.01;
        double start = bench_now_ms(CLOCK_MONOTONIC), cpu_start = bench_now_ms(CLOCK_PROCESS_CPUTIME_ID);
        glQueryCounter(query[0], GL_TIMESTAMP);
        draw(player, &scene, &pace, canvas, screen);
        glQueryCounter(query[1], GL_TIMESTAMP);
        glFinish();
        glGetQueryObjectui64v(query[0], GL_QUERY_RESULT, &begin);
        glGetQueryObjectui64v(query[1], GL_QUERY_RESULT, &end);
        if (frame >= 0) {
            wall[frame] = bench_now_ms(CLOCK_MONOTONIC) - start;
            cpu_ms += (bench_now_ms(CLOCK_PROCESS_CPUTIME_ID) - cpu_start) / FRAMES;
            gpu[frame] = 1e-6 * (double)(end - begin);
        }
        if (adapts)
            weft_pace_note(&pace, weft_pace_is_interactive(&pace), bench_now_ms(CLOCK_MONOTONIC) - start, 0);
    }
    glDeleteQueries(2, query);
    glDeleteFramebuffers(1, &screen);
    glDeleteTextures(1, &screen_texture);
    double wall_ms = weft_quantile(wall, FRAMES, 0.5);
    printf("%-36s %8.2f ms wall %8.2f ms timestamps %8.2f ms processor %7.1f frames/s", what, wall_ms,
           weft_quantile(gpu, FRAMES, 0.5), cpu_ms, 1000 / wall_ms);
    printf(adapts ? ", %d x %d\n" : "\n", canvas->drawn_width, canvas->drawn_height);
}

static void time_scene(weft_player *player, weft_scene scene, const char *what, weft_canvas *canvas)
{
    time_frames(player, scene, what, scene.filter == WEFT_FILTER_STOCHASTIC ? interactive : calm, false, canvas);
}

static void time_moving(weft_player *player, weft_scene scene, const char *what, weft_canvas *canvas)
{
    char text[80];
    scene.filter = WEFT_FILTER_AUTO;
    snprintf(text, sizeof text, "%s, moving, all pixels", what);
    time_frames(player, scene, text, interactive, false, canvas);
    snprintf(text, sizeof text, "%s, moving", what);
    time_frames(player, scene, text, interactive, true, canvas);
}

/* What a frame costs that shows nothing. */
static void time_far_away(weft_player *player, weft_canvas *canvas)
{
    weft_scene scene = weft_scene_default();
    scene.orbit.distance = 500;
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        if (weft_player_has(player, (weft_mode)mode))
            scene.pane[0] = (weft_mode)mode;
    }
    time_scene(player, scene, "an empty frame", canvas);
}

static weft_image picture(weft_player *player, const weft_scene *scene, long frame, int samples, weft_canvas *canvas)
{
    weft_error error = {0};
    weft_image image;
    weft_canvas_clear(canvas);
    for (int i = 0; i < samples; i++) {
        const weft_sampling sampling = {.frame = frame < 0 ? frame : frame + i};
        weft_canvas_begin_frame(canvas);
        stop_on(weft_player_draw(player, scene, width, height, sampling, &error), &error);
        weft_canvas_end_frame(canvas);
    }
    stop_on(weft_canvas_read(canvas, &image, &error), &error);
    weft_canvas_clear(canvas);
    return image;
}

/* What so many frames of a resting picture lack against a reference. */
static void judge_frames(weft_player *player, const weft_scene *scene, const weft_image *reference,
                         const weft_image *background, weft_canvas *canvas)
{
    static const int frames[] = {1, 4, 8, 16, 32, 64};
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        weft_image image = picture(player, scene, 0, frames[i], canvas);
        printf(" %d %.2f %%", frames[i], 100 * bench_relative_rmse(&image, reference, background));
        weft_image_free(&image);
    }
    printf("\n");
}

/* What a moving and a resting picture lack against all lights of the map, every neighbour evaluated. */
static void judge_environment(weft_player *player, weft_scene scene, weft_canvas *canvas)
{
    weft_scene away = scene;
    away.orbit.distance = 500;
    weft_image background = picture(player, &away, 0, 1, canvas);
    scene.filter = WEFT_FILTER_EXACT;
    weft_image reference = picture(player, &scene, 0, WEFT_ENVIRONMENT_STRATA, canvas);
    weft_image exact = picture(player, &scene, -1, 1, canvas);
    scene.filter = WEFT_FILTER_STOCHASTIC;
    weft_image moving = picture(player, &scene, -1, 1, canvas);
    printf("    against all lights: moving, exact %.2f %%, stochastic %.2f %%; resting, by frames:",
           100 * bench_relative_rmse(&exact, &reference, &background),
           100 * bench_relative_rmse(&moving, &reference, &background));
    judge_frames(player, &scene, &reference, &background, canvas);
    weft_image_free(&background);
    weft_image_free(&reference);
    weft_image_free(&exact);
    weft_image_free(&moving);
}

static weft_image shown(const weft_scene *scene, const weft_image *picture)
{
    weft_error error = {0};
    weft_image image;
    stop_on(weft_image_create(width, height, &image, &error), &error);
    memcpy(image.pixels, picture->pixels, 3 * sizeof(float) * (size_t)width * (size_t)height);
    weft_scene_show(scene, &image);
    return image;
}

/* The same of what the screen shows, and of the reference as a file of 8 bits holds it. */
static void judge_shown_frames(weft_player *player, const weft_scene *scene, const weft_image *reference,
                               weft_canvas *canvas)
{
    static const int frames[] = {0, 4, 8, 16, 32};
    weft_image screen = shown(scene, reference);
    printf("    as shown, RMSE of 255 levels and FLIP:");
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        weft_error error = {0};
        weft_picture_quality quality;
        weft_image image = frames[i] > 0 ? picture(player, scene, 0, frames[i], canvas) : shown(scene, reference);
        if (frames[i] > 0)
            weft_scene_show(scene, &image);
        for (int k = 0; frames[i] == 0 && k < 3 * width * height; k++)
            image.pixels[k] = roundf(255 * image.pixels[k]) / 255;
        stop_on(weft_picture_quality_measure(&screen, &image, &quality, &error), &error);
        printf(frames[i] > 0 ? " %d" : " rounded", frames[i]);
        printf(" %.2f %.4f", 255 * pow(10, -quality.psnr_db / 20), quality.flip);
        weft_image_free(&image);
    }
    printf("\n");
    weft_image_free(&screen);
}

/* What the first frames of a resting picture lack against many. */
static void judge_rest(weft_player *player, weft_scene scene, weft_canvas *canvas)
{
    enum { MANY = 4 * WEFT_ENVIRONMENT_STRATA };
    weft_scene away = scene;
    away.orbit.distance = 500;
    away.ground = false;
    weft_image background = picture(player, &away, 0, 1, canvas);
    weft_image reference = picture(player, &scene, 0, MANY, canvas);
    printf("    at rest, against %d frames:", MANY);
    judge_frames(player, &scene, &reference, &background, canvas);
    judge_shown_frames(player, &scene, &reference, canvas);
    weft_image_free(&background);
    weft_image_free(&reference);
}

static void time_mode(weft_player *player, weft_mode mode, weft_canvas *canvas)
{
    char what[64];
    static const char *const filter[] = {NULL, "exact", "stochastic"};
    weft_scene scene = weft_scene_default();
    scene.pane[0] = mode;
    for (int f = WEFT_FILTER_EXACT; f <= WEFT_FILTER_STOCHASTIC; f++) {
        scene.filter = (weft_filter)f;
        snprintf(what, sizeof what, "%s, %s", weft_mode_name(mode), filter[f]);
        time_scene(player, scene, what, canvas);
        if (mode == WEFT_MODE_ANALYTIC || !weft_player_relief_mm(player, NULL))
            continue;
        scene.relief = false;
        snprintf(what, sizeof what, "%s, %s, no heights", weft_mode_name(mode), filter[f]);
        time_scene(player, scene, what, canvas);
        scene.relief = true;
    }
    time_moving(player, scene, weft_mode_name(mode), canvas);
    scene.shadows = true;
    snprintf(what, sizeof what, "%s, shadows", weft_mode_name(mode));
    time_scene(player, scene, what, canvas);
    if (weft_player_has_environment(player)) {
        scene.shadows = false;
        scene.environment = true;
        scene.light_count = 0;
        for (int f = WEFT_FILTER_EXACT; f <= WEFT_FILTER_STOCHASTIC; f++) {
            scene.filter = (weft_filter)f;
            snprintf(what, sizeof what, "%s, environment, %s", weft_mode_name(mode), filter[f]);
            time_scene(player, scene, what, canvas);
        }
        judge_environment(player, scene, canvas);
    }
}

/* As a window opens: environment, key light, shadows, ground; a cloth of cells of 1/8 mm, 300 mm wide. */
static void time_studio(weft_player *player, weft_mode mode, weft_canvas *canvas)
{
    char what[64];
    weft_error error = {0};
    weft_image map;
    weft_scene scene = weft_scene_default();
    weft_weave_layout layout = weft_player_weave_layout(player);
    stop_on(weft_surroundings_map("studio", &map, &error), &error);
    stop_on(weft_player_set_environment(player, &map, WEFT_ENVIRONMENT_SMOOTH_REGIONS, &error), &error);
    weft_image_free(&map);
    weft_surroundings_light("studio", &scene);
    scene.pane[0] = mode;
    scene.repeat = mode == WEFT_MODE_ANALYTIC ? 300 / (0.75 * layout.tiles_u) : 8;
    scene.shadows = scene.ground = true;
    snprintf(what, sizeof what, "%s, studio", weft_mode_name(mode));
    time_scene(player, scene, what, canvas);
    time_moving(player, scene, what, canvas);
    judge_rest(player, scene, canvas);
    scene.ground = false;
    snprintf(what, sizeof what, "%s, studio without ground", weft_mode_name(mode));
    time_scene(player, scene, what, canvas);
    scene.shadows = false;
    snprintf(what, sizeof what, "%s, studio without shadows", weft_mode_name(mode));
    time_scene(player, scene, what, canvas);
}

/* ---- Against memory, and against C ---- */

enum { COPIED = 256 << 20 };

/* GB/s that one thread reads and writes. */
static double memory_speed(void)
{
    char *from = malloc(COPIED), *to = malloc(COPIED);
    double best_ms = 1e9;
    for (int i = 0; i < 5 && from && to; i++) {
        memset(from, i, COPIED);
        double start = bench_now_ms(CLOCK_MONOTONIC);
        memcpy(to, from, COPIED);
        best_ms = fmin(best_ms, bench_now_ms(CLOCK_MONOTONIC) - start);
    }
    free(from);
    free(to);
    return 2 * 1e-6 * COPIED / best_ms;
}

static double sum_of_c(const weft_material *material, const weft_surface_sample *surface, long *pixels)
{
    weft_error error = {0};
    weft_table_directions directions;
    double sum = 0;
    stop_on(weft_table_directions_create(material, &directions, &error), &error);
    *pixels = 0;
    for (int i = 0; i < width * height; i++) {
        const weft_surface_sample *at = &surface[i];
        if (at->covered == 0)
            continue;
        weft_vec3 light = {at->light[0], at->light[1], at->light[2]}, view = {at->view[0], at->view[1], at->view[2]};
        weft_rgba value = weft_material_sample(material, &directions, at->level, at->u, at->v, light, view);
        sum += (double)value.g;
        (*pixels)++;
    }
    weft_table_directions_free(&directions);
    return sum;
}

/* What an exact frame of the material fetches, and the same pixels by the evaluator in C on one thread. */
static void judge_material(weft_player *player, const char *path)
{
    weft_error error = {0};
    weft_material material;
    weft_surface_sample *surface;
    long pixels;
    const weft_scene scene = weft_scene_default();
    stop_on(weft_material_read(path, &material, &error), &error);
    stop_on(weft_player_read_surface(player, &scene, WEFT_MODE_COMPRESSED, width, height, &surface, &error), &error);
    double start = bench_now_ms(CLOCK_MONOTONIC), sum = sum_of_c(&material, surface, &pixels),
           c_ms = bench_now_ms(CLOCK_MONOTONIC) - start;
    double frame_gb = 1e-9 * weft_fetches_of_material(&material).bytes * (double)pixels, speed = memory_speed();
    printf("compressed: %ld pixels, %d bytes fetched for each; memory would do for %.0f frames/s (%.1f GB/s copied)\n",
           pixels, weft_fetches_of_material(&material).bytes, speed / frame_gb, speed);
    printf("            the evaluator in C takes %.0f ms on one thread (mean green %.4f)\n", c_ms,
           sum / (double)pixels);
    free(surface);
    weft_material_free(&material);
}

static void load_weave(weft_player *player, const char *path, double tiles)
{
    weft_error error = {0};
    weft_weave weave;
    char warning[WEFT_MESSAGE_SIZE];
    stop_on(weft_weave_read(path, NULL, 0, &weave, warning, &error), &error);
    stop_on(weft_player_set_weave(player, &weave, &(weft_weave_layout){.tiles_u = tiles, .tiles_v = tiles}, &error),
            &error);
    weft_weave_free(&weave);
}

static void load_dataset(weft_player *player, const char *path)
{
    weft_error error = {0};
    weft_dataset *dataset;
    int skipped;
    double start = bench_now_ms(CLOCK_MONOTONIC);
    stop_on(weft_dataset_open(path, &dataset, &error), &error);
    stop_on(weft_player_set_dataset(player, dataset, NULL, &skipped, &error), &error);
    weft_dataset_close(dataset);
    printf("%-28s %8.0f ms, %d levels skipped\n", "loading the dataset", bench_now_ms(CLOCK_MONOTONIC) - start,
           skipped);
}

static void load_material(weft_player *player, const char *path)
{
    weft_error error = {0};
    weft_material material;
    stop_on(weft_material_read(path, &material, &error), &error);
    stop_on(weft_player_set_material(player, &material, &error), &error);
    weft_material_free(&material);
}

static void load_environment(weft_player *player, const char *path)
{
    weft_error error = {0};
    weft_image image;
    stop_on(weft_image_read(path, &image, NULL, &error), &error);
    stop_on(weft_player_set_environment(player, &image, WEFT_ENVIRONMENT_REGIONS, &error), &error);
    weft_image_free(&image);
}

static bool has_extension(const char *path, const char *extension)
{
    size_t length = strlen(path), wanted = strlen(extension);
    return length > wanted && strcmp(path + length - wanted, extension) == 0;
}

static void load(weft_player *player, int argc, char **argv)
{
    weft_error error = {0};
    weft_mesh mesh;
    double start = bench_now_ms(CLOCK_MONOTONIC);
    stop_on(weft_mesh_drape(&mesh, &error), &error);
    printf("%-28s %8.0f ms\n", "simulating the drape", bench_now_ms(CLOCK_MONOTONIC) - start);
    stop_on(weft_player_set_mesh(player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
    for (int i = 1; i < argc; i++) {
        if (has_extension(argv[i], ".wv"))
            load_weave(player, argv[i], i + 1 < argc ? atof(argv[i + 1]) : 4);
        else if (has_extension(argv[i], ".weft"))
            load_material(player, argv[i]);
        else if (has_extension(argv[i], ".h5"))
            load_dataset(player, argv[i]);
        else if (has_extension(argv[i], ".hdr") || has_extension(argv[i], ".exr"))
            load_environment(player, argv[i]);
    }
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    weft_headless *headless;
    weft_player *player;
    weft_canvas canvas;
    if (argc > 2 && strcmp(argv[1], "--size") == 0) {
        if (sscanf(argv[2], "%dx%d", &width, &height) != 2 || width < 1 || height < 1) {
            fprintf(stderr, "bench_player: --size takes WxH, not '%s'\n", argv[2]);
            return WEFT_BAD_USAGE;
        }
        argc -= 2;
        argv += 2;
    }
    stop_on(weft_headless_create(WEFT_GL_CORE, &headless, &error), &error);
    stop_on(weft_player_create(&player, &error), &error);
    stop_on(weft_canvas_create(width, height, &canvas, &error), &error);
    printf("%s, %d x %d\n", weft_gl_renderer(), width, height);
    load(player, argc, argv);
    time_far_away(player, &canvas);
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        if (weft_player_has(player, (weft_mode)mode))
            time_mode(player, (weft_mode)mode, &canvas);
    }
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        if (weft_player_has(player, (weft_mode)mode))
            time_studio(player, (weft_mode)mode, &canvas);
    }
    for (int i = 1; i < argc; i++) {
        if (has_extension(argv[i], ".weft"))
            judge_material(player, argv[i]);
    }
    weft_canvas_free(&canvas);
    weft_player_free(player);
    weft_headless_free(headless);
    return 0;
}

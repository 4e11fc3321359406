/* Frame times of the player, each mode at 730 x 400: median of FRAMES frames, by the GPU's own timestamps and by the
 * wall. Usage: bench_player [NAME.weft] [NAME.btf.h5] [CLOTH.wv TILES] */
#include "player/player.h"
#include "player/context.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { WIDTH = 730, HEIGHT = 400, FRAMES = 41, WARM_UP = 5 };

static void stop_on(weft_code code, const weft_error *error)
{
    if (code == WEFT_OK)
        return;
    fprintf(stderr, "bench_player: %s\n", error->message);
    exit((int)code);
}

static double now_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

static double cpu_now_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

static int compare_times(const void *a, const void *b)
{
    double difference = *(const double *)a - *(const double *)b;
    return difference < 0 ? -1 : difference > 0;
}

static double median(double *times)
{
    qsort(times, FRAMES, sizeof *times, compare_times);
    return times[FRAMES / 2];
}

static void draw(weft_player *player, const weft_scene *scene, weft_canvas *canvas)
{
    weft_error error = {0};
    weft_canvas_begin_frame(canvas);
    stop_on(weft_player_draw(player, scene, WIDTH, HEIGHT, (weft_sampling){0}, &error), &error);
    weft_canvas_end_frame(canvas);
}

/* The camera turns a little between frames, so that no driver can reuse one. */
static void time_mode(weft_player *player, weft_scene scene, const char *what, weft_canvas *canvas)
{
    double wall[FRAMES], gpu[FRAMES], cpu_ms = 0;
    GLuint query[2];
    glGenQueries(2, query);
    for (int frame = -WARM_UP; frame < FRAMES; frame++) {
        GLuint64 begin, end;
        scene.orbit.azimuth_rad += 0.01;
        double start = now_ms(), cpu_start = cpu_now_ms();
        glQueryCounter(query[0], GL_TIMESTAMP);
        draw(player, &scene, canvas);
        glQueryCounter(query[1], GL_TIMESTAMP);
        glFinish();
        glGetQueryObjectui64v(query[0], GL_QUERY_RESULT, &begin);
        glGetQueryObjectui64v(query[1], GL_QUERY_RESULT, &end);
        if (frame >= 0) {
            wall[frame] = now_ms() - start;
            cpu_ms += (cpu_now_ms() - cpu_start) / FRAMES;
            gpu[frame] = 1e-6 * (double)(end - begin);
        }
    }
    glDeleteQueries(2, query);
    double wall_ms = median(wall);
    printf("%-28s %8.2f ms wall %8.2f ms timestamps %8.2f ms processor %7.1f frames/s\n", what, wall_ms, median(gpu),
           cpu_ms, 1000 / wall_ms);
}

static void load_weave(weft_player *player, const char *path, double tiles)
{
    weft_error error = {0};
    weft_weave weave;
    char warning[WEFT_MESSAGE_SIZE];
    stop_on(weft_weave_read(path, NULL, 0, &weave, warning, &error), &error);
    stop_on(weft_player_set_weave(player, &weave, tiles, tiles, &error), &error);
    weft_weave_free(&weave);
}

static void load_dataset(weft_player *player, const char *path)
{
    weft_error error = {0};
    weft_dataset *dataset;
    int skipped;
    double start = now_ms();
    stop_on(weft_dataset_open(path, &dataset, &error), &error);
    stop_on(weft_player_set_dataset(player, dataset, NULL, &skipped, &error), &error);
    weft_dataset_close(dataset);
    printf("%-28s %8.0f ms, %d levels skipped\n", "loading the dataset", now_ms() - start, skipped);
}

static void load_material(weft_player *player, const char *path)
{
    weft_error error = {0};
    weft_material material;
    stop_on(weft_material_read(path, &material, &error), &error);
    stop_on(weft_player_set_material(player, &material, &error), &error);
    weft_material_free(&material);
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
    double start = now_ms();
    stop_on(weft_mesh_drape(&mesh, &error), &error);
    printf("%-28s %8.0f ms\n", "simulating the drape", now_ms() - start);
    stop_on(weft_player_set_mesh(player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
    for (int i = 1; i < argc; i++) {
        if (has_extension(argv[i], ".wv"))
            load_weave(player, argv[i], i + 1 < argc ? atof(argv[i + 1]) : 4);
        else if (has_extension(argv[i], ".weft"))
            load_material(player, argv[i]);
        else if (has_extension(argv[i], ".h5"))
            load_dataset(player, argv[i]);
    }
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    weft_headless *headless;
    weft_player *player;
    weft_canvas canvas;
    stop_on(weft_headless_create(WEFT_GL_CORE, &headless, &error), &error);
    stop_on(weft_player_create(&player, &error), &error);
    stop_on(weft_canvas_create(WIDTH, HEIGHT, &canvas, &error), &error);
    printf("%s, %d x %d\n", weft_gl_renderer(), WIDTH, HEIGHT);
    load(player, argc, argv);
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        weft_scene scene = weft_scene_default();
        char what[64];
        scene.pane[0] = (weft_mode)mode;
        if (!weft_player_has(player, scene.pane[0]))
            continue;
        time_mode(player, scene, weft_mode_name(scene.pane[0]), &canvas);
        scene.level_choice = WEFT_LEVEL_NONE;
        snprintf(what, sizeof what, "%s, finest level", weft_mode_name(scene.pane[0]));
        time_mode(player, scene, what, &canvas);
    }
    weft_canvas_free(&canvas);
    weft_player_free(player);
    weft_headless_free(headless);
    return 0;
}

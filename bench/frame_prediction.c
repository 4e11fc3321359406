/* Whether the frame time of at most 64 x 64 texels, by which weft compress --preset predicts, is that of the whole
 * material: `bench_frame_prediction NAME.btf.h5 COMPONENTS` (0: two lobes and T). Both are drawn in turn, as the price
 * list draws them. Prints the least and the median of TRIES, by the wall and by the processor: other programs on the
 * machine lengthen the first. */
#include "base/numeric/statistics.h"
#include "bench/measure.h"
#include "compress/compress.h"
#include "compress/hold_out/texel_subset.h"
#include "player/draw/player.h"
#include "player/gl/context.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BLOCK, WHOLE, MATERIALS };
enum { SIDE = 64, WIDTH = 730, HEIGHT = 400, TRIES = 9, FEW = 1, MANY = 3 };

static const clockid_t clocks[] = {CLOCK_PROCESS_CPUTIME_ID, CLOCK_MONOTONIC};
static const char *const clock_name[] = {"processor", "wall"};

enum { CLOCKS = sizeof clocks / sizeof clocks[0] };

static void stop_on(weft_code code, const weft_error *error)
{
    bench_stop_on("bench_frame_prediction", code, error);
}

/* ---- Materials ---- */

static weft_dataset *take_texels(weft_dataset *dataset)
{
    weft_error error = {0};
    weft_texel_subset subset;
    weft_dataset *block;
    stop_on(weft_texel_subset_read(dataset, WEFT_TEXEL_SUBSET_PATCHES, SIDE, &subset, &error), &error);
    uint8_t *none = calloc((size_t)subset.layout.image_count, 1);
    stop_on(weft_texel_subset_write(&subset, none, "frame_prediction.btf.h5", &block, &error), &error);
    free(none);
    weft_texel_subset_free(&subset);
    return block;
}

static void compress(const char *path, int components, weft_material material[MATERIALS])
{
    weft_error error = {0};
    weft_dataset *dataset;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = components;
    stop_on(weft_dataset_open(path, &dataset, &error), &error);
    weft_dataset *block = take_texels(dataset);
    options.heights = false; /* those of the whole are given afterwards */
    stop_on(weft_compress(block, &options, NULL, &material[BLOCK], NULL, &error), &error);
    stop_on(weft_compress_take_heights(dataset, &material[BLOCK], &error), &error);
    options.heights = true;
    stop_on(weft_compress(dataset, &options, NULL, &material[WHOLE], NULL, &error), &error);
    weft_dataset_close(block);
    weft_dataset_close(dataset);
}

/* ---- Frames ---- */

static void picture(weft_player *player, int samples, double took_ms[CLOCKS])
{
    weft_error error = {0};
    weft_image image;
    weft_scene scene = weft_scene_default();
    scene.pane_count = 1;
    scene.pane[0] = WEFT_MODE_COMPRESSED;
    scene.labels = false;
    scene.relief = true;
    scene.filter = WEFT_FILTER_EXACT;
    for (int i = 0; i < CLOCKS; i++)
        took_ms[i] = bench_now_ms(clocks[i]);
    stop_on(weft_player_picture(player, &scene, WIDTH, HEIGHT, samples, NULL, &image, &error), &error);
    for (int i = 0; i < CLOCKS; i++)
        took_ms[i] = bench_now_ms(clocks[i]) - took_ms[i];
    weft_image_free(&image);
}

/* Of one frame: what two pictures of different numbers of frames share is left out. */
static void frame(weft_player *player, const weft_material *material, double frame_ms[CLOCKS])
{
    weft_error error = {0};
    double few[CLOCKS], many[CLOCKS];
    stop_on(weft_player_set_material(player, material, &error), &error);
    picture(player, FEW, few); /* compiles, and fills textures */
    picture(player, FEW, few);
    picture(player, MANY, many);
    for (int i = 0; i < CLOCKS; i++)
        frame_ms[i] = (many[i] - few[i]) / (MANY * MANY - FEW * FEW);
}

static void print(const char *name, const char *measure, double block, double whole)
{
    printf("%-10s %-7s predicted %6.1f ms, is %6.1f ms (%+.1f %%)\n", name, measure, block, whole,
           100 * (whole / block - 1));
}

static void compare(weft_player *player, const weft_material material[MATERIALS])
{
    double took_ms[CLOCKS][MATERIALS][TRIES];
    for (int try = 0; try < TRIES; try++)
        for (int m = 0; m < MATERIALS; m++) {
            double frame_ms[CLOCKS];
            frame(player, &material[m], frame_ms);
            for (int i = 0; i < CLOCKS; i++)
                took_ms[i][m][try] = frame_ms[i];
        }
    for (int i = 0; i < CLOCKS; i++) {
        double least[MATERIALS] = {INFINITY, INFINITY}, median[MATERIALS];
        for (int m = 0; m < MATERIALS; m++) {
            for (int try = 0; try < TRIES; try++)
                least[m] = fmin(least[m], took_ms[i][m][try]);
            median[m] = weft_quantile(took_ms[i][m], TRIES, 0.5);
        }
        print(clock_name[i], "least", least[BLOCK], least[WHOLE]);
        print(clock_name[i], "median", median[BLOCK], median[WHOLE]);
    }
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    weft_material material[MATERIALS];
    weft_mesh mesh;
    weft_headless *headless;
    weft_player *player;
    if (argc != 3) {
        fprintf(stderr, "Usage: bench_frame_prediction NAME.btf.h5 COMPONENTS\n");
        return WEFT_BAD_USAGE;
    }
    compress(argv[1], atoi(argv[2]), material);
    stop_on(weft_headless_create(WEFT_GL_CORE, &headless, &error), &error);
    stop_on(weft_player_create(&player, &error), &error);
    stop_on(weft_mesh_open("drape", &mesh, &error), &error);
    stop_on(weft_player_set_mesh(player, &mesh, &error), &error);
    compare(player, material);
    weft_mesh_free(&mesh);
    weft_player_free(player);
    weft_headless_free(headless);
    for (int m = 0; m < MATERIALS; m++)
        weft_material_free(&material[m]);
    return 0;
}

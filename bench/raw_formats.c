/* What each format of the samples of a dataset costs and loses: graphics memory, processor time of streaming, time of a
 * frame by the wall and of processor, and the errors of samples and of a picture against half floats. Usage:
 * bench_raw_formats NAME.btf.h5 */
#include "../tests/player/raw/bc6h_decode.h"
#include "bench/measure.h"
#include "player/draw/canvas.h"
#include "player/draw/player_parts.h"
#include "player/gl/context.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 730, HEIGHT = 400, FRAMES = 8, BLOCK = WEFT_RAW_BLOCK, TEXELS = BLOCK * BLOCK, SCENES = 2 };

static void stop_on(weft_code code, const weft_error *error)
{
    bench_stop_on("bench_raw_formats", code, error);
}

/* ---- Samples ---- */

/* All that the graphics card would hold, in the order in which it comes: the same for every format. */
typedef struct collection {
    weft_raw_plan plan;
    int strip_count, capacity;
    weft_raw_strip *strip;
    double streaming_ms; /* of processor */
} collection;

static weft_code begin(void *context, const weft_raw_plan *plan, weft_direction_map *directions,
                       weft_relief_map *relief, weft_error *error)
{
    (void)directions;
    (void)relief;
    (void)error;
    collection *c = context;
    c->plan = *plan;
    return WEFT_OK;
}

static weft_code take(void *context, const weft_raw_strip *strip, weft_error *error)
{
    collection *c = context;
    if (c->strip_count == c->capacity) {
        c->capacity = 2 * c->capacity + 64;
        weft_raw_strip *grown = realloc(c->strip, (size_t)c->capacity * sizeof *grown);
        if (!grown)
            return weft_fail_memory(error, "strips", (size_t)c->capacity * sizeof *grown);
        c->strip = grown;
    }
    c->strip[c->strip_count++] = *strip;
    return WEFT_OK;
}

static weft_code end(void *context, bool opaque, weft_error *error)
{
    (void)context;
    (void)opaque;
    (void)error;
    return WEFT_OK;
}

static collection collect(weft_dataset *dataset, weft_raw_format format)
{
    weft_error error = {0};
    collection c = {0};
    const weft_raw_sink sink = {&c, begin, take, end};
    const weft_raw_limits limits = weft_raw_texture_limits(format);
    double start = bench_now_ms(CLOCK_THREAD_CPUTIME_ID);
    stop_on(weft_raw_stream(dataset, &limits, NULL, &sink, &error), &error);
    c.streaming_ms = bench_now_ms(CLOCK_THREAD_CPUTIME_ID) - start;
    return c;
}

static void collection_free(collection *c)
{
    for (int i = 0; i < c->strip_count; i++)
        free(c->strip[i].texels);
    free(c->strip);
}

/* Block `block` of `layer` of a strip that is `width` texels wide. */
static void decode(weft_raw_format format, const void *texels, int layer, int block, int width, float value[TEXELS][3])
{
    weft_half half[TEXELS][3];
    if (format == WEFT_RAW_BC6H)
        bc6h_decode((const uint8_t *)texels + (size_t)(BLOCK * (layer * width + BLOCK * block)), half);
    for (int t = 0; t < TEXELS; t++) {
        size_t at = ((size_t)layer * BLOCK + (size_t)(t / BLOCK)) * (size_t)width + (size_t)(BLOCK * block + t % BLOCK);
        for (int c = 0; c < 3; c++) {
            uint32_t bits = format == WEFT_RAW_SHARED_EXPONENT ? ((const uint32_t *)texels)[at] : 0;
            value[t][c] = format == WEFT_RAW_BC6H ? weft_float_of_half(half[t][c])
                          : format == WEFT_RAW_HALF
                              ? weft_float_of_half(((const weft_half *)texels)[4 * at + (size_t)c])
                              : ldexpf((float)(bits >> 9 * c & 511), (int)(bits >> 27) - 24);
        }
    }
}

typedef struct sample_error {
    double square, norm, relative;
    long count;
} sample_error;

static void add_block(float value[TEXELS][3], float wanted[TEXELS][3], sample_error *e)
{
    for (int i = 0; i < 3 * TEXELS; i++) {
        double of = (double)wanted[i / 3][i % 3], difference = (double)value[i / 3][i % 3] - of;
        e->square += difference * difference;
        e->norm += of * of;
        if (of > 1e-3) {
            e->relative += difference * difference / (of * of);
            e->count++;
        }
    }
}

/* Of all levels, what fills up blocks included. */
static sample_error compare_samples(const collection *c, const collection *exact)
{
    sample_error e = {0};
    const weft_raw_tiles *tiles = &c->plan.tiles[WEFT_RAW_SAMPLES];
    for (int i = 0; i < c->strip_count; i++) {
        const weft_raw_strip *strip = &c->strip[i];
        int blocks = (int)(strip->bytes / weft_raw_block_bytes(tiles->format)) / tiles->layers;
        for (int layer = 0; strip->part == WEFT_RAW_SAMPLES && layer < tiles->layers; layer++) {
            for (int k = 0; k < blocks; k++) {
                float value[TEXELS][3], wanted[TEXELS][3];
                decode(tiles->format, strip->texels, layer, k, blocks * BLOCK, value);
                decode(WEFT_RAW_HALF, exact->strip[i].texels, layer, k, blocks * BLOCK, wanted);
                add_block(value, wanted, &e);
            }
        }
    }
    return e;
}

/* ---- Pictures ---- */

/* Of a frame. */
typedef struct frame_time {
    double wall_ms, processor_ms;
} frame_time;

static weft_image draw(weft_player *player, weft_scene scene, weft_filter filter, weft_canvas *canvas, frame_time *time)
{
    weft_error error = {0};
    weft_image image;
    scene.filter = filter;
    frame_time start = {0};
    for (int frame = -1; frame < FRAMES; frame++) {
        const weft_sampling moving = {.frame = -1};
        if (frame == 0)
            start = (frame_time){bench_now_ms(CLOCK_MONOTONIC), bench_now_ms(CLOCK_PROCESS_CPUTIME_ID)};
        weft_canvas_clear(canvas);
        weft_canvas_begin_frame(canvas);
        stop_on(weft_player_draw(player, &scene, WIDTH, HEIGHT, moving, &error), &error);
        weft_canvas_end_frame(canvas);
        glFinish();
    }
    time->wall_ms = (bench_now_ms(CLOCK_MONOTONIC) - start.wall_ms) / FRAMES;
    time->processor_ms = (bench_now_ms(CLOCK_PROCESS_CPUTIME_ID) - start.processor_ms) / FRAMES;
    stop_on(weft_canvas_read(canvas, &image, &error), &error);
    return image;
}

typedef struct bench {
    weft_dataset *dataset;
    weft_player *player;
    weft_canvas canvas;
    collection exact;
    weft_image background, reference[SCENES];
} bench;

/* From afar, and so near that one texel covers several pixels. */
static weft_scene make_scene(int i)
{
    weft_scene scene = weft_scene_default();
    scene.pane[0] = WEFT_MODE_RAW;
    if (i == 1)
        scene.repeat = 1;
    return scene;
}

static double judge_picture(bench *b, int i, frame_time *time)
{
    weft_image image = draw(b->player, make_scene(i), WEFT_FILTER_EXACT, &b->canvas, time);
    if (!b->reference[i].pixels)
        b->reference[i] = image;
    double error = bench_relative_rmse(&image, &b->reference[i], &b->background);
    if (image.pixels != b->reference[i].pixels)
        weft_image_free(&image);
    return error;
}

static void draw_background(bench *b)
{
    frame_time time;
    weft_scene scene = make_scene(0);
    scene.orbit.distance = 500;
    b->background = draw(b->player, scene, WEFT_FILTER_EXACT, &b->canvas, &time);
}

static void show(bench *b, weft_raw_format format)
{
    weft_error error = {0};
    weft_raw_texture texture;
    const weft_raw_limits limits = weft_raw_texture_limits(format);
    stop_on(weft_raw_texture_upload(b->dataset, &limits, NULL, &texture, &error), &error);
    weft_player_take_raw(b->player, &texture, (const double[2]){0, 0});
}

static void judge(bench *b, weft_raw_format format)
{
    frame_time exact, near, stochastic;
    collection c = collect(b->dataset, format);
    sample_error e = compare_samples(&c, &b->exact);
    printf("%-28s %7.1f MB, streamed in %5.0f ms; samples: relative RMSE %.3f %%, each %.3f %%\n",
           weft_raw_format_name(format), 1e-6 * (double)weft_raw_plan_bytes(&c.plan, format), c.streaming_ms,
           100 * sqrt(e.square / e.norm), 100 * sqrt(e.relative / (double)e.count));
    collection_free(&c);
    show(b, format);
    if (!b->background.pixels)
        draw_background(b);
    double far_error = judge_picture(b, 0, &exact), near_error = judge_picture(b, 1, &near);
    weft_image image = draw(b->player, make_scene(0), WEFT_FILTER_STOCHASTIC, &b->canvas, &stochastic);
    printf("%28s wall / processor: frame %.2f / %.1f ms, near %.2f / %.1f ms, stochastic %.2f / %.1f ms\n", "",
           exact.wall_ms, exact.processor_ms, near.wall_ms, near.processor_ms, stochastic.wall_ms,
           stochastic.processor_ms);
    printf("%28s picture: relative RMSE %.3f %%, near %.3f %%\n", "", 100 * far_error, 100 * near_error);
    weft_image_free(&image);
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    weft_headless *headless;
    weft_mesh mesh;
    bench b = {0};
    if (argc != 2) {
        fprintf(stderr, "usage: bench_raw_formats NAME.btf.h5\n");
        return WEFT_BAD_USAGE;
    }
    stop_on(weft_dataset_open(argv[1], &b.dataset, &error), &error);
    stop_on(weft_headless_create(WEFT_GL_CORE, &headless, &error), &error);
    stop_on(weft_player_create(&b.player, &error), &error);
    stop_on(weft_canvas_create(WIDTH, HEIGHT, &b.canvas, &error), &error);
    stop_on(weft_mesh_drape(&mesh, &error), &error);
    stop_on(weft_player_set_mesh(b.player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
    printf("%s, %d x %d; processor: all threads\n", weft_gl_renderer(), WIDTH, HEIGHT);
    b.exact = collect(b.dataset, WEFT_RAW_HALF);
    for (int format = WEFT_RAW_HALF; format <= WEFT_RAW_BC6H; format++)
        judge(&b, (weft_raw_format)format);
    collection_free(&b.exact);
    for (int i = 0; i < SCENES; i++)
        weft_image_free(&b.reference[i]);
    weft_image_free(&b.background);
    weft_canvas_free(&b.canvas);
    weft_player_free(b.player);
    weft_headless_free(headless);
    weft_dataset_close(b.dataset);
    return 0;
}

#include "compare/truth/comparison.h"

#include "geometry/light/sample_sequence.h"

#include <stdlib.h>
#include <string.h>

/* Keeps the place in the pixel apart from the bounces of the path, which count from 0. */
#define PLACE_KEY 0x10000u

/* The spread between batches tells the noise. */
enum { BATCHES = 4 };

/* ---- The surface ---- */

static weft_vec3 vector_of(const float from[3])
{
    return weft_vec3_of((weft_real)from[0], (weft_real)from[1], (weft_real)from[2]);
}

weft_code weft_truth_base_create(const weft_mesh *mesh, double repeat, double tile_width_mm, weft_truth_base *base,
                                 weft_error *error)
{
    *base = (weft_truth_base){.mm_per_unit = repeat * tile_width_mm};
    base->vertex = malloc((size_t)mesh->vertex_count * sizeof *base->vertex);
    if (!base->vertex)
        return weft_fail_memory(error, "surface", (size_t)mesh->vertex_count * sizeof *base->vertex);
    weft_real scale = base->mm_per_unit;
    for (int i = 0; i < mesh->vertex_count; i++) {
        const weft_vertex *v = &mesh->vertex[i];
        base->vertex[i] = (weft_base_vertex){.position = weft_scale(vector_of(v->position), scale),
                                             .normal = weft_unit(vector_of(v->normal)),
                                             .x = (weft_real)v->coordinate[0] * scale,
                                             .y = (weft_real)v->coordinate[1] * scale};
    }
    base->surface = (weft_base_surface){.vertex_count = mesh->vertex_count,
                                        .triangle_count = mesh->triangle_count,
                                        .vertex = base->vertex,
                                        .triangle = (const uint32_t(*)[3])mesh->index};
    return WEFT_OK;
}

void weft_truth_base_free(weft_truth_base *base)
{
    free(base->vertex);
    *base = (weft_truth_base){0};
}

/* ---- The camera ---- */

typedef struct camera {
    weft_vec3 eye; /* mm */
    weft_orbit_axes rays;
} camera;

static camera camera_of(const weft_mesh *mesh, double mm_per_unit, const weft_orbit *orbit, int width, int height)
{
    float centre[3], radius;
    weft_mesh_bounds(mesh, centre, &radius);
    weft_vec3 eye = weft_orbit_eye(orbit, vector_of(centre), (double)radius);
    return (camera){weft_scale(eye, mm_per_unit), weft_orbit_rays(orbit, width, height, 0, 0)};
}

/* (x, y) in pixels from the lower left corner. */
static weft_vec3 ray_through(const camera *from, double x, double y)
{
    weft_vec3 across = weft_add(weft_scale(from->rays.right, x), weft_scale(from->rays.up, y));
    return weft_unit(weft_subtract(across, from->rays.backward));
}

/* ---- Pixels ---- */

/* What the noise is found from: the variance of the mean of a pixel, and its square, summed over the channels. */
typedef struct spread {
    double variance, square;
} spread;

typedef struct tracing {
    const weft_draped_cloth *cloth;
    const weft_trace_options *options;
    const weft_image *background;
    weft_draped_light light;
    camera from;
    double exposure;
    weft_traced *traced;
    spread *row; /* [width] */
} tracing;

static void trace_batch(const tracing *t, int pixel, uint64_t key, int paths, double all[3], double near[3])
{
    int width = t->options->width, height = t->options->height, misses = 0;
    weft_draped_radiance sum = {0};
    for (uint32_t i = 0; i < (uint32_t)paths; i++) {
        double point[2];
        weft_sequence_point(weft_sequence_key(key, PLACE_KEY), i, point);
        weft_vec3 direction = ray_through(&t->from, pixel % width + point[0], height - pixel / width - 1 + point[1]);
        misses += !weft_draped_cloth_path(t->cloth, t->from.eye, direction, &t->light, key, i, &sum);
    }
    for (int c = 0; c < 3; c++) {
        double behind = misses * (double)t->background->pixels[3 * (size_t)pixel + (size_t)c];
        all[c] = (t->exposure * (double)sum.all[c] + behind) / paths;
        near[c] = (t->exposure * (double)sum.near[c] + behind) / paths;
    }
}

static spread trace_pixel(const tracing *t, int pixel)
{
    double all[BATCHES][3], near[BATCHES][3];
    spread result = {0};
    uint64_t key = weft_sequence_key(t->options->seed, (uint64_t)pixel);
    int paths = (t->options->paths + BATCHES - 1) / BATCHES;
    for (int b = 0; b < BATCHES; b++)
        trace_batch(t, pixel, weft_sequence_key(key, (uint64_t)b), paths, all[b], near[b]);
    for (int c = 0; c < 3; c++) {
        double mean = 0, near_mean = 0, squares = 0;
        for (int b = 0; b < BATCHES; b++) {
            mean += all[b][c] / BATCHES;
            near_mean += near[b][c] / BATCHES;
            squares += all[b][c] * all[b][c] / BATCHES;
        }
        t->traced->all.pixels[3 * (size_t)pixel + (size_t)c] = (float)mean;
        t->traced->near.pixels[3 * (size_t)pixel + (size_t)c] = (float)near_mean;
        result.variance += fmax(squares - mean * mean, 0) / (BATCHES - 1);
        result.square += mean * mean;
    }
    return result;
}

/* Adds one row of pixels to `sum`, in their order; a pixel without variance saw the background alone. */
static void trace_row(const tracing *t, int row, spread *sum)
{
    int width = t->options->width;
#pragma omp parallel for schedule(dynamic, 4)
    for (int x = 0; x < width; x++)
        t->row[x] = trace_pixel(t, row * width + x);
    for (int x = 0; x < width; x++) {
        sum->variance += t->row[x].variance;
        sum->square += t->row[x].variance > 0 ? t->row[x].square : 0;
    }
}

weft_code weft_trace(const weft_draped_cloth *cloth, const weft_mesh *mesh, double mm_per_unit, const weft_scene *scene,
                     const weft_trace_options *options, const weft_image *background, const weft_progress *progress,
                     weft_traced *traced, weft_error *error)
{
    *traced = (weft_traced){0};
    WEFT_TRY(weft_image_create(options->width, options->height, &traced->all, error));
    WEFT_TRY(weft_image_create(options->width, options->height, &traced->near, error));
    weft_vec3 light = weft_direction_of_angles(scene->light[0].direction);
    tracing t = {.cloth = cloth,
                 .options = options,
                 .background = background,
                 .light = {light, options->bounces, options->reach_mm},
                 .from = camera_of(mesh, mm_per_unit, &scene->orbit, options->width, options->height),
                 .exposure = scene->exposure,
                 .traced = traced,
                 .row = calloc((size_t)options->width, sizeof(spread))};
    if (!t.row)
        return weft_fail_memory(error, "row of pixels", (size_t)options->width * sizeof(spread));
    spread sum = {0};
    for (int row = 0; row < options->height; row++) {
        trace_row(&t, row, &sum);
        weft_progress_report(progress, "tracing the truth", row + 1, options->height);
    }
    free(t.row);
    traced->noise = sum.square > 0 ? sqrt(sum.variance / sum.square) : 0;
    return WEFT_OK;
}

void weft_traced_free(weft_traced *traced)
{
    weft_image_free(&traced->all);
    weft_image_free(&traced->near);
}

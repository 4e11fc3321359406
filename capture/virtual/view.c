#include "capture/virtual/view.h"

#include <stdlib.h>
#include <string.h>

/* What making a view needs at hand. */
typedef struct scene {
    const weft_virtual_optics *optics;
    const weft_target *target;
    const weft_virtual_sample *sample;
    weft_virtual_eye eye;
} scene;

/* Whether sample `index` of a pixel meets the plate, and in which region. */
static weft_target_region sampled_region(const scene *s, int x, int y, int index, double *x_mm, double *y_mm)
{
    if (!weft_virtual_optics_meet(s->optics, &s->eye, x, y, index, x_mm, y_mm))
        return WEFT_TARGET_OUTSIDE;
    return weft_target_region_at(s->target, *x_mm, *y_mm);
}

/* The printed reflectance of a pixel; returns the number of samples that see cloth. */
static int sample_print(const scene *s, int x, int y, float *print)
{
    double sum = 0, x_mm, y_mm;
    int cloth_count = 0, sample_count = s->optics->sample_count;
    for (int i = 0; i < sample_count; i++) {
        weft_target_region region = sampled_region(s, x, y, i, &x_mm, &y_mm);
        if (region == WEFT_TARGET_OPENING)
            cloth_count++;
        else if (region != WEFT_TARGET_OUTSIDE)
            sum += weft_target_reflectance(s->target, x_mm, y_mm);
    }
    *print = (float)(sum / sample_count);
    return cloth_count;
}

static void sample_row(const scene *s, int y, weft_virtual_view *view, int *counts)
{
    for (int x = 0; x < view->width; x++) {
        size_t pixel = (size_t)y * (size_t)view->width + (size_t)x;
        double x_mm, y_mm;
        counts[pixel] = 0;
        view->print[pixel] = view->x_mm[pixel] = view->y_mm[pixel] = 0;
        if (!weft_virtual_optics_meet_centre(s->optics, &s->eye, x, y, &x_mm, &y_mm))
            continue;
        view->x_mm[pixel] = (float)x_mm;
        view->y_mm[pixel] = (float)y_mm;
        counts[pixel] = sample_print(s, x, y, &view->print[pixel]);
    }
}

/* Lists the pixels that see cloth, row by row; returns the number of their points. */
static size_t list_cloth(weft_virtual_view *view, const int *counts)
{
    int listed = 0;
    size_t points = 0;
    for (int y = 0; y < view->height; y++) {
        view->row[y] = listed;
        for (int x = 0; x < view->width; x++) {
            int pixel = y * view->width + x;
            if (counts[pixel] > 0) {
                view->cloth[listed++] = (weft_cloth_pixel){pixel, counts[pixel], points};
                points += (size_t)counts[pixel];
            }
        }
    }
    view->row[view->height] = listed;
    return points;
}

static void locate_cloth(const scene *s, const weft_virtual_view *view, const weft_cloth_pixel *cloth)
{
    size_t next = cloth->first;
    int x = cloth->pixel % view->width, y = cloth->pixel / view->width;
    for (int i = 0; i < view->sample_count; i++) {
        double x_mm, y_mm;
        if (sampled_region(s, x, y, i, &x_mm, &y_mm) == WEFT_TARGET_OPENING)
            view->point[next++] = weft_virtual_cloth_locate(&s->sample->flat, x_mm, y_mm);
    }
}

/* The same for a sample with depth: what the points see on their way down. */
static void see_cloth(const scene *s, const weft_virtual_view *view, const weft_cloth_pixel *cloth)
{
    size_t next = cloth->first;
    int x = cloth->pixel % view->width, y = cloth->pixel / view->width;
    for (int i = 0; i < view->sample_count; i++) {
        double x_mm, y_mm;
        if (sampled_region(s, x, y, i, &x_mm, &y_mm) != WEFT_TARGET_OPENING)
            continue;
        weft_vec3 toward_camera = weft_unit(weft_subtract(s->eye.centre, weft_vec3_of(x_mm, y_mm, 0)));
        weft_seen_vertex *path = view->vertex + next * (size_t)view->path_vertices;
        view->vertex_count[next++] = (uint8_t)weft_virtual_sample_see(s->sample, x_mm, y_mm, toward_camera,
                                                                      (uint64_t)cloth->pixel, (uint32_t)i, path);
    }
}

static int count_cloth(const int *counts, size_t pixels)
{
    int cloth = 0;
    for (size_t i = 0; i < pixels; i++)
        cloth += counts[i] > 0;
    return cloth;
}

static weft_code allocate_view(weft_virtual_view *view, weft_error *error)
{
    size_t pixels = (size_t)view->width * (size_t)view->height;
    view->x_mm = malloc(pixels * sizeof *view->x_mm);
    view->y_mm = malloc(pixels * sizeof *view->y_mm);
    view->print = malloc(pixels * sizeof *view->print);
    view->row = malloc(((size_t)view->height + 1) * sizeof *view->row);
    if (!view->x_mm || !view->y_mm || !view->print || !view->row)
        return weft_fail_memory(error, "a view", 3 * pixels * sizeof(float));
    return WEFT_OK;
}

static weft_code allocate_points(const weft_virtual_sample *sample, size_t points, weft_virtual_view *view,
                                 weft_error *error)
{
    size_t bytes = (points + 1) * sizeof *view->point;
    if (!sample->deep) {
        view->point = malloc(bytes);
        return view->point ? WEFT_OK : weft_fail_memory(error, "the cloth in a view", bytes);
    }
    view->path_vertices = 1 + weft_stitch_sample_bounces(sample->deep);
    bytes = (points + 1) * (size_t)view->path_vertices * sizeof *view->vertex;
    view->vertex = malloc(bytes);
    view->vertex_count = malloc(points + 1);
    return view->vertex && view->vertex_count ? WEFT_OK : weft_fail_memory(error, "paths of light in a view", bytes);
}

static weft_code sample_cloth(const scene *s, const int *counts, weft_virtual_view *view, weft_error *error)
{
    int cloth_count = count_cloth(counts, (size_t)view->width * (size_t)view->height);
    view->cloth = calloc((size_t)cloth_count + 1, sizeof *view->cloth);
    if (!view->cloth)
        return weft_fail_memory(error, "the cloth in a view", (size_t)cloth_count * sizeof *view->cloth);
    size_t points = list_cloth(view, counts);
    WEFT_TRY(allocate_points(s->sample, points, view, error));
#pragma omp parallel for schedule(dynamic, 256)
    for (int i = 0; i < cloth_count; i++) {
        if (s->sample->deep)
            see_cloth(s, view, &view->cloth[i]);
        else
            locate_cloth(s, view, &view->cloth[i]);
    }
    return WEFT_OK;
}

static weft_code sample_view(const scene *s, weft_virtual_view *view, weft_error *error)
{
    WEFT_TRY(allocate_view(view, error));
    size_t bytes = (size_t)view->width * (size_t)view->height * sizeof(int);
    int *counts = malloc(bytes);
    if (!counts)
        return weft_fail_memory(error, "a view", bytes);
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < view->height; y++)
        sample_row(s, y, view, counts);
    weft_code code = sample_cloth(s, counts, view, error);
    free(counts);
    return code;
}

weft_code weft_virtual_view_make(const weft_virtual_optics *optics, const weft_target *target,
                                 const weft_virtual_sample *sample, const weft_pose *pose, weft_virtual_view *view,
                                 weft_error *error)
{
    scene s = {optics, target, sample, weft_virtual_eye_of_pose(pose)};
    *view = (weft_virtual_view){.width = optics->width,
                                .height = optics->height,
                                .sample_count = optics->sample_count,
                                .camera = s.eye.centre,
                                .vignetting = optics->vignetting};
    return sample_view(&s, view, error);
}

void weft_virtual_view_free(weft_virtual_view *view)
{
    free(view->x_mm);
    free(view->y_mm);
    free(view->print);
    free(view->row);
    free(view->cloth);
    free(view->point);
    free(view->vertex);
    free(view->vertex_count);
    *view = (weft_virtual_view){0};
}

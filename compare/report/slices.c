#include "compare/report/compare.h"

#include "base/atomic_file.h"
#include "btf/direction/direction.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Fewer images say nothing about a hemisphere of lights. */
enum { MIN_IMAGES = 30 };

static const double most_theta_deg = 85;

/* ---- Directions ---- */

static const struct {
    double theta_deg, phi_deg;
} wanted_view[WEFT_SLICE_VIEWS] = {{0, 0}, {30, 0}, {30, 90}, {60, 0}, {60, 45}, {60, 90}, {60, 135}};

static bool already_chosen(const weft_slices *slices, weft_vec3 view)
{
    for (int i = 0; i < slices->view_count; i++) {
        if (weft_length(weft_subtract(slices->view[i], view)) < 1e-6)
            return true;
    }
    return false;
}

static void choose_views(const weft_dataset_layout *layout, weft_slices *slices)
{
    for (int i = 0; i < WEFT_SLICE_VIEWS; i++) {
        weft_angles angles = {weft_rad_of_deg(wanted_view[i].theta_deg), weft_rad_of_deg(wanted_view[i].phi_deg)};
        weft_vec3 wanted = weft_direction_of_angles(angles), nearest = {0};
        for (int view = 0; view < layout->view_count; view++) {
            weft_vec3 at = weft_dataset_view_direction(layout, view, layout->width / 2, layout->height / 2);
            if (at.z > 0 && !already_chosen(slices, at) && weft_dot(at, wanted) > weft_dot(nearest, wanted))
                nearest = at;
        }
        if (nearest.z > 0)
            slices->view[slices->view_count++] = nearest;
    }
}

static double largest_theta(const weft_dataset_layout *layout)
{
    double largest = 0;
    for (int i = 0; i < layout->image_count; i++) {
        weft_vec3 light = weft_dataset_light_direction(layout, i, layout->width / 2, layout->height / 2);
        largest = fmax(largest, weft_angles_of_direction(light).theta_rad);
    }
    return fmin(largest, weft_rad_of_deg(most_theta_deg));
}

static void place_lights(weft_slices *slices)
{
    slices->light[0] = weft_vec3_of(0, 0, 1);
    for (int i = 1; i < WEFT_SLICE_LIGHTS; i++) {
        int ring = 1 + (i - 1) / WEFT_SLICE_AZIMUTHS, step = (i - 1) % WEFT_SLICE_AZIMUTHS;
        weft_angles angles = {slices->largest_theta_rad * ring / WEFT_SLICE_RINGS,
                              2 * WEFT_PI * step / WEFT_SLICE_AZIMUTHS};
        slices->light[i] = weft_direction_of_angles(angles);
    }
}

/* ---- Values ---- */

const weft_rgb *weft_slices_values(const weft_slices *slices, int row, int view)
{
    return slices->brdf + (size_t)(row * slices->view_count + view) * WEFT_SLICE_LIGHTS;
}

static weft_code evaluate(const weft_contenders *contenders, const weft_progress *progress, weft_slices *slices,
                          weft_error *error)
{
    weft_rgb *brdf = slices->brdf;
    long total = (long)slices->row_count * slices->view_count, done = 0;
    for (int row = 0; row < slices->row_count; row++) {
        for (int view = 0; view < slices->view_count; view++) {
            for (int light = 0; light < WEFT_SLICE_LIGHTS; light++)
                WEFT_TRY(weft_contender_brdf(&contenders->contender[row], slices->light[light], slices->view[view],
                                             brdf++, error));
            weft_progress_report(progress, "BRDF slices", ++done, total);
        }
    }
    return WEFT_OK;
}

weft_code weft_slices_make(const weft_dataset_layout *layout, const weft_contenders *contenders,
                           const weft_progress *progress, weft_slices *slices, weft_error *error)
{
    *slices = (weft_slices){.row_count = contenders->count};
    if (layout->image_count < MIN_IMAGES)
        return WEFT_OK;
    choose_views(layout, slices);
    slices->largest_theta_rad = largest_theta(layout);
    place_lights(slices);
    for (int row = 0; row < slices->row_count; row++)
        slices->name[row] = contenders->contender[row].name;
    size_t values = (size_t)slices->row_count * (size_t)slices->view_count * WEFT_SLICE_LIGHTS;
    slices->brdf = malloc(values * sizeof *slices->brdf);
    if (!slices->brdf)
        return weft_fail_memory(error, "BRDF slices", values * sizeof *slices->brdf);
    weft_code code = evaluate(contenders, progress, slices, error);
    if (code != WEFT_OK)
        weft_slices_free(slices);
    return code;
}

void weft_slices_free(weft_slices *slices)
{
    free(slices->brdf);
    *slices = (weft_slices){0};
}

/* ---- Between the directions ---- */

static weft_rgb mixed(weft_rgb a, weft_rgb b, double t)
{
    return (weft_rgb){a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

/* On a ring (0 is the normal), between its azimuths. */
static weft_rgb on_ring(const weft_rgb *value, int ring, double azimuth)
{
    int before = (int)azimuth % WEFT_SLICE_AZIMUTHS, after = (before + 1) % WEFT_SLICE_AZIMUTHS;
    if (ring == 0)
        return value[0];
    const weft_rgb *first = value + 1 + (ring - 1) * WEFT_SLICE_AZIMUTHS;
    return mixed(first[before], first[after], azimuth - floor(azimuth));
}

weft_rgb weft_slices_at(const weft_slices *slices, int row, int view, double x, double y)
{
    const double slack = 1e-9;
    double theta = asin(fmin(hypot(x, y), 1)), turn = atan2(y, x) / (2 * WEFT_PI);
    double ring = theta / slices->largest_theta_rad * WEFT_SLICE_RINGS, azimuth = turn * WEFT_SLICE_AZIMUTHS;
    if (!(ring <= WEFT_SLICE_RINGS + slack) || hypot(x, y) > 1)
        return (weft_rgb){NAN, NAN, NAN};
    if (azimuth < 0)
        azimuth += WEFT_SLICE_AZIMUTHS;
    const weft_rgb *value = weft_slices_values(slices, row, view);
    int inner = (int)fmin(ring, WEFT_SLICE_RINGS - 1);
    return mixed(on_ring(value, inner, azimuth), on_ring(value, inner + 1, azimuth), ring - inner);
}

weft_code weft_slices_picture(const weft_slices *slices, int row, int size, weft_image *image, uint8_t *mask,
                              weft_error *error)
{
    WEFT_TRY(weft_image_create(size * slices->view_count, size, image, error));
    for (int i = 0; i < image->width * size; i++) {
        int column = i % image->width;
        double x = 2 * (column % size + 0.5) / size - 1, y = 1 - 2 * (i / image->width + 0.5) / size;
        weft_rgb value = weft_slices_at(slices, row, column / size, x, y);
        bool missing = isnan(value.r);
        float *pixel = image->pixels + 3 * (size_t)i;
        pixel[0] = missing ? 0 : (float)(WEFT_PI * value.r);
        pixel[1] = missing ? 0 : (float)(WEFT_PI * value.g);
        pixel[2] = missing ? 0 : (float)(WEFT_PI * value.b);
        if (mask)
            mask[i] = missing;
    }
    return WEFT_OK;
}

/* ---- Numbers ---- */

static void print_table(const weft_slices *slices, FILE *table)
{
    fputs("lx,ly,lz,vx,vy,vz", table);
    for (int row = 0; row < slices->row_count; row++)
        fprintf(table, ",%s_r,%s_g,%s_b", slices->name[row], slices->name[row], slices->name[row]);
    fputc('\n', table);
    for (int i = 0; i < slices->view_count * WEFT_SLICE_LIGHTS; i++) {
        weft_vec3 view = slices->view[i / WEFT_SLICE_LIGHTS], light = slices->light[i % WEFT_SLICE_LIGHTS];
        fprintf(table, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", light.x, light.y, light.z, view.x, view.y, view.z);
        for (int row = 0; row < slices->row_count; row++) {
            weft_rgb value = slices->brdf[(size_t)(row * slices->view_count) * WEFT_SLICE_LIGHTS + (size_t)i];
            fprintf(table, ",%.9g,%.9g,%.9g", value.r, value.g, value.b);
        }
        fputc('\n', table);
    }
}

weft_code weft_slices_write(const weft_slices *slices, const char *path, weft_error *error)
{
    char *bytes = NULL;
    size_t size = 0;
    FILE *table = open_memstream(&bytes, &size);
    if (!table)
        return weft_fail_memory(error, "table", 0);
    print_table(slices, table);
    weft_code code =
        fclose(table) == 0 ? weft_write_file(path, bytes, size, error) : weft_fail_memory(error, "table", size);
    free(bytes);
    return code;
}

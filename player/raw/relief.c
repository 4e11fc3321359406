#include "player/raw/relief.h"

#include "reflectance/relief/relief.h"

#include <math.h>
#include <stdlib.h>

/* The views that have a tile, in the order of the tiles. */
static int tiled_views(const weft_raw_images *images, const weft_dataset_layout *layout, weft_vec3 *view)
{
    int count = 0;
    for (int v = 0; v < images->view_count; v++)
        if (images->first_of_view[v] < images->first_of_view[v + 1])
            view[count++] = layout->view[v];
    return count;
}

static weft_code allocate(weft_raw_relief *relief, weft_error *error)
{
    size_t places = (size_t)relief->width * (size_t)relief->height, views = (size_t)relief->view_count;
    relief->share = malloc(places * sizeof *relief->share);
    relief->seen = malloc(places * views);
    relief->slope = malloc(2 * views * sizeof *relief->slope);
    return relief->share && relief->seen && relief->slope ? WEFT_OK
                                                          : weft_fail_memory(error, "heights", places * views);
}

static void fill(const weft_height_field *field, const weft_vec3 *view, weft_raw_relief *relief)
{
    size_t places = (size_t)field->width * (size_t)field->height;
    float range = field->high - field->low, scale = range > 0 ? 65535 / range : 0;
    for (size_t i = 0; i < places; i++)
        relief->share[i] = (uint16_t)lroundf((field->value[i] - field->low) * scale);
#pragma omp parallel for schedule(dynamic)
    for (int v = 0; v < relief->view_count; v++) {
        weft_real slope[2];
        weft_relief_slope(field, view[v], slope);
        relief->slope[2 * v] = (float)slope[0];
        relief->slope[2 * v + 1] = (float)slope[1];
        weft_relief_see(field, view[v], relief->seen + (size_t)v * places);
    }
}

static weft_code make(const weft_height_field *field, const weft_vec3 *view, int view_count, weft_raw_relief *relief,
                      weft_error *error)
{
    relief->width = field->width;
    relief->height = field->height;
    relief->view_count = view_count;
    relief->range_mm[0] = (double)field->low;
    relief->range_mm[1] = (double)field->high;
    relief->size_mm[0] = field->width_mm;
    relief->size_mm[1] = field->height_mm;
    WEFT_TRY(allocate(relief, error));
    fill(field, view, relief);
    return WEFT_OK;
}

weft_code weft_raw_relief_make(weft_dataset *dataset, const weft_raw_images *images, weft_raw_relief *relief,
                               weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_dataset_heights heights;
    *relief = (weft_raw_relief){0};
    WEFT_TRY(weft_dataset_read_surface(dataset, &heights, error));
    if (!heights.value)
        return WEFT_OK;
    weft_vec3 *view = malloc((size_t)layout->view_count * sizeof *view);
    double size_mm[2];
    weft_dataset_size_mm(layout, size_mm);
    weft_height_field field =
        weft_height_field_of(heights.value, heights.width, heights.height, size_mm[0], size_mm[1]);
    weft_code code = WEFT_OK;
    if (!view)
        code = weft_fail_memory(error, "views", (size_t)layout->view_count * sizeof *view);
    else
        code = make(&field, view, tiled_views(images, layout, view), relief, error);
    relief->level_count = heights.level_count;
    free(view);
    weft_dataset_heights_free(&heights);
    if (code != WEFT_OK)
        weft_raw_relief_free(relief);
    return code;
}

void weft_raw_relief_free(weft_raw_relief *relief)
{
    free(relief->share);
    free(relief->seen);
    free(relief->slope);
    *relief = (weft_raw_relief){0};
}

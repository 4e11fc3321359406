#include "evaluate/raw_directions.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* ---- Order ---- */

static bool is_held_out(const uint8_t *held_out, int image)
{
    return held_out && held_out[image];
}

static void sort_images(const weft_dataset_layout *layout, const uint8_t *held_out, weft_view_order *order)
{
    for (int i = 0; i < layout->image_count; i++)
        order->first[layout->view_of_image[i] + 1] += !is_held_out(held_out, i);
    for (int v = 0; v < layout->view_count; v++)
        order->first[v + 1] += order->first[v];
    int kept = order->first[layout->view_count];
    /* Filling backwards from the end of every view moves that end to its start, one place too far up in the array. */
    for (int i = layout->image_count - 1; i >= 0; i--) {
        if (!is_held_out(held_out, i))
            order->image[--order->first[layout->view_of_image[i] + 1]] = i;
    }
    memmove(order->first, order->first + 1, (size_t)layout->view_count * sizeof *order->first);
    order->first[layout->view_count] = kept;
}

weft_code weft_view_order_create(const weft_dataset_layout *layout, const uint8_t *held_out, weft_view_order *order,
                                 weft_error *error)
{
    size_t images = (size_t)layout->image_count, views = (size_t)layout->view_count;
    *order = (weft_view_order){calloc(views + 1, sizeof *order->first), malloc(images * sizeof *order->image)};
    if (!order->first || !order->image) {
        weft_view_order_free(order);
        return weft_fail_memory(error, "images", (images + views) * sizeof *order->image);
    }
    sort_images(layout, held_out, order);
    return WEFT_OK;
}

void weft_view_order_free(weft_view_order *order)
{
    free(order->first);
    free(order->image);
    *order = (weft_view_order){0};
}

/* ---- Directions ---- */

static weft_code triangulate_views(const weft_dataset_layout *layout, const weft_view_order *order, int x, int y,
                                   weft_vec3 *scratch, weft_raw_directions *directions, weft_error *error)
{
    int count = 0;
    for (int v = 0; v < layout->view_count; v++) {
        if (order->first[v + 1] == order->first[v])
            continue;
        scratch[count] = weft_dataset_view_direction(layout, v, x, y);
        directions->view_of[count++] = v;
    }
    return count > 0 ? weft_triangulation_build(scratch, count, &directions->views, error) : WEFT_OK;
}

/* The lights of the images of a view, as a texel sees them; returns how many. */
static int collect_lights(const weft_dataset_layout *layout, const weft_view_order *order, int view, int x, int y,
                          weft_vec3 *light)
{
    int count = order->first[view + 1] - order->first[view];
    for (int i = 0; i < count; i++)
        light[i] = weft_dataset_light_direction(layout, order->image[order->first[view] + i], x, y);
    return count;
}

static bool same_lights(const weft_vec3 *a, const weft_vec3 *b, int count)
{
    for (int i = 0; i < count; i++) {
        if (a[i].x != b[i].x || a[i].y != b[i].y || a[i].z != b[i].z)
            return false;
    }
    return true;
}

/* Views that were lit alike one after the other share their triangles. `scratch` [2][image_count]. */
static weft_code triangulate_lights(const weft_dataset_layout *layout, const weft_view_order *order, int x, int y,
                                    weft_vec3 *scratch, weft_raw_directions *directions, weft_error *error)
{
    weft_vec3 *light = scratch, *before = scratch + layout->image_count;
    int before_count = 0;
    weft_triangulation *shared = NULL;
    for (int v = 0; v < layout->view_count; v++) {
        int count = collect_lights(layout, order, v, x, y, light);
        if (count == 0)
            continue;
        if (count != before_count || !same_lights(light, before, count))
            WEFT_TRY(weft_triangulation_build(light, count, &shared, error));
        directions->lights[v] = shared;
        before_count = count;
        weft_vec3 *other = light;
        light = before;
        before = other;
    }
    return WEFT_OK;
}

weft_code weft_raw_directions_create(const weft_dataset_layout *layout, const weft_view_order *order, int x, int y,
                                     weft_raw_directions *directions, weft_error *error)
{
    size_t most = (size_t)(layout->image_count > layout->view_count ? layout->image_count : layout->view_count);
    *directions = (weft_raw_directions){.view_count = layout->view_count,
                                        .view_of = calloc((size_t)layout->view_count, sizeof *directions->view_of),
                                        .lights = calloc((size_t)layout->view_count, sizeof *directions->lights)};
    weft_vec3 *scratch = malloc(2 * most * sizeof *scratch);
    weft_code code = WEFT_OK;
    if (!directions->view_of || !directions->lights || !scratch)
        code = weft_fail_memory(error, "directions", 2 * most * sizeof *scratch);
    if (code == WEFT_OK)
        code = triangulate_views(layout, order, x, y, scratch, directions, error);
    if (code == WEFT_OK)
        code = triangulate_lights(layout, order, x, y, scratch, directions, error);
    free(scratch);
    if (code != WEFT_OK)
        weft_raw_directions_free(directions);
    return code;
}

void weft_raw_directions_free(weft_raw_directions *directions)
{
    weft_triangulation_free(directions->views);
    weft_triangulation *freed = NULL;
    for (int v = 0; directions->lights && v < directions->view_count; v++) {
        if (directions->lights[v] && directions->lights[v] != freed)
            weft_triangulation_free(directions->lights[v]);
        freed = directions->lights[v] ? directions->lights[v] : freed;
    }
    free(directions->lights);
    free(directions->view_of);
    *directions = (weft_raw_directions){0};
}

/* ---- Interpolation ---- */

weft_raw_stencil weft_raw_stencil_of(const weft_raw_directions *directions, const weft_view_order *order,
                                     weft_vec3 light, weft_vec3 view)
{
    weft_raw_stencil stencil = {0};
    if (!directions->views)
        return stencil;
    weft_barycentric views = weft_triangulation_lookup(directions->views, view);
    for (int i = 0; i < 3; i++) {
        if (views.index[i] < 0)
            continue;
        int v = directions->view_of[views.index[i]];
        weft_barycentric lights = weft_triangulation_lookup(directions->lights[v], light);
        for (int k = 0; k < 3; k++) {
            double weight = (double)(views.weight[i] * lights.weight[k]);
            if (lights.index[k] < 0 || !(weight > 0))
                continue;
            stencil.image[stencil.count] = order->image[order->first[v] + lights.index[k]];
            stencil.weight[stencil.count++] = weight;
        }
    }
    return stencil;
}

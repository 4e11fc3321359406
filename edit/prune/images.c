#include "edit/prune/steps.h"

#include "btf/direction/square_map.h"

#include <stdlib.h>
#include <string.h>

static weft_vec3 direction_at(const float *xyz, size_t index)
{
    return weft_vec3_of(xyz[3 * index], xyz[3 * index + 1], xyz[3 * index + 2]);
}

/* ---- Which images ---- */

/* Cells of the coarser square within an angle of a direction. */
typedef struct cell_list {
    int count;
    int cell[WEFT_VISIBILITY_PAIR_CELLS];
} cell_list;

static weft_vec3 middle_of(int cell)
{
    double a = 2 * ((cell % WEFT_VISIBILITY_PAIR_SIDE + 0.5) / WEFT_VISIBILITY_PAIR_SIDE - 0.5);
    double b = 2 * ((int)(cell / WEFT_VISIBILITY_PAIR_SIDE) + 0.5) / WEFT_VISIBILITY_PAIR_SIDE - 1,
           square = a * a + b * b;
    return weft_vec3_of(2 * a / (1 + square), 2 * b / (1 + square), (1 - square) / (1 + square));
}

/* Half the diagonal of a cell, where the square shrinks most. */
static const double cell_radius = 4 * 0.7071067811865476 / WEFT_VISIBILITY_PAIR_SIDE;

static void list_cells(weft_vec3 direction, double margin_rad, cell_list *list)
{
    double least = cos(fmin(margin_rad + cell_radius, WEFT_PI));
    list->count = 0;
    for (int cell = 0; cell < WEFT_VISIBILITY_PAIR_CELLS; cell++)
        if (weft_dot(middle_of(cell), direction) >= least)
            list->cell[list->count++] = cell;
}

/* What a map over the lights of a view is of: the light, or the half vector. Unit. */
static weft_vec3 inner_direction(const weft_components *components, weft_vec3 light, weft_vec3 view)
{
    return weft_components_are_over_half_vector(components->kind) ? weft_unit(weft_add(light, view)) : light;
}

/* Keeps the images of a view within an angle of `reached` in its map. */
static void keep_near(const weft_components *components, int view, const weft_vec3 *inner, weft_vec3 reached,
                      double least, bool *kept)
{
    for (uint32_t i = components->first[view]; i < components->first[view + 1]; i++)
        kept[i] |= weft_dot(reached, inner[i]) >= least;
}

/* Those that a pair of the visibility reaches which has a view within the margin, too. */
static void find_of_view(const weft_visibility *visibility, const weft_components *components, int view,
                         double margin_rad, const weft_vec3 *inner, cell_list *list, bool *kept)
{
    double least = cos(fmin(margin_rad + cell_radius, WEFT_PI));
    list_cells(direction_at(components->view, (size_t)view), margin_rad, list);
    for (int v = 0; v < list->count; v++) {
        const uint8_t *row = visibility->pair + (size_t)list->cell[v] * WEFT_VISIBILITY_PAIR_CELLS;
        weft_vec3 from = middle_of(list->cell[v]);
        for (int l = 0; l < WEFT_VISIBILITY_PAIR_CELLS; l++)
            if (row[l])
                keep_near(components, view, inner, inner_direction(components, middle_of(l), from), least, kept);
    }
}

/* inner [image_count] */
static void find_inner(const weft_components *components, weft_vec3 *inner)
{
    for (int view = 0; view < components->view_count; view++)
        for (uint32_t i = components->first[view]; i < components->first[view + 1]; i++)
            inner[i] = inner_direction(components, direction_at(components->light, i),
                                       direction_at(components->view, (size_t)view));
}

weft_code weft_prune_find_images(const weft_visibility *visibility, const weft_components *components,
                                 double margin_rad, bool *kept, int *kept_count, weft_error *error)
{
    size_t images = (size_t)components->image_count;
    cell_list *list = calloc(1, sizeof *list);
    weft_vec3 *inner = malloc(images * sizeof *inner);
    weft_code code = list && inner ? WEFT_OK : weft_fail_memory(error, "images", images * sizeof *inner);
    if (code == WEFT_OK) {
        find_inner(components, inner);
        memset(kept, 0, images * sizeof *kept);
        for (int view = 0; view < components->view_count; view++)
            find_of_view(visibility, components, view, margin_rad, inner, list, kept);
        *kept_count = 0;
        for (size_t i = 0; i < images; i++)
            *kept_count += kept[i];
    }
    free(list);
    free(inner);
    return code;
}

/* ---- What the others become ---- */

/* The kept image of a view that is nearest in its map, or -1. */
static long nearest_image(const weft_components *components, const bool *kept, int view, weft_vec3 light)
{
    long nearest = -1;
    double most = -2;
    weft_vec3 v = direction_at(components->view, (size_t)view), inner = inner_direction(components, light, v);
    for (uint32_t i = components->first[view]; i < components->first[view + 1]; i++) {
        double cosine = weft_dot(inner_direction(components, direction_at(components->light, i), v), inner);
        if (kept[i] && cosine > most) {
            most = cosine;
            nearest = i;
        }
    }
    return nearest;
}

static bool has_kept(const weft_components *components, const bool *kept, int view)
{
    return memchr(kept + components->first[view], 1, components->first[view + 1] - components->first[view]) != NULL;
}

static int nearest_view(const weft_components *components, const bool *kept, int view)
{
    int nearest = -1;
    double most = -2;
    weft_vec3 from = direction_at(components->view, (size_t)view);
    for (int i = 0; i < components->view_count; i++) {
        double cosine = weft_dot(direction_at(components->view, (size_t)i), from);
        if (cosine > most && has_kept(components, kept, i)) {
            most = cosine;
            nearest = i;
        }
    }
    return nearest;
}

void weft_prune_fill_images(const bool *kept, weft_components *components)
{
    size_t row = 3 * (size_t)components->component_count;
    for (int view = 0; view < components->view_count; view++) {
        int from = nearest_view(components, kept, view);
        for (uint32_t i = components->first[view]; from >= 0 && i < components->first[view + 1]; i++) {
            long source = kept[i] ? (long)i : nearest_image(components, kept, from, direction_at(components->light, i));
            if (source != (long)i)
                memcpy(components->value + i * row, components->value + (size_t)source * row,
                       row * sizeof *components->value);
        }
    }
}

/* ---- Fewer components ---- */

weft_code weft_prune_copy_components(const weft_components *from, int count, weft_components **copy, weft_error *error)
{
    weft_components shape = *from;
    shape.component_count = count;
    WEFT_TRY(
        weft_components_create(&shape, from->level[0].width, from->level[0].height, from->level_count, copy, error));
    weft_components *to = *copy;
    size_t views = (size_t)from->view_count, images = (size_t)from->image_count, row = 3 * (size_t)count;
    memcpy(to->view, from->view, 3 * views * sizeof *to->view);
    memcpy(to->light, from->light, 3 * images * sizeof *to->light);
    memcpy(to->first, from->first, (views + 1) * sizeof *to->first);
    memcpy(to->scale, from->scale, (size_t)count * sizeof *to->scale);
    memcpy(to->length, from->length, (size_t)count * sizeof *to->length);
    memcpy(to->nugget, from->nugget, (size_t)count * sizeof *to->nugget);
    for (size_t i = 0; i < images; i++)
        memcpy(to->value + i * row, from->value + i * 3 * (size_t)from->component_count, row * sizeof *to->value);
    for (int k = 0; k < from->level_count; k++) {
        const weft_components_level *level = &from->level[k];
        memcpy(to->level[k].coefficient, level->coefficient,
               (size_t)count * (size_t)level->width * (size_t)level->height);
        memcpy(to->level[k].ceiling, level->ceiling, weft_ceiling_count(level->width, level->height));
        memcpy(to->level[k].floor, level->floor, 3 * weft_ceiling_count(level->width, level->height));
    }
    return WEFT_OK;
}

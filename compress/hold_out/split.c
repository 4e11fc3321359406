#include "compress/hold_out/split.h"

#include "base/integers.h"
#include "btf/direction/direction.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum {
    SHARE = 10,             /* one in so many is held out */
    FEWEST_DIRECTIONS = 10, /* fewer views, or lights, are all fitted */
    IMAGES_A_VIEW = 4,      /* of a grid, at least, on average */
    LAST_INNER_RING = 4     /* 60 degrees */
};

/* Held out together. With the 8 of 41 x 41 the figure of a denim changed by 5 to 9 % from split to split, with the 12
 * of 64 x 64 that of a satin by 3 %. */
enum { ENOUGH_DIRECTIONS = 10 };

/* ---- Directions in order ---- */

/* A direction among others: its ring, and where on it. */
typedef struct ringed {
    int index, ring;
    double azimuth;
} ringed;

static int compare_ringed(const void *left, const void *right)
{
    const ringed *a = left, *b = right;
    if (a->ring != b->ring)
        return a->ring - b->ring;
    if (a->azimuth != b->azimuth)
        return a->azimuth < b->azimuth ? -1 : 1;
    return a->index - b->index;
}

/* Ring by ring, each by azimuth: [count]. */
static ringed *sort_directions(const weft_vec3 *direction, int count)
{
    ringed *order = calloc((size_t)count, sizeof *order);
    for (int i = 0; order && i < count; i++) {
        weft_angles angles = weft_angles_of_direction(direction[i]);
        order[i] = (ringed){i, weft_ubo81_ring(angles.theta_rad), (double)angles.phi_rad};
    }
    if (order)
        qsort(order, (size_t)count, sizeof *order, compare_ringed);
    return order;
}

/* Moves the first and the last of the candidates inwards, so that all of them lie between others; as they were where
 * fewer than `wanted` would be left. */
static void keep_inner(const ringed *order, int *first, int *end, int wanted)
{
    int inner = weft_smaller(LAST_INNER_RING, order[*end - 1].ring - 1), from = *first, to = *end;
    while (from < to && order[from].ring < 1)
        from++;
    while (to > from && order[to - 1].ring > inner)
        to--;
    if (to - from < wanted)
        return;
    *first = from;
    *end = to;
}

/* Some directions of a hemisphere, in classes of which a split holds out one: every class_count-th of the candidates in
 * order, so that a class has its share of every ring and goes around it. */
typedef struct direction_classes {
    ringed *order;
    int first, end, class_count;
} direction_classes;

static weft_code sort_into_classes(const weft_vec3 *direction, int count, direction_classes *classes, weft_error *error)
{
    int wanted = (count + SHARE / 2) / SHARE;
    *classes = (direction_classes){.order = sort_directions(direction, count), .end = count};
    if (!classes->order)
        return weft_fail_memory(error, "directions", (size_t)count * sizeof *classes->order);
    keep_inner(classes->order, &classes->first, &classes->end, wanted);
    classes->class_count = (classes->end - classes->first + wanted - 1) / wanted;
    return WEFT_OK;
}

/* Marks the directions of a class in held [count of all]; returns how many. */
static int hold_class(const direction_classes *classes, uint64_t number, uint8_t *held)
{
    int wanted = (int)(number % (uint64_t)classes->class_count), count = 0;
    for (int i = classes->first + wanted; i < classes->end; i += classes->class_count, count++)
        held[classes->order[i].index] = 1;
    return count;
}

/* ---- Grids ---- */

/* What a dataset looks like from its centre. */
typedef struct grid {
    weft_vec3 *view, *light; /* [view_count], [image_count] */
    weft_vec3 *distinct;     /* [light_count] of the fullest view */
    int *light_of;           /* [image_count] index into distinct */
    int light_count;
} grid;

static void free_grid(grid *g)
{
    free(g->view);
    free(g->light);
    free(g->distinct);
    free(g->light_of);
}

static int find_fullest_view(const weft_dataset_layout *layout, int *images)
{
    int fullest = 0;
    for (int i = 0; i < layout->image_count; i++)
        images[layout->view_of_image[i]]++;
    for (int view = 1; view < layout->view_count; view++)
        fullest = images[view] > images[fullest] ? view : fullest;
    return fullest;
}

static int nearest_light(const grid *g, weft_vec3 light)
{
    int nearest = 0;
    for (int i = 1; i < g->light_count; i++) {
        if (weft_dot(g->distinct[i], light) > weft_dot(g->distinct[nearest], light))
            nearest = i;
    }
    return nearest;
}

static void label_lights(const weft_dataset_layout *layout, int fullest, grid *g)
{
    for (int i = 0; i < layout->image_count; i++) {
        if (layout->view_of_image[i] == fullest)
            g->distinct[g->light_count++] = g->light[i];
    }
    for (int i = 0; i < layout->image_count; i++)
        g->light_of[i] = nearest_light(g, g->light[i]);
}

static weft_code look_at(const weft_dataset_layout *layout, grid *g, weft_error *error)
{
    size_t images = (size_t)layout->image_count, views = (size_t)layout->view_count;
    *g = (grid){.view = calloc(views, sizeof *g->view),
                .light = calloc(images, sizeof *g->light),
                .distinct = calloc(images, sizeof *g->distinct),
                .light_of = calloc(images, sizeof *g->light_of)};
    int *uses = calloc(views, sizeof *uses);
    if (!g->view || !g->light || !g->distinct || !g->light_of || !uses) {
        free(uses);
        return weft_fail_memory(error, "directions", images * 2 * sizeof *g->light);
    }
    int x = layout->width / 2, y = layout->height / 2;
    for (int view = 0; view < layout->view_count; view++)
        g->view[view] = weft_dataset_view_direction(layout, view, x, y);
    for (int i = 0; i < layout->image_count; i++)
        g->light[i] = weft_dataset_light_direction(layout, i, x, y);
    label_lights(layout, find_fullest_view(layout, uses), g);
    free(uses);
    return WEFT_OK;
}

static weft_code allocate(int most, weft_splits *splits, weft_error *error)
{
    splits->count = most;
    splits->held = calloc((size_t)most * (size_t)splits->image_count, 1);
    return splits->held ? WEFT_OK : weft_fail_memory(error, "splits", (size_t)most * (size_t)splits->image_count);
}

/* Views and lights of one split; half the classes lie between them, so that a light is not held out beside the view
 * from the same direction. */
static void hold_directions(const weft_dataset_layout *layout, const grid *g, const direction_classes *views,
                            const direction_classes *lights, uint64_t number, uint8_t *scratch, weft_splits *splits,
                            uint8_t *held)
{
    uint8_t *view_held = scratch, *light_held = scratch + layout->view_count;
    memset(scratch, 0, (size_t)layout->view_count + (size_t)g->light_count);
    if (views->class_count > 0)
        splits->view_held_count = hold_class(views, number, view_held);
    if (lights->class_count > 0)
        splits->light_held_count = hold_class(lights, number + (uint64_t)lights->class_count / 2, light_held);
    for (int i = 0; i < layout->image_count; i++)
        held[i] = (uint8_t)((view_held[layout->view_of_image[i]] ? WEFT_HELD_VIEW : 0) |
                            (light_held[g->light_of[i]] ? WEFT_HELD_LIGHT : 0));
}

static weft_code split_grid(const weft_dataset_layout *layout, const grid *g, uint64_t seed, int most,
                            weft_splits *splits, weft_error *error)
{
    direction_classes views = {0}, lights = {0};
    weft_code code = WEFT_OK;
    if (layout->view_count >= FEWEST_DIRECTIONS)
        code = sort_into_classes(g->view, layout->view_count, &views, error);
    if (code == WEFT_OK && g->light_count >= FEWEST_DIRECTIONS)
        code = sort_into_classes(g->distinct, g->light_count, &lights, error);
    int count = weft_smaller(most, views.class_count > 0 ? views.class_count : most);
    count = weft_smaller(count, lights.class_count > 0 ? lights.class_count : most);
    uint8_t *scratch = malloc((size_t)layout->view_count + (size_t)g->light_count);
    if (code == WEFT_OK && !scratch)
        code = weft_fail_memory(error, "splits", (size_t)layout->view_count);
    if (code == WEFT_OK)
        code = allocate(count, splits, error);
    splits->light_count = g->light_count;
    for (int s = 0; code == WEFT_OK && s < count; s++)
        hold_directions(layout, g, &views, &lights, seed + (uint64_t)s, scratch, splits,
                        splits->held + (size_t)s * (size_t)layout->image_count);
    free(scratch);
    free(views.order);
    free(lights.order);
    return code;
}

/* ---- Lists ---- */

/* Images in the order of the half vectors of view and light, every tenth of them. */
static weft_code split_list(const weft_dataset_layout *layout, const grid *g, uint64_t seed, int most,
                            weft_splits *splits, weft_error *error)
{
    weft_vec3 *half = calloc((size_t)layout->image_count, sizeof *half);
    if (!half)
        return weft_fail_memory(error, "directions", (size_t)layout->image_count * sizeof *half);
    for (int i = 0; i < layout->image_count; i++)
        half[i] = weft_unit(weft_add(g->view[layout->view_of_image[i]], g->light[i]));
    direction_classes all = {
        .order = sort_directions(half, layout->image_count), .end = layout->image_count, .class_count = SHARE};
    free(half);
    if (!all.order)
        return weft_fail_memory(error, "directions", (size_t)layout->image_count * sizeof *all.order);
    weft_code code = allocate(weft_smaller(most, SHARE), splits, error);
    for (int s = 0; code == WEFT_OK && s < splits->count; s++) {
        uint8_t *held = splits->held + (size_t)s * (size_t)layout->image_count;
        hold_class(&all, seed + (uint64_t)s, held);
        for (int i = 0; i < layout->image_count; i++)
            held[i] = held[i] ? WEFT_HELD_IMAGE : 0;
    }
    free(all.order);
    return code;
}

static weft_code split_each(weft_splits *splits, weft_error *error)
{
    WEFT_TRY(allocate(splits->image_count, splits, error));
    for (int i = 0; i < splits->image_count; i++)
        splits->held[(size_t)i * (size_t)splits->image_count + (size_t)i] = WEFT_HELD_IMAGE;
    return WEFT_OK;
}

/* ---- All of it ---- */

static weft_code split_many(const weft_dataset_layout *layout, uint64_t seed, int most, weft_splits *splits,
                            weft_error *error)
{
    grid g;
    weft_code code = look_at(layout, &g, error);
    bool dense = layout->image_count >= IMAGES_A_VIEW * layout->view_count;
    bool is_grid = dense && (layout->view_count >= FEWEST_DIRECTIONS || g.light_count >= FEWEST_DIRECTIONS);
    splits->kind = is_grid ? WEFT_SPLIT_DIRECTIONS : WEFT_SPLIT_PHOTOGRAPHS;
    if (code == WEFT_OK && is_grid)
        code = split_grid(layout, &g, seed, most, splits, error);
    else if (code == WEFT_OK)
        code = split_list(layout, &g, seed, most, splits, error);
    free_grid(&g);
    return code;
}

weft_code weft_splits_create(const weft_dataset_layout *layout, uint64_t seed, int most, weft_splits *splits,
                             weft_error *error)
{
    *splits =
        (weft_splits){.kind = WEFT_SPLIT_EACH, .image_count = layout->image_count, .view_count = layout->view_count};
    if (layout->image_count < 2)
        return weft_fail(error, WEFT_BAD_USAGE, "one image alone: none can be held out");
    weft_code code = layout->image_count < WEFT_SPLIT_EACH_LIMIT ? split_each(splits, error)
                                                                 : split_many(layout, seed, most, splits, error);
    if (code != WEFT_OK)
        weft_splits_free(splits);
    return code;
}

void weft_splits_free(weft_splits *splits)
{
    free(splits->held);
    *splits = (weft_splits){0};
}

const uint8_t *weft_splits_held(const weft_splits *splits, int split)
{
    return splits->held + (size_t)split * (size_t)splits->image_count;
}

/* ---- How often ---- */

weft_code weft_hold_out_enough_splits(const weft_dataset_layout *layout, int *count, weft_error *error)
{
    weft_splits splits;
    WEFT_TRY(weft_splits_create(layout, 0, 2 * WEFT_HOLD_OUT_ENOUGH, &splits, error));
    int held = weft_larger(1, splits.view_held_count + splits.light_held_count),
        most = weft_smaller(splits.count / 2, WEFT_HOLD_OUT_ENOUGH);
    bool is_grid = splits.kind == WEFT_SPLIT_DIRECTIONS;
    *count = is_grid ? weft_larger(1, weft_smaller((ENOUGH_DIRECTIONS + held - 1) / held, most)) : 1;
    weft_splits_free(&splits);
    return WEFT_OK;
}

/* Where the images of a dataset were lit and seen from, as a texel sees it, ready for interpolation. */
#ifndef WEFT_EVALUATE_RAW_DIRECTIONS_H
#define WEFT_EVALUATE_RAW_DIRECTIONS_H

#include "btf/dataset/dataset.h"
#include "btf/direction/triangulation.h"

/* The images view by view; freed with weft_view_order_free. */
typedef struct weft_view_order {
    int *first; /* [view_count + 1] into image */
    int *image; /* sorted by view */
} weft_view_order;

/* Images with held_out[image] != 0 (NULL: none) are left out. Errors: WEFT_SYSTEM for memory. */
weft_code weft_view_order_create(const weft_dataset_layout *layout, const uint8_t *held_out, weft_view_order *order,
                                 weft_error *error);
void weft_view_order_free(weft_view_order *order);

/* Freed with weft_raw_directions_free. */
typedef struct weft_raw_directions {
    int view_count;
    int *view_of;                /* by index into views: only views with images are among them */
    weft_triangulation *views;   /* NULL where no view has any */
    weft_triangulation **lights; /* [view_count] of the images of a view, in their order, those of views in a
                                    row that were lit alike one and the same; NULL for a view without any */
} weft_raw_directions;

/* As texel (x, y) sees them; in a far dataset all texels see the same. Errors: WEFT_SYSTEM for memory. */
weft_code weft_raw_directions_create(const weft_dataset_layout *layout, const weft_view_order *order, int x, int y,
                                     weft_raw_directions *directions, weft_error *error);
void weft_raw_directions_free(weft_raw_directions *directions);

enum { WEFT_RAW_STENCIL = 9 };

/* The images that interpolation takes for a light and a view, with their barycentric weights (> 0, sum 1 where there is
 * any image): those of the three nearest lights in each of the three nearest views. */
typedef struct weft_raw_stencil {
    int count;
    int image[WEFT_RAW_STENCIL];
    double weight[WEFT_RAW_STENCIL];
} weft_raw_stencil;

/* Thread-safe. */
weft_raw_stencil weft_raw_stencil_of(const weft_raw_directions *directions, const weft_view_order *order,
                                     weft_vec3 light, weft_vec3 view);

#endif

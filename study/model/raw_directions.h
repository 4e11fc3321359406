/* Where the images of a dataset were lit and seen from, as a texel sees it, ready for interpolation. */
#ifndef WEFT_STUDY_MODEL_RAW_DIRECTIONS_H
#define WEFT_STUDY_MODEL_RAW_DIRECTIONS_H

#include "btf/dataset/dataset.h"
#include "btf/direction/triangulation.h"

/* The images view by view; freed with weft_view_order_free. */
typedef struct weft_view_order {
    int *first; /* [view_count + 1] into image */
    int *image; /* [image_count] sorted by view */
} weft_view_order;

/* Errors: WEFT_SYSTEM for memory. */
weft_code weft_view_order_create(const weft_dataset_layout *layout, weft_view_order *order, weft_error *error);
void weft_view_order_free(weft_view_order *order);

/* Freed with weft_raw_directions_free. */
typedef struct weft_raw_directions {
    int view_count;
    weft_triangulation *views;
    weft_triangulation **lights; /* [view_count] of the images of a view, in their order; NULL for a view without any */
} weft_raw_directions;

/* As texel (x, y) sees them; in a far dataset all texels see the same. Errors: WEFT_SYSTEM for memory. */
weft_code weft_raw_directions_create(const weft_dataset_layout *layout, const weft_view_order *order, int x, int y,
                                     weft_raw_directions *directions, weft_error *error);
void weft_raw_directions_free(weft_raw_directions *directions);

#endif

/* Which images of a dataset a fit must not see, so that its error can be measured where it was not fitted. */
#ifndef WEFT_COMPRESS_HOLD_OUT_SPLIT_H
#define WEFT_COMPRESS_HOLD_OUT_SPLIT_H

#include "btf/dataset/dataset.h"
#include "btf/material/held_out.h"

/* Why an image is held out (bits); 0 is an image that is fitted. */
enum { WEFT_HELD_VIEW = 1, WEFT_HELD_LIGHT = 2, WEFT_HELD_IMAGE = 4 };

enum {
    WEFT_SPLIT_MOST = 10,      /* splits */
    WEFT_SPLIT_EACH_LIMIT = 24 /* fewer images than these are left out one by one: a tenth of them says little, and
                                  without two of them the model that 20 images carry would be another */
};

/* Freed with weft_splits_free. */
typedef struct weft_splits {
    weft_split_kind kind;
    int count, image_count;
    int view_count, view_held_count;   /* of a split, on average rounded; 0 held where none is */
    int light_count, light_held_count; /* lights of a grid: those of its fullest view */
    uint8_t *held;                     /* [count][image_count] */
} weft_splits;

/* Chooses up to `most` splits. Deterministic; `seed` says which directions come first.
 *
 * A grid has four or more images a view on average, and ten or more views or lights. About a tenth of its views and
 * about a tenth of its lights are held out, each with all of its images, so that a test asks for directions between
 * those that were fitted: of the rings of ubo81 from 15 to 60 degrees and inside the outermost one, where there are
 * enough such, spread over the rings and in azimuth. No view and no light is held out twice. Lights may jitter from
 * view to view: an image has the light of the fullest view that is nearest to its own. Of a list of images that is no
 * grid every tenth is held out in the order of their directions. Places of a near dataset count as directions from its
 * centre.
 *
 * There are fewer splits than `most` where directions run out, and exactly as many as images with WEFT_SPLIT_EACH.
 * Errors: WEFT_BAD_USAGE for a dataset of one image, WEFT_SYSTEM for memory. */
weft_code weft_splits_create(const weft_dataset_layout *layout, uint64_t seed, int most, weft_splits *splits,
                             weft_error *error);
void weft_splits_free(weft_splits *splits);

/* The flags of one split: [image_count]. */
const uint8_t *weft_splits_held(const weft_splits *splits, int split);

/* Splits whose mean says what is to be said of a dataset, 1 .. WEFT_HOLD_OUT_ENOUGH: of a grid as many as hold out 10
 * views and lights, for with fewer the figure is as much one of the directions as of the model. As many others are left
 * for a prediction. Errors: those of weft_splits_create. */
enum { WEFT_HOLD_OUT_ENOUGH = 4 };
weft_code weft_hold_out_enough_splits(const weft_dataset_layout *layout, int *count, weft_error *error);

#endif

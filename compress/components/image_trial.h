/* What components that are fitted to some images of a few texels say of the others. */
#ifndef WEFT_COMPRESS_COMPONENTS_IMAGE_TRIAL_H
#define WEFT_COMPRESS_COMPONENTS_IMAGE_TRIAL_H

#include "compress/components/model.h"

/* Why an image is held out. */
typedef enum weft_held_kind {
    WEFT_HELD_INSIDE,    /* to be interpolated: measured directions lie on all sides */
    WEFT_HELD_FAR_VIEW,  /* its view is among the outermost, ... */
    WEFT_HELD_FAR_LIGHT, /* ... its light is, ... */
    WEFT_HELD_FAR_BOTH,  /* ... or both are */
    WEFT_HELD_KINDS
} weft_held_kind;

/* Freed with weft_image_split_free. */
typedef struct weft_image_split {
    weft_component_images fitted; /* its own arrays, but `image` is an index into the images of the whole */
    int held_count;
    int *held;            /* [held_count] index into the images of the whole */
    weft_vec3 *held_view; /* [held_count] */
    uint8_t *held_kind;   /* [held_count] weft_held_kind */
} weft_image_split;

/* Holds out a tenth of the views and of the lights, or a fifth of the lights of fewer than four views, of those between
 * 10 and 62 degrees from the normal; views only of 20, lights only of 20. Errors: WEFT_SYSTEM. */
weft_code weft_image_split_inside(const weft_component_images *images, weft_image_split *split, weft_error *error);

/* Holds out the outermost views and lights: a whole ring where they lie in rings, else a tenth; views only where 20 are
 * left, lights only where 20 are. *from_deg receives how far from the normal the nearest of them is. Errors:
 * WEFT_SYSTEM. */
weft_code weft_image_split_outermost(const weft_component_images *images, double *from_deg, weft_image_split *split,
                                     weft_error *error);
void weft_image_split_free(weft_image_split *split);

typedef struct weft_image_trial {
    const weft_component_images *images;
    const weft_training *training; /* linear */
    const weft_image_split *split;
    int component_count;
} weft_image_trial;

/* Fits components with each of `count` plans, which have the same exponent, finds their lengths, and measures what is
 * held out: errors [count][WEFT_HELD_KINDS], 0 for kinds of which there is none. Errors: WEFT_SYSTEM. */
weft_code weft_image_trial_run(const weft_image_trial *trial, weft_component_plan *plan, int count,
                               weft_component_errors (*errors)[WEFT_HELD_KINDS], weft_error *error);

/* l . h is taken as at least that of the images. Pure. */
float weft_least_incidence_of(const weft_component_images *images);

#endif

/* What a completion learns from: images, with the samples that a few texels have of them. */
#ifndef WEFT_COMPRESS_COMPONENTS_KNOWN_H
#define WEFT_COMPRESS_COMPONENTS_KNOWN_H

#include "compress/components/training.h"
#include "compress/kriging/choose.h"

/* Three series a texel, one a channel. Freed with weft_known_free. */
typedef struct weft_known {
    int count, series_count;
    int *image;                /* [count] of the images of components */
    weft_direction_pair *pair; /* [count] */
    double *weight;            /* [count] */
    double *sample;            /* [series_count][count] */
} weft_known;

/* The samples of texels first .. last at an even choice of at most `most` of the images that any of them has. Errors:
 * WEFT_SYSTEM for memory. */
weft_code weft_known_take(const weft_training *training, const weft_component_images *images, int first, int last,
                          int most, weft_known *known, weft_error *error);
void weft_known_free(weft_known *known);

/* Where the images lie. They stay those of `known`. */
weft_kriging_places weft_known_places(const weft_known *known);

/* The mean square of all samples; 0 where there is none. */
double weft_known_mean_square(const weft_known *known);

/* Number i of `some` that are an even choice of `all`. */
int weft_even_choice(int i, int some, int all);
int weft_at_most(int count, int most);

#endif

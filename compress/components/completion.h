/* Texels completed: what kriging says of them under the same directions as any other material, where their images are
 * scattered. Every photograph may have a view and a light of its own, near lights and cameras give every texel
 * directions of its own, and one view says nothing of others; components are learned from completed texels then. */
#ifndef WEFT_COMPRESS_COMPONENTS_COMPLETION_H
#define WEFT_COMPRESS_COMPONENTS_COMPLETION_H

#include "base/progress.h"
#include "compress/components/training.h"
#include "compress/kriging/kriging.h"
#include "compress/run/memory.h"

/* Freed with weft_completion_free. */
typedef struct weft_completion {
    weft_component_images
        images;             /* the directions: 81 lights for each of 81 views, or for the one there is; weights 1 */
    weft_training training; /* the same texels, or some of them, everything valid */
    weft_covariance covariance;
    int left_out_count;    /* images of a texel that decided the covariance */
    double left_out_error; /* relative RMSE of these, each predicted by the others of them */
    weft_covariance mean;  /* of the mean texel, where it is of a mean: far images alone have one */
    double mean_error[2];  /* of the mean texel, by `covariance` and by `mean` */
    double noise;          /* mean square of what is noise in a sample */
} weft_completion;

/* Learns from at most 1500 of `images` (256 of near ones) and `training`, without clipped samples. Errors:
 * WEFT_BAD_USAGE where `budget` does not suffice, for the dataset `path`; WEFT_BAD_INPUT; WEFT_SYSTEM. */
weft_code weft_completion_make(const weft_dataset_layout *layout, const weft_component_images *images,
                               const weft_training *training, const weft_memory_budget *budget, const char *path,
                               const weft_progress *progress, weft_completion *completion, weft_error *error);
void weft_completion_free(weft_completion *completion);

#endif

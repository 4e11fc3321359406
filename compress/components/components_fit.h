/* Components of a dataset (btf/material/components.h): learned from some texels, then projected for all. */
#ifndef WEFT_COMPRESS_COMPONENTS_COMPONENTS_FIT_H
#define WEFT_COMPRESS_COMPONENTS_COMPONENTS_FIT_H

#include "base/numeric/error_summary.h"
#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/material/material.h"
#include "compress/components/model.h"
#include "compress/kriging/covariance.h"
#include "compress/options/options.h"
#include "compress/run/checkpoint.h"
#include "compress/run/memory.h"

#include <stdbool.h>

typedef struct weft_components_options {
    int component_count;     /* 4 .. 64, a multiple of 4; quantised where what they leave hides it, unless `finer` */
    bool finer;              /* as many components again (compress/options/options.h) */
    const uint8_t *held_out; /* [image_count] images that the fit must not see, or NULL */
    bool for_screen;         /* what a screen shows decides how values are coded; else linear light */
    /* These change nothing in the result: */
    weft_memory_budget budget;
    weft_checkpoint
        *checkpoint; /* whose unread records are blocks of these components, and which gets more; NULL: none */
    weft_log log;    /* hears that these blocks are used */
} weft_components_options;

typedef struct weft_components_report {
    weft_component_plan plan;
    weft_component_trial trial; /* what decided it; of images that are not scattered */
    bool scattered;
    double scattered_error[2];  /* relative RMSE of maps over light and half vector, on the images themselves */
    weft_covariance covariance; /* of scattered images, chosen by leaving out each of some images ... */
    int left_out_count;         /* ... how many these are in a texel ... */
    double left_out_error;      /* ... and their relative RMSE, each predicted by the others of them */
    weft_covariance mean;       /* of the mean texel, where it is of a mean */
    double mean_error[2];       /* of the mean texel, without this and with it */
    double rounding_step;       /* of values and coefficients; 0: they are not rounded */
    int training_texels;
    long masked, empty_texels;
    weft_error_summary fitted; /* level 0, of the training texels, over images that were fitted */
} weft_components_report;

/* Whether the images of a dataset are scattered: fewer than 12 for a view, two or three views, near, or more than
 * kriged maps can hold (btf/material/components.h). Images that are held out count, so that the fit that tells the
 * error is of the same kind as the one that it is told of. The components of scattered images are learned from what
 * kriging says of some texels (compress/kriging/kriging.h). Pure. */
bool weft_images_are_scattered(const weft_dataset_layout *layout);

/* Adds components to `material`, which has the size of the dataset and may have lobes as well. The same dataset gives
 * the same components, for any number of threads and any memory. What a checkpoint keeps is the coefficients of all
 * texels: what they are coefficients of is learned anew, which takes as long for a large dataset as for a small one.
 * Errors: WEFT_BAD_USAGE for options out of range and where the memory does not suffice; those of reading; those of
 * weft_checkpoint_append; WEFT_BAD_INPUT for a checkpoint of other blocks; WEFT_SYSTEM. */
weft_code weft_components_fit(weft_dataset *dataset, const weft_components_options *options,
                              const weft_progress *progress, weft_material *material, weft_components_report *report,
                              weft_error *error);

#endif

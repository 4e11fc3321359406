/* What a compression is asked to do. */
#ifndef WEFT_COMPRESS_OPTIONS_OPTIONS_H
#define WEFT_COMPRESS_OPTIONS_OPTIONS_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"

#include <stdbool.h>

/* What an error of a sample counts for. */
/* No value of a texel exceeds so many times its brightest sample, whatever the light and the view: neither r, which has
 * the cosine of the light, beside the brightest r as it would be under the highest light of the samples, nor f beside
 * the brightest f. */
enum { WEFT_BRIGHTEST_MULTIPLE = 4 };

typedef enum weft_sample_weights {
    WEFT_WEIGHTS_EVEN,  /* alike, as in least squares */
    WEFT_WEIGHTS_SCREEN /* less the brighter the sample, about as little as a screen shows of it */
} weft_sample_weights;

/* Which frame the texels of a material have. */
typedef enum weft_frame_choice {
    WEFT_FRAMES_SURFACE, /* that of the surface */
    WEFT_FRAMES_GIVEN,   /* what the dataset says, which may be that of the surface */
    WEFT_FRAMES_FITTED   /* the better of the two, or turned from there, where that helps */
} weft_frame_choice;

/* Components instead of lobes, unless something is asked for that only lobes have (compress/compress.h). */
enum { WEFT_COMPONENTS_AUTOMATIC = -1 };

/* What the maps of components are over. */
typedef enum weft_component_maps_choice {
    WEFT_COMPONENT_MAPS_CHOSEN, /* what predicts images better that are held out to choose */
    WEFT_COMPONENT_MAPS_OF_LIGHT,
    WEFT_COMPONENT_MAPS_OF_HALF_VECTOR
} weft_component_maps_choice;

typedef struct weft_compress_options {
    int lobe_count;              /* at most; 0..3 */
    bool table;                  /* T(v), where the samples can carry it */
    bool light_table;            /* S(l) beside T, where lights repeat and the samples can carry it */
    weft_sample_weights weights; /* of a dense model */
    bool levels;                 /* mip levels, each fitted to the mean samples of its groups of texels */
    weft_frame_choice frames;
    double max_exponent;   /* N <= this */
    double target_error;   /* each texel gets the smallest model whose relative RMSE is at most this; 0: all alike */
    uint64_t budget_bytes; /* the models of the texels are chosen for the least error in a file of this size; 0: not */
    uint64_t added_bytes;  /* of a file in the budget: metadata that the caller adds to the material afterwards */
    int component_count;   /* components beside the lobes: 4..64, a multiple of 4; 0: none; WEFT_COMPONENTS_AUTOMATIC */
    weft_component_maps_choice component_maps;
    bool finer;   /* as many components again, which hold what rounding to 8 bits leaves of the coefficients of the
                     first, which have 15 bits then: it tells what rounding costs. At most 32 components */
    bool rounded; /* components are rounded where what they leave hides it (btf/material/component_rounding.h) */
    bool heights; /* components are seen through those of the dataset, where it has some (`weft relief`) */
    const uint8_t *held_out; /* [image_count] images that the fit must not see (non-zero), or NULL */
    /* These change nothing in the result: */
    uint64_t memory_bytes;       /* that the process may take; 0: weft_memory_default, a quarter of what there is */
    const char *checkpoint_path; /* keeps what is done of a dense model until the caller removes it; NULL: none,
                                    and the dataset may have lost its name */
    weft_log log;                /* hears of checkpoints that are used or discarded */
} weft_compress_options;

/* Automatic components, or 2 lobes and table where there are none; levels, heights, fitted frames, N <= 8192, nothing
 * held out, a quarter of the memory, no checkpoint. */
weft_compress_options weft_compress_default_options(void);

/* Images that are not held out. Pure. */
int weft_compress_options_count_images(const weft_compress_options *options, const weft_dataset_layout *layout);

/* Errors: WEFT_BAD_USAGE for options out of range, a target and a budget together, components with either, or where
 * every image is held out. */
weft_code weft_compress_options_check(const weft_compress_options *options, const weft_dataset *dataset,
                                      weft_error *error);

#endif

/* What a compression is asked to do. */
#ifndef WEFT_COMPRESS_OPTIONS_OPTIONS_H
#define WEFT_COMPRESS_OPTIONS_OPTIONS_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"

#include <stdbool.h>

/* A ceiling is so many times the brightest sample (compress/texel/texel.h, compress/components/levels.c). */
enum { WEFT_BRIGHTEST_MULTIPLE = 4 };

/* What an error of a sample counts for. */
typedef enum weft_sample_weights {
    WEFT_WEIGHTS_EVEN,  /* alike, as in least squares */
    WEFT_WEIGHTS_SCREEN /* less the brighter the sample, about as little as a screen shows of it */
} weft_sample_weights;

/* As many components as the number of images suggests, or lobes where these are few (compress/compress.h). */
enum { WEFT_COMPONENTS_AUTOMATIC = -1 };

/* What the maps of components are over. */
typedef enum weft_component_maps_choice {
    WEFT_COMPONENT_MAPS_CHOSEN, /* what predicts images better that are held out to choose */
    WEFT_COMPONENT_MAPS_OF_LIGHT,
    WEFT_COMPONENT_MAPS_OF_HALF_VECTOR
} weft_component_maps_choice;

typedef struct weft_compress_options {
    int component_count; /* 4..64, a multiple of 4; 0: lobes; WEFT_COMPONENTS_AUTOMATIC */
    int lobe_count; /* without components: at most so many, 1..3, with T where the samples can carry it; 0: a diffuse
                       term */
    weft_sample_weights weights; /* not of the sparse model */
    bool levels;                 /* mip levels, each fitted to the mean samples of its groups of texels */
    bool heights;                /* components are seen through those of the dataset, where it has some */
    weft_component_maps_choice component_maps;
    bool finer; /* as many components again, which hold what rounding to 8 bits leaves of the coefficients of the first,
                   which have 15 bits then: it tells what rounding costs. At most 32 components */
    const uint8_t *held_out; /* [image_count] images that the fit must not see (non-zero), or NULL */
    /* These change nothing in the result: */
    uint64_t memory_bytes;       /* that the process may take; 0: weft_memory_default, a quarter of what there is */
    const char *checkpoint_path; /* keeps what is done until the caller removes it; NULL: none, and the dataset may have
                                    lost its name */
    weft_log log;                /* hears of checkpoints that are used or discarded */
} weft_compress_options;

/* Automatic components, or 2 lobes where there are none; levels, heights, nothing held out, a quarter of the memory, no
 * checkpoint. */
weft_compress_options weft_compress_default_options(void);

/* Images that are not held out. Pure. */
int weft_compress_options_count_images(const weft_compress_options *options, const weft_dataset_layout *layout);

/* Errors: WEFT_BAD_USAGE for options out of range, or where every image is held out. */
weft_code weft_compress_options_check(const weft_compress_options *options, const weft_dataset *dataset,
                                      weft_error *error);

#endif

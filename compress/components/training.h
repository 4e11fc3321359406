/* The texels that components are learned from: some hundreds, spread over the material. */
#ifndef WEFT_COMPRESS_COMPONENTS_TRAINING_H
#define WEFT_COMPRESS_COMPONENTS_TRAINING_H

#include "base/progress.h"
#include "compress/components/images.h"

#include <stdbool.h>

enum { WEFT_TRAINING_TEXELS = 512 };

typedef struct weft_training_place {
    int x, y;
} weft_training_place;

/* Freed with weft_training_free. */
typedef struct weft_training {
    int texel_count;
    weft_training_place *place; /* [texel_count] */
    size_t length, image_count;
    float *vector;  /* [texel_count][length] aligned to 64 bytes; 0 where there is no sample */
    uint8_t *known; /* [texel_count][image_count] (compress/components/images.h) */
} weft_training;

/* Reads up to WEFT_TRAINING_TEXELS texels from an even choice of small squares, which lie in few chunks of the file.
 * Texels with less than half of their images are left out while there are others. Errors: those of reading;
 * WEFT_BAD_INPUT where no texel has a sample; WEFT_SYSTEM. */
weft_code weft_training_read(weft_dataset *dataset, const weft_component_images *images, weft_training *training,
                             weft_error *error);
void weft_training_free(weft_training *training);

/* So many texels whose samples and places are 0, all valid. Errors: WEFT_SYSTEM. */
weft_code weft_training_allocate(int texels, size_t length, size_t image_count, weft_training *training,
                                 weft_error *error);

/* Whether every sample is valid. */
bool weft_training_is_whole(const weft_training *training);

/* What is masked becomes the mean texel over what is known, brought to the brightness of each. Errors: WEFT_SYSTEM. */
weft_code weft_training_fill_by_mean(weft_training *training, weft_error *error);

/* Clipped samples become unknown ones. */
void weft_training_drop_clipped(weft_training *training);

/* Samples become coded values: those that give them with an exponent (btf/material/components.h). */
void weft_training_code(weft_training *training, const weft_component_images *images, float exponent);

/* An even choice of at most `most` texels. The caller frees. Errors: WEFT_SYSTEM. */
weft_code weft_training_thin(const weft_training *whole, int most, weft_training *subset, weft_error *error);

/* What training texels say of some of their images alone: those at index choice [images->image_count] of `whole`. The
 * caller frees. Errors: WEFT_SYSTEM. */
weft_code weft_training_subset(const weft_training *whole, const weft_component_images *images, const int *choice,
                               weft_training *subset, weft_error *error);

#endif

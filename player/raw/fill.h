/* Which images of a dataset can be used, and what stands in for samples that cannot. */
#ifndef WEFT_PLAYER_RAW_FILL_H
#define WEFT_PLAYER_RAW_FILL_H

#include "btf/dataset/dataset.h"
#include "player/texture/direction_map.h"

#include <stdbool.h>

typedef struct weft_raw_images {
    int image_count, view_count;
    bool *usable;         /* [image_count] has a valid sample */
    int *order;           /* [image_count] usable images, those of a view together */
    int *first_of_view;   /* [view_count + 1] where those of a view start in `order` */
    weft_vec3 *direction; /* [image_count] to the light, at the centre of the material */
} weft_raw_images;

/* Reads masks until every image is known to have a valid sample: of the whole dataset only where one has none. Errors:
 * those of reading; WEFT_BAD_INPUT where no sample is valid; WEFT_SYSTEM. The caller frees with weft_raw_images_free,
 * also on failure. */
weft_code weft_raw_images_find(weft_dataset *dataset, weft_raw_images *images, weft_error *error);
void weft_raw_images_free(weft_raw_images *images);

/* Set 0: the views that have usable images, labelled with the set of their lights; then those sets, labelled with
 * images. Errors: WEFT_BAD_INPUT, WEFT_SYSTEM. The caller frees `map`, also on failure. */
weft_code weft_raw_images_map(const weft_raw_images *images, const weft_dataset_layout *layout, weft_direction_map *map,
                              weft_error *error);

/* Turns the samples of texel (x, y) into BRDF x pi: value [image_count][3] from sample [image_count][3] and
 * mask [image_count], invalid ones from the nearest valid light of the same view, or of the nearest view that has one;
 * 0 where there is none. Pure. */
void weft_raw_texel_fill(const weft_raw_images *images, const weft_dataset_layout *layout, int x, int y,
                         const weft_half *sample, const uint8_t *mask, float *value);

#endif

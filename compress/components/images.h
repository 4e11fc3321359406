/* The images that components are fitted to, view by view, and the samples of a texel in their order. */
#ifndef WEFT_COMPRESS_COMPONENTS_IMAGES_H
#define WEFT_COMPRESS_COMPONENTS_IMAGES_H

#include "btf/dataset/dataset.h"

/* Those that are not held out and have a weight, with light and view above the horizon. Views without such an image are
 * left out. */
typedef struct weft_component_images {
    int image_count, view_count;
    size_t length; /* of a vector of samples: 3 image_count, rounded up to whole lanes */
    int dataset_image_count;
    int *image;       /* [image_count] of the dataset */
    uint32_t *first;  /* [view_count + 1] into image */
    weft_vec3 *light; /* [image_count] unit */
    weft_vec3 *view;  /* [view_count] unit */
    float *height;    /* [image_count] z of the light: what every sample is gathered by */
    float *cosine;    /* [image_count] what makes a sample reflectance times cosine */
    float *weight;    /* [image_count] root of what the square of an error counts for; its mean square is 1 at first */
} weft_component_images;

/* `held_out` [image_count] may be NULL. The caller frees. Errors: WEFT_BAD_USAGE where no image is left; WEFT_SYSTEM.
 */
weft_code weft_component_images_create(const weft_dataset_layout *layout, const uint8_t *held_out,
                                       weft_component_images *images, weft_error *error);
void weft_component_images_free(weft_component_images *images);

/* Room for so many images of so many views, none of which is there yet. The caller frees. Errors: WEFT_SYSTEM. */
weft_code weft_component_images_allocate(int image_count, int view_count, weft_component_images *images,
                                         weft_error *error);

/* The caller frees the copy. Errors: WEFT_SYSTEM. */
weft_code weft_component_images_copy(const weft_component_images *images, weft_component_images *copy,
                                     weft_error *error);

/* Directions and cosines become those of texel (x, y), which near lights and cameras make its own; they may lie below
 * the horizon. At first they are those of the centre of the material. */
void weft_component_images_look_from(const weft_dataset_layout *layout, int x, int y, weft_component_images *images);

/* Takes over image `index` of `from`, except for its number in the dataset, which becomes `image`. */
void weft_component_images_add(weft_component_images *images, const weft_component_images *from, int index, int image);

/* What is known of an image of a texel: nothing (0), its sample, or that its brightest channels are no darker than they
 * look, because the sensor clipped there. Of a clipped sample bit WEFT_SAMPLE_CLIPPED << channel is set for each of the
 * channels that may be brighter; the others are as they look. */
enum { WEFT_SAMPLE_VALID = 1, WEFT_SAMPLE_CLIPPED = 2 };

/* The samples of one texel: samples [dataset image][3] and mask [dataset image] become vector [length], times
 * the weights, and known [image_count]; what is not known is 0. `scratch` has 4 dataset images. Returns the number of
 * valid images. */
int weft_component_images_gather(const weft_component_images *images, const weft_half *samples, const uint8_t *mask,
                                 float *scratch, float *vector, uint8_t *known);

#endif

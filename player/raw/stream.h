/* A dataset on its way to the graphics card: rows of its images and of their mip levels, as they are uploaded. No
 * OpenGL, so that it can run beside the thread that draws. */
#ifndef WEFT_PLAYER_RAW_STREAM_H
#define WEFT_PLAYER_RAW_STREAM_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "player/raw/plan.h"
#include "player/texture/direction_map.h"
#include "player/texture/relief_map.h"

#include <stdbool.h>

/* ---- Which images can be used, and the values that replace invalid samples ---- */

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

/* ---- Rows of all images, from the finest level down to 1 x 1: a row of blocks goes on as soon as its texels are
 * there. ---- */

/* A row of blocks of a level in one column of tiles, image by image as weft_raw_store has them. */
typedef struct weft_raw_strip {
    int part, level, column, row; /* level 0: the finest that is held */
    size_t bytes;
    void *texels;
} weft_raw_strip;

/* Takes the texels of a strip, also where it fails. */
typedef weft_code weft_raw_take(void *context, const weft_raw_strip *strip, weft_error *error);

typedef struct weft_raw_levels weft_raw_levels;

/* For one part of the plan; the finest level of the dataset has this size. `plan` is kept. Errors: WEFT_SYSTEM. The
 * caller frees with weft_raw_levels_free. */
weft_code weft_raw_levels_create(const weft_raw_plan *plan, int part, int width, int height, weft_raw_take *take,
                                 void *context, weft_raw_levels **result, weft_error *error);
void weft_raw_levels_free(weft_raw_levels *levels);

/* Where row y of the finest level is to be written: [width][channels][image], 3 channels of samples, 1 of opacity. */
float *weft_raw_levels_row(weft_raw_levels *levels, int y);

/* Row y of the finest level is written; rows come in their order. Levels are box means of samples. Errors: those of
 * `take`, WEFT_SYSTEM. */
weft_code weft_raw_levels_push(weft_raw_levels *levels, int y, weft_error *error);

/* ---- The stream ---- */

/* Where the stream goes. `begin` comes first and may take the directions and the relief, leaving none; then every
 * strip; then `end`. An error of the sink ends the stream. */
typedef struct weft_raw_sink {
    void *context;
    weft_code (*begin)(void *context, const weft_raw_plan *plan, weft_direction_map *directions,
                       weft_relief_map *relief, weft_error *error);
    weft_raw_take *strip;
    weft_code (*end)(void *context, bool opaque, weft_error *error);
} weft_raw_sink;

/* Streams the whole dataset; memory stays at some rows of it. Set 0 of the directions: views, the label of one being 1
 * + its tile of opacity, and the set of its lights; then those sets, their labels the images. A dataset of near lights
 * uses the directions of its centre. Errors: those of reading and of weft_raw_plan_make; WEFT_BAD_INPUT where no sample
 * is valid; WEFT_SYSTEM; those of the sink. */
weft_code weft_raw_stream(weft_dataset *dataset, const weft_raw_limits *limits, const weft_progress *progress,
                          const weft_raw_sink *sink, weft_error *error);

#endif

/* A dataset on its way to the graphics card: rows of its images and of their mip levels, as they are uploaded. No
 * OpenGL, so that it can run beside the thread that draws. */
#ifndef WEFT_PLAYER_RAW_STREAM_H
#define WEFT_PLAYER_RAW_STREAM_H

#include "btf/dataset.h"
#include "btf/progress.h"
#include "player/direction_map.h"
#include "player/mip_layout.h"

#include <stdbool.h>

/* What the driver takes, and the bytes up to which samples are kept as half floats, and up to which at all. */
typedef struct weft_raw_limits {
    size_t half_bytes, bytes;
    int size, layers;
} weft_raw_limits;

/* How the images lie in the texture: image i is a tile with all its levels, in layer i / columns, column i % columns.
 * Every level has a border of WEFT_RAW_BORDER texels that repeats the opposite side. */
typedef struct weft_raw_plan {
    weft_mip_layout layout; /* of the levels that are held */
    int skipped_levels;     /* finest levels left out because they do not fit */
    bool packed;            /* RGB with a shared exponent: 4 bytes a sample instead of 8, without opacity */
    int columns, layers;
} weft_raw_plan;

enum { WEFT_RAW_BORDER = 1 };

/* Row y of a level in one column of tiles: [layers][width + 2 WEFT_RAW_BORDER] texels of 4 halves (RGB, opacity) or of
 * a uint32_t (packed), with the borders at its ends. */
typedef struct weft_raw_strip {
    int level, column, y; /* level 0: the finest that is held */
    size_t bytes;
    void *texels;
} weft_raw_strip;

/* Where the stream goes. `begin` comes first and may take the directions, leaving none; then every strip (its texels
 * are the sink's to free, also on failure); then `end`. An error of the sink ends the stream. */
typedef struct weft_raw_sink {
    void *context;
    weft_code (*begin)(void *context, const weft_raw_plan *plan, weft_direction_map *directions, weft_error *error);
    weft_code (*strip)(void *context, const weft_raw_strip *strip, weft_error *error);
    weft_code (*end)(void *context, bool opaque, weft_error *error);
} weft_raw_sink;

/* Streams the whole dataset; memory stays at some rows of it. Set 0 of the directions: views; the label of a view is
 * the set of its lights. A dataset of near lights uses the directions of its centre. Errors: those of reading;
 * WEFT_BAD_INPUT where no sample is valid or nothing fits; WEFT_SYSTEM; those of the sink. */
weft_code weft_raw_stream(weft_dataset *dataset, const weft_raw_limits *limits, const weft_progress *progress,
                          const weft_raw_sink *sink, weft_error *error);

#endif

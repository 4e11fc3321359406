/* A dataset on its way to the graphics card: rows of its images and of their mip levels, as they are uploaded. No
 * OpenGL, so that it can run beside the thread that draws. */
#ifndef WEFT_PLAYER_RAW_STREAM_H
#define WEFT_PLAYER_RAW_STREAM_H

#include "base/progress.h"
#include "player/raw/levels.h"
#include "player/texture/direction_map.h"
#include "player/texture/relief_map.h"

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

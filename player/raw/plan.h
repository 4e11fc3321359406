/* How a dataset lies on the graphics card: what fits. */
#ifndef WEFT_PLAYER_RAW_PLAN_H
#define WEFT_PLAYER_RAW_PLAN_H

#include "btf/dataset/dataset.h"
#include "player/raw/format.h"
#include "player/texture/mip_layout.h"

#include <stdbool.h>

/* What the driver takes, the bytes up to which the best format is half floats, and up to which anything is kept. */
typedef struct weft_raw_limits {
    size_t half_bytes, bytes;
    int size, layers;
    bool has_bc6h;
    weft_raw_format format; /* this one, whatever fits better; WEFT_RAW_FITTING: the best that fits */
} weft_raw_limits;

/* Samples have a tile for each image, opacity for each view. Tile i, with all levels, is in layer i % layers and
 * column i / layers. */
enum { WEFT_RAW_SAMPLES, WEFT_RAW_OPACITY, WEFT_RAW_PARTS };

typedef struct weft_raw_tiles {
    weft_raw_format format;
    int count, columns, layers; /* count 0: there are none */
} weft_raw_tiles;

/* Every level begins at a block, and after its last texels of a row and of a column come the first ones again. */
typedef struct weft_raw_plan {
    weft_mip_layout layout; /* of the levels that are held */
    int skipped_levels;     /* finest levels left out because they do not fit */
    weft_raw_tiles tiles[WEFT_RAW_PARTS];
} weft_raw_plan;

/* The best format in which everything fits; where none does, as many of the finest levels are left out as it takes.
 * `path` names the dataset in messages. Errors: WEFT_BAD_INPUT where nothing fits; WEFT_SYSTEM for a format that the
 * driver lacks. */
weft_code weft_raw_plan_make(const weft_dataset_layout *layout, bool has_opacity, const char *path,
                             const weft_raw_limits *limits, weft_raw_plan *plan, weft_error *error);

/* Graphics memory, were the samples kept in `format`. Pure. */
size_t weft_raw_plan_bytes(const weft_raw_plan *plan, weft_raw_format format);

#endif

/* The inner loops of reflectance/weave/batch.h, compiled once for every instruction set. Private to the room. */
#ifndef WEFT_REFLECTANCE_WEAVE_BATCH_KERNELS_H
#define WEFT_REFLECTANCE_WEAVE_BATCH_KERNELS_H

#include "base/processor.h"
#include "reflectance/weave/batch.h"

/* What the texture of a yarn depends on. Kinds are columns of one. */
enum {
    WEFT_WOVEN_STAPLE,   /* 1 or 0 */
    WEFT_WOVEN_FILAMENT, /* 1 or 0; an inadmissible segment is neither */
    WEFT_WOVEN_WARP,     /* 1 or 0 */
    WEFT_WOVEN_AREA_WEIGHT,
    WEFT_WOVEN_ALPHA,
    WEFT_WOVEN_BETA,
    WEFT_WOVEN_DELTA,
    WEFT_WOVEN_UMAX,
    WEFT_WOVEN_RADIUS_SHARE,
    WEFT_WOVEN_KAPPA,
    WEFT_WOVEN_WIDTH,
    WEFT_WOVEN_LENGTH,
    WEFT_WOVEN_HIGHLIGHT_WIDTH,
    WEFT_WOVEN_COT_PSI,
    WEFT_WOVEN_INVERSE_SIN_PSI,
    WEFT_WOVEN_PHASE_SCALE,
    WEFT_WOVEN_COLUMNS
};

struct weft_woven_table {
    int yarn_count;
    bool any_staple, any_filament;
    float *column[WEFT_WOVEN_COLUMNS]; /* [yarn_count] each, one block */
};

#define WEFT_DECLARE_WOVEN_KERNELS(set)                                                                                \
    void weft_woven_texture_##set(const weft_woven_table *table, weft_weave_batch *batch);                             \
    void weft_woven_reflectance_##set(const weft_prepared_segment *prepared, int count, const weft_vec3 *light,        \
                                      const weft_vec3 *view, weft_real *value)

WEFT_FOR_EACH_SET(WEFT_DECLARE_WOVEN_KERNELS);

#endif

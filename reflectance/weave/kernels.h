/* The inner loops of reflectance/weave/batch.h, compiled once for every instruction set. Private to the room. */
#ifndef WEFT_REFLECTANCE_WEAVE_KERNELS_H
#define WEFT_REFLECTANCE_WEAVE_KERNELS_H

#include "reflectance/weave/batch.h"

/* What the texture of a yarn depends on. Kinds are columns of one. */
enum {
    TABLE_STAPLE,   /* 1 or 0 */
    TABLE_FILAMENT, /* 1 or 0; an inadmissible segment is neither */
    TABLE_WARP,     /* 1 or 0 */
    TABLE_AREA_WEIGHT,
    TABLE_ALPHA,
    TABLE_BETA,
    TABLE_DELTA,
    TABLE_UMAX,
    TABLE_RADIUS_SHARE,
    TABLE_KAPPA,
    TABLE_WIDTH,
    TABLE_LENGTH,
    TABLE_HIGHLIGHT_WIDTH,
    TABLE_COT_PSI,
    TABLE_INVERSE_SIN_PSI,
    TABLE_PHASE_SCALE,
    TABLE_COLUMNS
};

struct weft_woven_table {
    int yarn_count;
    bool any_staple, any_filament;
    float *column[TABLE_COLUMNS]; /* [yarn_count] each, one block */
};

#define WEFT_DECLARE_WOVEN_KERNELS(set)                                                                                \
    void weft_woven_texture_##set(const weft_woven_table *table, weft_weave_batch *batch);                             \
    void weft_woven_reflectance_##set(const weft_prepared_segment *prepared, int count, const weft_vec3 *light,        \
                                      const weft_vec3 *view, weft_real *value)

WEFT_DECLARE_WOVEN_KERNELS(baseline);
#if defined(__x86_64__)
WEFT_DECLARE_WOVEN_KERNELS(avx2);
WEFT_DECLARE_WOVEN_KERNELS(avx512);
#endif

#endif

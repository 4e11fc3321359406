/* Many evaluations of woven cloth at once, in single precision and in vectors as wide as the processor has them
 * (base/processor.h): what reflectance/weave/weave.h says of one point or pair of directions, for lists of them. */
#ifndef WEFT_REFLECTANCE_WEAVE_BATCH_H
#define WEFT_REFLECTANCE_WEAVE_BATCH_H

#include "reflectance/weave/weave.h"

/* The yarns of a weave, prepared for batches. Immutable: any number of threads may use it. */
typedef struct weft_woven_table weft_woven_table;

/* The weave may be freed before its table; it does not follow later changes. The caller frees with
 * weft_woven_table_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_woven_table_create(const weft_weave *weave, weft_woven_table **result, weft_error *error);
void weft_woven_table_free(weft_woven_table *table);

enum { WEFT_BATCH_SIZE = 256, WEFT_BATCH_ALIGNMENT = 64 };

typedef struct weft_batch_directions {
    _Alignas(WEFT_BATCH_ALIGNMENT) float x[WEFT_BATCH_SIZE];
    float y[WEFT_BATCH_SIZE], z[WEFT_BATCH_SIZE];
} weft_batch_directions;

/* Located points with their directions (frame of the cloth), as a structure of arrays, and the result. Begins with
 * count 0 and otherwise undefined. */
typedef struct weft_weave_batch {
    int count;
    _Alignas(WEFT_BATCH_ALIGNMENT) int32_t yarn[WEFT_BATCH_SIZE];
    float x[WEFT_BATCH_SIZE], y[WEFT_BATCH_SIZE], umax_offset_rad[WEFT_BATCH_SIZE], intensity[WEFT_BATCH_SIZE];
    weft_batch_directions light, view;
    float specular[WEFT_BATCH_SIZE];
} weft_weave_batch;

/* Appends one evaluation; count < WEFT_BATCH_SIZE before. */
static inline void weft_weave_batch_put(weft_weave_batch *batch, const weft_weave_point *point, weft_vec3 light,
                                        weft_vec3 view)
{
    int i = batch->count++;
    batch->yarn[i] = point->yarn;
    batch->x[i] = (float)point->x;
    batch->y[i] = (float)point->y;
    batch->umax_offset_rad[i] = (float)point->umax_offset_rad;
    batch->intensity[i] = (float)point->intensity;
    batch->light.x[i] = (float)light.x;
    batch->light.y[i] = (float)light.y;
    batch->light.z[i] = (float)light.z;
    batch->view.x[i] = (float)view.x;
    batch->view.y[i] = (float)view.y;
    batch->view.z[i] = (float)view.z;
}

/* specular[i] = weft_weave_specular of evaluation i, for all i < count. Equal to it as far as single precision carries:
 * relative 1e-4 or better, but where an edge of the highlight is within 1e-5 rad or cells. */
void weft_weave_specular_batch(const weft_woven_table *table, weft_weave_batch *batch);

/* value[i] = weft_prepared_reflectance for light[i], view[i], within 1e-3 of it, ordinary segments within 1e-4
 * (docs/reference/models.md): a 15-point Gauss-Kronrod rule in vectors, halved where it does not agree with its Gauss
 * rule, and the converged integral where that does not settle. */
void weft_prepared_reflectance_batch(const weft_prepared_segment *prepared, int count, const weft_vec3 *light,
                                     const weft_vec3 *view, weft_real *value);

/* value[i] = weft_weave_mean_specular for light[i], view[i], within 1e-3 of it. Errors: WEFT_SYSTEM for memory. */
weft_code weft_weave_mean_specular_batch(const weft_weave *weave, int count, const weft_vec3 *light,
                                         const weft_vec3 *view, weft_real *value, weft_error *error);

/* weft_weave_specular_scale from 4096 pairs of directions: some milliseconds, within 2 % of it. The same pairs serve
 * every weave, so the ratio of two that differ little is much closer. 0 where no segment is admissible. Errors:
 * WEFT_SYSTEM for memory. */
weft_code weft_weave_specular_scale_batch(const weft_weave *weave, weft_real *scale, weft_error *error);

#endif

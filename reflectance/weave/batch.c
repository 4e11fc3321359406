#include "reflectance/weave/batch.h"

#include "base/processor.h"
#include "reflectance/weave/batch_kernels.h"
#include "reflectance/weave/direction_sequence.h"

#include <stdlib.h>

/* ---- Texture ---- */

static void fill_row(const weft_yarn *yarn, float *const column[WEFT_WOVEN_COLUMNS], int row)
{
    const weft_prepared_segment *prepared = &yarn->prepared;
    const weft_segment *segment = &prepared->segment;
    const weft_real value[WEFT_WOVEN_COLUMNS] = {
        [WEFT_WOVEN_STAPLE] = prepared->admissible && !prepared->filament,
        [WEFT_WOVEN_FILAMENT] = prepared->admissible && prepared->filament,
        [WEFT_WOVEN_WARP] = yarn->warp,
        [WEFT_WOVEN_AREA_WEIGHT] = yarn->area_weight,
        [WEFT_WOVEN_ALPHA] = segment->alpha,
        [WEFT_WOVEN_BETA] = segment->beta,
        [WEFT_WOVEN_DELTA] = segment->delta,
        [WEFT_WOVEN_UMAX] = segment->umax,
        [WEFT_WOVEN_KAPPA] = segment->kappa,
        [WEFT_WOVEN_WIDTH] = segment->width,
        [WEFT_WOVEN_LENGTH] = segment->length,
        [WEFT_WOVEN_HIGHLIGHT_WIDTH] = segment->highlight_width,
        [WEFT_WOVEN_COT_PSI] = prepared->cot_psi,
        [WEFT_WOVEN_INVERSE_SIN_PSI] = prepared->inverse_sin_psi,
        [WEFT_WOVEN_PHASE_SCALE] = prepared->phase_scale,
        [WEFT_WOVEN_RADIUS_SHARE] = prepared->radius_share,
    };
    for (int c = 0; c < WEFT_WOVEN_COLUMNS; c++)
        column[c][row] = (float)value[c];
}

weft_code weft_woven_table_create(const weft_weave *weave, weft_woven_table **result, weft_error *error)
{
    size_t count = (size_t)weave->yarn_count, bytes = WEFT_WOVEN_COLUMNS * (count + 1) * sizeof(float);
    weft_woven_table *table = calloc(1, sizeof *table);
    float *block = malloc(bytes);
    if (!table || !block) {
        free(table);
        free(block);
        return weft_fail_memory(error, "weave table", bytes);
    }
    table->yarn_count = weave->yarn_count;
    for (size_t c = 0; c < WEFT_WOVEN_COLUMNS; c++)
        table->column[c] = block + c * count;
    for (int i = 0; i < weave->yarn_count; i++) {
        const weft_prepared_segment *prepared = &weave->yarn[i].prepared;
        fill_row(&weave->yarn[i], table->column, i);
        table->any_staple |= prepared->admissible && !prepared->filament;
        table->any_filament |= prepared->admissible && prepared->filament;
    }
    *result = table;
    return WEFT_OK;
}

void weft_woven_table_free(weft_woven_table *table)
{
    if (!table)
        return;
    free(table->column[0]);
    free(table);
}

/* Vectors reach beyond the last evaluation: to yarns that exist, lit from below. */
static void pad(weft_weave_batch *batch)
{
    enum { WIDEST = WEFT_BATCH_ALIGNMENT / sizeof(float) };
    for (int i = batch->count; i % WIDEST != 0; i++) {
        batch->yarn[i] = 0;
        batch->x[i] = batch->y[i] = batch->umax_offset_rad[i] = batch->intensity[i] = 0;
        batch->light.x[i] = batch->light.y[i] = batch->light.z[i] = 0;
        batch->view.x[i] = batch->view.y[i] = batch->view.z[i] = 0;
    }
}

void weft_weave_specular_batch(const weft_woven_table *table, weft_weave_batch *batch)
{
    pad(batch);
    WEFT_DISPATCH(weft_woven_texture)(table, batch);
}

/* ---- Reflectance ---- */

void weft_prepared_reflectance_batch(const weft_prepared_segment *prepared, int count, const weft_vec3 *light,
                                     const weft_vec3 *view, weft_real *value)
{
    WEFT_DISPATCH(weft_woven_reflectance)(prepared, count, light, view, value);
}

/* The frame of weft segments is turned a quarter. */
static void turn_directions(const weft_vec3 *from, int count, weft_vec3 *to)
{
    for (int i = 0; i < count; i++)
        to[i] = weft_vec3_of(-from[i].y, from[i].x, from[i].z);
}

/* share [yarn_count]: F aw of all yarns that are alike, at the first of them; 0 at the others. */
static void sum_shares(const weft_weave *weave, weft_real *share)
{
    for (int i = 0; i < weave->yarn_count; i++)
        share[i] = 0;
    for (int i = 0; i < weave->yarn_count; i++)
        share[weave->yarn[i].alike] += weave->yarn[i].cell_fraction * weave->yarn[i].area_weight;
}

static void add_yarns(const weft_weave *weave, int count, const weft_real *share,
                      const weft_vec3 *const direction[2][2], weft_real *of_yarn, weft_real *value)
{
    for (int i = 0; i < count; i++)
        value[i] = 0;
    for (int k = 0; k < weave->yarn_count; k++) {
        int turned = !weave->yarn[k].warp;
        if (!(share[k] > 0))
            continue;
        WEFT_DISPATCH(weft_woven_reflectance)
        (&weave->yarn[k].prepared, count, direction[turned][0], direction[turned][1], of_yarn);
        for (int i = 0; i < count; i++)
            value[i] += share[k] * of_yarn[i];
    }
}

weft_code weft_weave_mean_specular_batch(const weft_weave *weave, int count, const weft_vec3 *light,
                                         const weft_vec3 *view, weft_real *value, weft_error *error)
{
    size_t n = (size_t)count + 1, numbers = n + (size_t)weave->yarn_count;
    weft_vec3 *turned = malloc(2 * n * sizeof *turned);
    weft_real *of_yarn = malloc(numbers * sizeof *of_yarn);
    weft_code code = WEFT_OK;
    if (turned && of_yarn) {
        weft_real *share = of_yarn + n;
        sum_shares(weave, share);
        turn_directions(light, count, turned);
        turn_directions(view, count, turned + n);
        const weft_vec3 *const direction[2][2] = {{light, view}, {turned, turned + n}};
        add_yarns(weave, count, share, direction, of_yarn, value);
    } else {
        code = weft_fail_memory(error, "directions", 2 * n * sizeof *turned + numbers * sizeof *of_yarn);
    }
    free(turned);
    free(of_yarn);
    return code;
}

/* ---- The scale ---- */

enum { PAIRS = 4096, DIMENSIONS = 4 };

typedef struct direction_pairs {
    weft_vec3 light[PAIRS], view[PAIRS];
    weft_real value[PAIRS];
} direction_pairs;

static void spread(direction_pairs *pairs)
{
    double step[DIMENSIONS];
    recurrence_steps(DIMENSIONS, step);
    for (int k = 0; k < PAIRS; k++) {
        pairs->light[k] = cosine_weighted(recurrence_at(step[0], k + 1), recurrence_at(step[1], k + 1));
        pairs->view[k] = cosine_weighted(recurrence_at(step[2], k + 1), recurrence_at(step[3], k + 1));
    }
}

weft_code weft_weave_specular_scale_batch(const weft_weave *weave, weft_real *scale, weft_error *error)
{
    direction_pairs *pairs = malloc(sizeof *pairs);
    double sum = 0;
    if (!pairs)
        return weft_fail_memory(error, "directions", sizeof *pairs);
    spread(pairs);
    weft_code code = weft_weave_mean_specular_batch(weave, PAIRS, pairs->light, pairs->view, pairs->value, error);
    for (int k = 0; code == WEFT_OK && k < PAIRS; k++)
        sum += (double)pairs->value[k];
    *scale = sum > 0 ? (weft_real)(PAIRS / (sum * (double)WEFT_PI)) : 0;
    free(pairs);
    return code;
}

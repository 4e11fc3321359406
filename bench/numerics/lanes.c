/* The set of what is computed in vectors of floats (reflectance/weave/batch.h), one value at a time. */
#include "bench/numerics/take.h"
#include "reflectance/weave/batch.h"

#include <float.h>

/* A weave of one warp yarn that is all of its cloth: its specular value is the texture of the segment. */
typedef struct single_yarn {
    weft_weave weave;
    weft_yarn yarn;
    int pattern;
} single_yarn;

static void single_yarn_of(const double **a, bool with_highlight_width, single_yarn *single)
{
    weft_segment segment = {.alpha = take(a), .highlight_width = 1};
    segment.beta = take(a);
    segment.delta = take(a);
    segment.psi = take(a);
    segment.umax = take(a);
    segment.kappa = take(a);
    segment.width = take(a);
    segment.length = take(a);
    if (with_highlight_width)
        segment.highlight_width = take(a);
    *single = (single_yarn){.yarn = {.segment = segment, .warp = true}};
    single->weave = (weft_weave){.tile_width = 1, .tile_height = 1, .warp_area = 1, .yarn_count = 1};
    single->weave.pattern = &single->pattern;
    single->weave.yarn = &single->yarn;
    weft_weave_update_yarns(&single->weave);
}

static numerics_value lanes_texture(const double *a)
{
    static _Thread_local weft_weave_batch batch;
    single_yarn single;
    weft_woven_table *table;
    weft_error error;
    single_yarn_of(&a, true, &single);
    weft_weave_point point = {.x = take(&a), .intensity = 1};
    point.y = take(&a);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    if (weft_woven_table_create(&single.weave, &table, &error) != WEFT_OK)
        return plain_value(NAN);
    batch.count = 0;
    weft_weave_batch_put(&batch, &point, light, view);
    weft_weave_specular_batch(table, &batch);
    weft_woven_table_free(table);
    return plain_value((double)batch.specular[0]);
}

static numerics_value lanes_reflectance(const double *a)
{
    single_yarn single;
    single_yarn_of(&a, false, &single);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    weft_prepared_segment prepared = weft_segment_prepare(&single.yarn.segment);
    weft_real value;
    weft_prepared_reflectance_batch(&prepared, 1, &light, &view, &value);
    return plain_value(value);
}

static bool nothing_to_begin(void)
{
    return true;
}

const numerics_set numerics_lanes = {.name = "vectors of floats",
                                     .roundoff = (double)(FLT_EPSILON / 2),
                                     .single = true,
                                     .begin = nothing_to_begin,
                                     .function = {[NUMERICS_STAPLE_TEXTURE] = lanes_texture,
                                                  [NUMERICS_FILAMENT_TEXTURE] = lanes_texture,
                                                  [NUMERICS_STAPLE_REFLECTANCE] = lanes_reflectance,
                                                  [NUMERICS_FILAMENT_REFLECTANCE] = lanes_reflectance}};

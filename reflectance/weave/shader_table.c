#include "reflectance/weave/shader_table.h"

#include "btf/direction/direction.h"

#include <string.h>

static void put(float texel[4], weft_real x, weft_real y, weft_real z, weft_real w)
{
    texel[0] = (float)x;
    texel[1] = (float)y;
    texel[2] = (float)z;
    texel[3] = (float)w;
}

static void put_header(const weft_weave *weave, float (*texel)[4])
{
    const weft_real *noise_deg = weave->inclination_noise_deg;
    put(texel[0], (weft_real)weave->tile_width, (weft_real)weave->tile_height, (weft_real)weave->yarn_count, 0);
    put(texel[1], weave->fineness, weave->period, 0, 0);
    put(texel[2], weft_rad_of_deg(noise_deg[0]), weft_rad_of_deg(noise_deg[1]), weft_rad_of_deg(noise_deg[2]),
        weft_rad_of_deg(noise_deg[3]));
}

static void put_yarn(const weft_yarn *yarn, weft_real scale, float (*texel)[4])
{
    const weft_prepared_segment *prepared = &yarn->prepared;
    const weft_segment *segment = &prepared->segment;
    put(texel[0], segment->alpha, segment->beta, segment->delta, prepared->phase_scale);
    put(texel[1], prepared->cot_psi, prepared->inverse_sin_psi, segment->umax, segment->kappa);
    put(texel[2], segment->width, segment->length, segment->highlight_width, yarn->admissible ? yarn->area_weight : 0);
    put(texel[3], yarn->center_u, yarn->center_v, yarn->warp, yarn->min_umax);
    put(texel[4], yarn->kd.r, yarn->kd.g, yarn->kd.b, yarn->max_umax);
    put(texel[5], yarn->ks.r * scale, yarn->ks.g * scale, yarn->ks.b * scale, prepared->radius_share);
}

void weft_weave_table(const weft_weave *weave, float *rgba, int *width, int *height)
{
    int cells = weave->tile_width * weave->tile_height;
    int pattern_start = WEFT_WEAVE_TABLE_HEADER + WEFT_WEAVE_TABLE_YARN * weave->yarn_count;
    int texels = pattern_start + (cells + 3) / 4;
    *width = WEFT_WEAVE_TABLE_WIDTH;
    *height = (texels + WEFT_WEAVE_TABLE_WIDTH - 1) / WEFT_WEAVE_TABLE_WIDTH;
    if (!rgba)
        return;
    memset(rgba, 0, (size_t)*width * (size_t)*height * 4 * sizeof *rgba);
    float(*texel)[4] = (float(*)[4])(void *)rgba;
    put_header(weave, texel);
    for (int k = 0; k < weave->yarn_count; k++)
        put_yarn(&weave->yarn[k], weave->specular_scale,
                 texel + WEFT_WEAVE_TABLE_HEADER + WEFT_WEAVE_TABLE_YARN * (size_t)k);
    for (int cell = 0; cell < cells; cell++)
        texel[pattern_start + cell / 4][cell % 4] = (float)weave->pattern[cell];
}

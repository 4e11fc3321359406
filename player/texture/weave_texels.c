#include "player/texture/weave_texels.h"

#include "reflectance/weave/batch.h"
#include "reflectance/weave/shader_table.h"

#include <stdlib.h>

enum { DIRECTIONS = WEFT_UBO81_COUNT, PAIRS = DIRECTIONS * (DIRECTIONS + 1) / 2 };

/* The mean is reciprocal: pairs with light <= view are enough. */
typedef struct pair_list {
    int first[PAIRS], second[PAIRS];           /* texels of the pair and of its opposite */
    weft_vec3 light[2][PAIRS], view[2][PAIRS]; /* in the frame of a warp, of a weft */
    weft_real value[PAIRS], mean[PAIRS];
} pair_list;

static void list_pairs(pair_list *list)
{
    int i = 0;
    for (int view = 0; view < DIRECTIONS; view++) {
        for (int light = 0; light <= view; light++, i++) {
            weft_vec3 l = weft_direction_of_angles(weft_ubo81_angles(light));
            weft_vec3 v = weft_direction_of_angles(weft_ubo81_angles(view));
            list->first[i] = view * DIRECTIONS + light;
            list->second[i] = light * DIRECTIONS + view;
            list->light[0][i] = l;
            list->view[0][i] = v;
            list->light[1][i] = weft_vec3_of(-l.y, l.x, l.z);
            list->view[1][i] = weft_vec3_of(-v.y, v.x, v.z);
        }
    }
}

static void add(float texel[4], weft_rgb colour, weft_real factor)
{
    texel[0] += (float)(colour.r * factor);
    texel[1] += (float)(colour.g * factor);
    texel[2] += (float)(colour.b * factor);
}

static void add_diffuse(const weft_weave *weave, float (*mean)[4])
{
    float sum[4] = {0, 0, 0, 1};
    for (int k = 0; k < weave->yarn_count; k++)
        add(sum, weave->yarn[k].kd, weave->yarn[k].cell_fraction / (weft_real)WEFT_PI);
    for (int i = 0; i < DIRECTIONS * DIRECTIONS; i++)
        for (int c = 0; c < 4; c++)
            mean[i][c] = sum[c];
}

/* Sum of F aw s ks over the yarns alike. */
static weft_rgb colour_of_kind(const weft_weave *weave, int kind)
{
    float sum[4] = {0};
    for (int k = kind; k < weave->yarn_count; k++) {
        const weft_yarn *yarn = &weave->yarn[k];
        if (yarn->alike == kind)
            add(sum, yarn->ks, yarn->cell_fraction * yarn->area_weight * weave->specular_scale);
    }
    return (weft_rgb){(weft_real)sum[0], (weft_real)sum[1], (weft_real)sum[2]};
}

/* f_s for all pairs, in the mean over the inclinations of its segments. */
static void evaluate_noisy(const weft_weave *weave, int kind, pair_list *list, weft_real sum[PAIRS])
{
    const weft_yarn *yarn = &weave->yarn[kind];
    weft_real offset_rad[WEFT_WEAVE_OFFSETS];
    int frame = yarn->warp ? 0 : 1;
    weft_weave_umax_offsets(weave, kind, offset_rad);
    for (int i = 0; i < PAIRS; i++)
        sum[i] = 0;
    for (int k = 0; k < WEFT_WEAVE_OFFSETS; k++) {
        weft_segment segment = yarn->segment;
        segment.umax += offset_rad[k];
        const weft_prepared_segment prepared = weft_segment_prepare(&segment);
        weft_prepared_reflectance_batch(&prepared, PAIRS, list->light[frame], list->view[frame], list->value);
        for (int i = 0; i < PAIRS; i++)
            sum[i] += list->value[i] / WEFT_WEAVE_OFFSETS;
    }
}

static void add_kind(const weft_weave *weave, int kind, bool noisy, pair_list *list, float (*mean)[4])
{
    const weft_yarn *yarn = &weave->yarn[kind];
    weft_rgb colour = colour_of_kind(weave, kind);
    int frame = yarn->warp ? 0 : 1;
    if (!(colour.r + colour.g + colour.b > 0))
        return;
    if (noisy)
        evaluate_noisy(weave, kind, list, list->mean);
    else
        weft_prepared_reflectance_batch(&yarn->prepared, PAIRS, list->light[frame], list->view[frame], list->mean);
    for (int i = 0; i < PAIRS; i++) {
        add(mean[list->first[i]], colour, list->mean[i]);
        if (list->second[i] != list->first[i])
            add(mean[list->second[i]], colour, list->mean[i]);
    }
}

/* *mean: [DIRECTIONS * DIRECTIONS], of the caller's even on failure. */
static weft_code tabulate_mean(const weft_weave *weave, bool noisy, float (**mean)[4], weft_error *error)
{
    pair_list *list = malloc(sizeof *list);
    *mean = calloc(DIRECTIONS * DIRECTIONS, sizeof **mean);
    if (!list || !*mean) {
        free(list);
        return weft_fail_memory(error, "mean of a weave", sizeof *list + DIRECTIONS * DIRECTIONS * sizeof **mean);
    }
    list_pairs(list);
    add_diffuse(weave, *mean);
    for (int k = 0; k < weave->yarn_count; k++)
        if (weave->yarn[k].alike == k)
            add_kind(weave, k, noisy, list, *mean);
    free(list);
    return WEFT_OK;
}

static bool inclines(const weft_weave *weave)
{
    const weft_real *amplitude = weave->inclination_noise_deg;
    return weave->period > 0 && (amplitude[0] != 0 || amplitude[1] != 0 || amplitude[2] != 0 || amplitude[3] != 0);
}

weft_code weft_weave_texels_of(const weft_weave *weave, weft_weave_texels *t, weft_error *error)
{
    *t = (weft_weave_texels){.tile_width = weave->tile_width,
                             .tile_height = weave->tile_height,
                             .has_noise = weave->fineness > 0 || inclines(weave)};
    weft_weave_table(weave, NULL, &t->width, &t->height);
    size_t texels = (size_t)t->width * (size_t)t->height;
    t->table = calloc(texels, sizeof *t->table);
    if (!t->table)
        return weft_fail_memory(error, "weave", texels * sizeof *t->table);
    weft_weave_table(weave, t->table[0], &t->width, &t->height);
    WEFT_TRY(tabulate_mean(weave, false, &t->mean, error));
    return inclines(weave) ? tabulate_mean(weave, true, &t->noisy_mean, error) : WEFT_OK;
}

void weft_weave_texels_free(weft_weave_texels *t)
{
    free(t->table);
    free(t->mean);
    free(t->noisy_mean);
    *t = (weft_weave_texels){0};
}

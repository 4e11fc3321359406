#include "edit/blend/blend.h"

#include "btf/material/gather.h"
#include "btf/material/metadata.h"
#include "edit/blend/steps.h"

#include <jansson.h>
#include <stdlib.h>

/* ---- Where each texel comes from ---- */

static void put_part(weft_texel_mix *mix, int x, int y, float weight)
{
    int at = WEFT_MIX_TEXELS - 1;
    for (; at > 0 && weight > mix->part[at - 1].weight; at--)
        mix->part[at] = mix->part[at - 1];
    mix->part[at].x = x;
    mix->part[at].y = y;
    mix->part[at].weight = weight;
}

/* Column x of the material that is `across` wide, in row y of the material; `weight` is of the row. */
static void put_row(const weft_cut *across, int x, int y, float weight, weft_texel_mix *mix)
{
    float share = weft_cut_share(across, x, y);
    put_part(mix, x, y, weight * (1 - share));
    if (share > 0)
        put_part(mix, x + across->size, y, weight * share);
}

/* `down` was found in pictures with x and y exchanged: its rows are columns. */
static weft_texel_mix mix_of(const weft_cut *across, const weft_cut *down, int x, int y)
{
    weft_texel_mix mix = {0};
    float share = weft_cut_share(down, y, x);
    put_row(across, x, y, 1 - share, &mix);
    if (share > 0)
        put_row(across, x, y + down->size, share, &mix);
    return mix;
}

static weft_code find_down(const weft_blend_pictures *pictures, const weft_cut *across, weft_cut *down,
                           weft_error *error)
{
    weft_blend_pictures round = {0}, turned = {0};
    weft_code code = weft_cut_apply(pictures, across, &round, error);
    if (code == WEFT_OK)
        code = weft_blend_pictures_transpose(&round, &turned, error);
    if (code == WEFT_OK)
        code = weft_cut_find(&turned, true, down, error);
    weft_blend_pictures_free(&turned);
    weft_blend_pictures_free(&round);
    return code;
}

static weft_code find_mix(const weft_blend_pictures *pictures, weft_blend_report *report, weft_texel_mix **mix,
                          weft_error *error)
{
    weft_cut across = {0}, down = {0};
    weft_code code = weft_cut_find(pictures, false, &across, error);
    if (code == WEFT_OK)
        code = find_down(pictures, &across, &down, error);
    size_t texels = (size_t)across.size * (size_t)down.size;
    if (code == WEFT_OK && !(*mix = malloc(texels * sizeof **mix)))
        code = weft_fail_memory(error, "places of texels", texels * sizeof **mix);
    for (size_t i = 0; i < texels && code == WEFT_OK; i++)
        (*mix)[i] = mix_of(&across, &down, (int)(i % (size_t)across.size), (int)(i / (size_t)across.size));
    report->width = across.size;
    report->height = down.size;
    report->overlap_x = across.overlap;
    report->overlap_y = down.overlap;
    weft_cut_free(&across);
    weft_cut_free(&down);
    return code;
}

/* ---- What was done ---- */

static json_t *describe_seam(const weft_seam *seam)
{
    return json_pack("{s:I, s:f, s:f, s:f}", "pairs", (json_int_t)seam->pair_count, "above_99th", seam->above_99th,
                     "strongest", seam->strongest, "mean_difference", seam->mean_difference);
}

static weft_code describe(const weft_blend_report *report, weft_material *tile, weft_error *error)
{
    json_t *done = json_pack("{s:[i, i], s:o, s:o}", "overlap_texels", report->overlap_x, report->overlap_y, "before",
                             describe_seam(&report->before), "after", describe_seam(&report->after));
    return weft_material_put_metadata(tile, "tile", done, error);
}

/* Under directions by which the cut was not chosen. */
static weft_code measure(const weft_material *material, const weft_texel_mix *mix, const weft_material *tile,
                         weft_blend_report *report, weft_error *error)
{
    weft_blend_pictures whole = {0}, tiled = {0};
    weft_code code = weft_blend_pictures_make(material, WEFT_BLEND_JUDGES, &whole, error);
    if (code == WEFT_OK)
        code = weft_blend_pictures_make(tile, WEFT_BLEND_JUDGES, &tiled, error);
    if (code == WEFT_OK)
        code = weft_seam_measure(&whole, &whole, NULL, &report->before, error);
    if (code == WEFT_OK)
        code = weft_seam_measure(&whole, &tiled, mix, &report->after, error);
    weft_blend_pictures_free(&tiled);
    weft_blend_pictures_free(&whole);
    return code;
}

static weft_code make_tile(const weft_material *material, const weft_texel_mix *mix, weft_material *tile,
                           weft_blend_report *report, weft_error *error)
{
    WEFT_TRY(weft_material_gather(material, report->width, report->height, mix, tile, error));
    weft_code code = weft_blend_spread(material, mix, tile, error);
    if (code == WEFT_OK)
        code = measure(material, mix, tile, report, error);
    if (code == WEFT_OK)
        code = describe(report, tile, error);
    if (code != WEFT_OK)
        weft_material_free(tile);
    return code;
}

/* The pictures are the larger part of the memory: they are gone before the tile is made. */
static weft_code choose_mix(const weft_material *material, weft_blend_report *report, weft_texel_mix **mix,
                            weft_error *error)
{
    weft_blend_pictures pictures;
    WEFT_TRY(weft_blend_pictures_make(material, WEFT_BLEND_CHOOSES, &pictures, error));
    weft_code code = find_mix(&pictures, report, mix, error);
    weft_blend_pictures_free(&pictures);
    return code;
}

static weft_code check_size(const weft_material *material, weft_error *error)
{
    const weft_material_level *level = &material->level[0];
    if (level->width < WEFT_CUT_LEAST_SIDE || level->height < WEFT_CUT_LEAST_SIDE)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "the material has %d x %d texels; at least %d x %d are needed to cut it", level->width,
                         level->height, WEFT_CUT_LEAST_SIDE, WEFT_CUT_LEAST_SIDE);
    return WEFT_OK;
}

weft_code weft_seam_of_material(const weft_material *material, weft_seam *seam, weft_error *error)
{
    weft_blend_pictures pictures;
    WEFT_TRY(check_size(material, error));
    WEFT_TRY(weft_blend_pictures_make(material, WEFT_BLEND_JUDGES, &pictures, error));
    weft_code code = weft_seam_measure(&pictures, &pictures, NULL, seam, error);
    weft_blend_pictures_free(&pictures);
    return code;
}

weft_code weft_blend(const weft_material *material, weft_material *tile, weft_blend_report *report, weft_error *error)
{
    *tile = (weft_material){0};
    *report = (weft_blend_report){0};
    WEFT_TRY(check_size(material, error));
    weft_texel_mix *mix = NULL;
    weft_code code = choose_mix(material, report, &mix, error);
    if (code == WEFT_OK)
        code = make_tile(material, mix, tile, report, error);
    free(mix);
    return code;
}

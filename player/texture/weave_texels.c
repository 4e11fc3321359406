#include "player/texture/weave_texels.h"

#include <stdlib.h>

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
    WEFT_TRY(weft_weave_means_of(weave, false, &t->means, error));
    return inclines(weave) ? weft_weave_means_of(weave, true, &t->noisy_means, error) : WEFT_OK;
}

void weft_weave_texels_free(weft_weave_texels *t)
{
    free(t->table);
    weft_weave_means_free(&t->means);
    weft_weave_means_free(&t->noisy_means);
    *t = (weft_weave_texels){0};
}

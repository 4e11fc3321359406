/* The models that a texel may have, from the smallest to the whole. Pure. */
#ifndef WEFT_COMPRESS_TEXEL_MODEL_LADDER_H
#define WEFT_COMPRESS_TEXEL_MODEL_LADDER_H

#include "compress/fit/fit.h"

enum { WEFT_MODEL_LADDER_MOST = 2 * (WEFT_MATERIAL_MAX_LOBES + 1) };

typedef struct weft_texel_model {
    int lobe_count;
    bool table;
} weft_texel_model;

typedef struct weft_model_ladder {
    int count;
    weft_texel_model model[WEFT_MODEL_LADDER_MOST]; /* by rising size; the last is the whole model */
} weft_model_ladder;

/* Bytes of a model without its frame and before any coding: rho, lobes as half floats, T with its opacity. */
int weft_texel_model_bytes(weft_texel_model model, int view_count);

/* All models that leave something out of `whole`, and that itself. */
weft_model_ladder weft_model_ladder_make(const weft_fit_options *whole, int view_count);

#endif

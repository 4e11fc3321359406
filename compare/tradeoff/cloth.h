/* Analytic cloth on a price list: a weave that is fitted to photographs, or microcylinder cloth as its file gives it.
 */
#ifndef WEFT_COMPARE_TRADEOFF_CLOTH_H
#define WEFT_COMPARE_TRADEOFF_CLOTH_H

#include "btf/dataset/dataset.h"
#include "compress/hold_out/texel_subset.h"
#include "evaluate/error/predictor.h"
#include "reflectance/microcylinder/file.h"
#include "reflectance/weave/weave.h"

typedef struct weft_priced_cloth {
    bool is_threads;
    weft_weave weave;                       /* a weave */
    weft_microcylinder_description threads; /* or microcylinder cloth */
    bool is_fitted;                         /* a weave: it lies on what it was fitted to, no more on the whole */
    double fit_s;                           /* 0 of microcylinder cloth */
} weft_priced_cloth;

/* Reads a .wv or .mc file. The caller frees *cloth. Errors: those of reading; WEFT_BAD_INPUT for another kind of file.
 */
weft_code weft_priced_cloth_open(const char *path, weft_priced_cloth *cloth, weft_error *error);
void weft_priced_cloth_free(weft_priced_cloth *cloth);

/* Fits a weave to a dataset (compress/weave_fit/fit_weave.h), on which it then lies; does nothing to microcylinder
 * cloth, which has no fit. Errors: those of the fit. */
weft_code weft_priced_cloth_fit(weft_priced_cloth *cloth, weft_dataset *dataset, weft_error *error);

/* Writes a weave to `path`. Errors: WEFT_SYSTEM. */
weft_code weft_priced_cloth_write(const weft_priced_cloth *cloth, const char *path, weft_error *error);

/* What the cloth says of a block of texels (WEFT_TEXEL_SUBSET_BLOCK): as a weave lies that was fitted to this block,
 * else as its file lays it on the whole dataset. The cloth and the subset must outlive *predictor, which the caller
 * frees. Errors: WEFT_SYSTEM for memory. */
weft_code weft_priced_cloth_predictor(const weft_priced_cloth *cloth, const weft_texel_subset *subset,
                                      weft_predictor **predictor, weft_error *error);

#endif

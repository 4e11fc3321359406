/* What a model costs: bytes, time to fit, time to evaluate and to draw. */
#ifndef WEFT_COMPARE_TRADEOFF_PRICE_H
#define WEFT_COMPARE_TRADEOFF_PRICE_H

#include "base/progress.h"
#include "compare/tradeoff/priced_model.h"

typedef struct weft_price {
    int photograph_count;        /* that it is made of */
    double bytes;                /* of the file */
    double bits_a_texel;         /* of the dataset */
    double fit_s;                /* of the whole dataset */
    double evaluations_a_second; /* of one thread: BRDFs at places and directions drawn at random */
    double frame_ms;             /* 730 x 400 pixels; 0 where it was not drawn, as BARD, which nothing plays */
    bool has_flicker;            /* of BARD there is none */
    double flicker;              /* compare/tradeoff/flicker.h */
} weft_price;

/* A shop that fits all of the texels of a dataset, or the middle ones. */
typedef struct weft_price_shop weft_price_shop;

/* A dataset of at most side x side texels is fitted whole; of a larger one a block of as many, with bytes and times in
 * proportion (files are packed, so that bytes of few texels are not quite in proportion). Files are written to the
 * folder of `scratch_path`, and are gone afterwards. Both arguments must outlive the shop. The caller frees it. Errors:
 * those of reading and writing. */
weft_code weft_price_shop_open(weft_dataset *dataset, int side, const char *scratch_path, const weft_progress *progress,
                               weft_price_shop **result, weft_error *error);
void weft_price_shop_close(weft_price_shop *shop);

/* Texels that are fitted. */
long weft_price_shop_texels(const weft_price_shop *shop);

/* Why nothing is drawn, or "". */
const char *weft_price_shop_why_not_drawn(const weft_price_shop *shop);
/* Who draws, or "". */
const char *weft_price_shop_renderer(const weft_price_shop *shop);

/* Fits the model, unless the one before has the same fit, and weighs and times it. Errors: those of weft_compress, of
 * writing and drawing. */
weft_code weft_price_ask(weft_price_shop *shop, const weft_priced_model *model, weft_price *price, weft_error *error);

#endif

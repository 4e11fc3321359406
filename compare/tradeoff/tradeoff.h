/* The price list of a material: what each model of it costs, and how far it is from photographs that it was not fitted
 * to (docs/guide/tradeoff.md). */
#ifndef WEFT_COMPARE_TRADEOFF_TRADEOFF_H
#define WEFT_COMPARE_TRADEOFF_TRADEOFF_H

#include "base/progress.h"
#include "compare/tradeoff/held_error.h"
#include "compare/tradeoff/priced_model.h"
#include "evaluate/model.h"

#include <jansson.h>
#include <stddef.h>

/* ---- Price ---- */

/* What a model costs: bytes, time to fit, time to evaluate and to draw. */

typedef struct weft_price {
    int photograph_count;        /* that it is made of */
    double bytes;                /* of the file */
    double bits_a_texel;         /* of the dataset */
    double fit_s;                /* of the whole dataset */
    double evaluations_a_second; /* of one thread: BRDFs at places and directions drawn at random */
    double frame_ms;  /* 730 x 400 pixels; 0 where it was not drawn, as BARD, RTI and matrices, which nothing plays */
    bool has_flicker; /* not of BARD, RTI and matrices */
    double flicker;   /* below */
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

/* ---- The list ---- */

typedef struct weft_tradeoff_row {
    weft_priced_model model;
    weft_price price;
    weft_held_error measured;
    bool is_chosen[WEFT_PRESET_COUNT]; /* by each preset; by [WEFT_PRESET_NONE] where by any */
    bool is_of_neighbours; /* its error is that of the texels of its pictures, not of those that lie spread */
    bool is_beaten;        /* by another that weft compress makes (compare/tradeoff/priced_model.h) */
} weft_tradeoff_row;

/* Freed with weft_tradeoff_free. */
typedef struct weft_tradeoff {
    int row_count;
    weft_tradeoff_row row[WEFT_PRICED_MOST];
    int width, height, image_count, view_count; /* of the dataset */
    weft_split_kind kind;
    int view_held_count, light_held_count, light_count, image_held_count;
    int split_count;      /* of errors; those of neighbours are of the first split alone */
    long measured_texels; /* whose error is measured: of components and photographs, ... */
    long lobe_texels;     /* ... of lobes, ... */
    long neighbours;      /* ... and of pictures */
    long fitted_texels;   /* for prices */
    long texels;          /* of the dataset */
    int threads;
    double seconds;
    char why_not_drawn[WEFT_MESSAGE_SIZE], renderer[128];
} weft_tradeoff;

/* Fits and measures every model of compare/tradeoff/priced_model.h, with the analytic cloth of the file `cloth` (a
 * weave, which is fitted, or microcylinder cloth, as it is; NULL: none), and writes folder/index.html with its pictures
 * and folder/tradeoff.csv; the page appears when it is complete. Errors are measured on the texels and the splits of
 * weft_hold_out_measure, as weft compress says them of a material; pictures on a block of at most 32 x 32 neighbouring
 * texels, and so are the errors of what needs neighbours: cloth, and all where the dataset has a surface, near lights
 * or a handful of photographs. Prices are of a block of at most 64 x 64.
 * Errors: WEFT_BAD_USAGE for a dataset of one image; those of weft_compress, of reading, writing and drawing. */
weft_code weft_tradeoff_study(const char *dataset_path, const char *cloth, const char *folder,
                              const weft_progress *progress, weft_tradeoff *result, weft_error *error);
void weft_tradeoff_free(weft_tradeoff *tradeoff);

/* "8 of 81 views and 8 of 81 lights": what was held out of the fits. */
void weft_tradeoff_print_held(const weft_tradeoff *tradeoff, char *text, size_t size);

/* "small", "small, balanced": the presets that choose a row; "" where none does. */
void weft_tradeoff_print_presets(const weft_tradeoff_row *row, char *text, size_t size);

/* A row as JSON. The caller owns it; NULL where memory is short. */
json_t *weft_tradeoff_row_to_json(const weft_tradeoff_row *row);

/* Writes the rows as a table of comma-separated values, atomically. Errors: WEFT_SYSTEM. */
weft_code weft_tradeoff_write_csv(const weft_tradeoff *tradeoff, const char *path, weft_error *error);

/* Writes the page with its pictures. Errors: WEFT_SYSTEM. */
weft_code weft_tradeoff_write_page(const weft_tradeoff *tradeoff, const char *dataset_path, const char *folder,
                                   weft_error *error);

/* ---- Flicker ---- */

/* Flicker: how much more the brightness of a place goes up and down than once, while a light sweeps across it. */

/* What a series of `count` values goes up and down in all, and what it would if it rose once to its largest value and
 * then fell. Adds to both. Pure. */
typedef struct weft_flicker {
    double moved, needed;
} weft_flicker;
void weft_flicker_add(const double *value, int count, weft_flicker *flicker);

/* moved / needed - 1: 0 for a highlight that comes and goes once, 1 where the brightness goes up and down twice as far.
 * 0 where nothing moves. Pure. */
double weft_flicker_excess(const weft_flicker *flicker);

/* Of a model of any kind: at 16 places, seen from 30 degrees in four directions, a light passes from 65 degrees on the
 * side of the eye through the normal and the mirror direction to 65 degrees, in steps of 2.5 degrees, finer than
 * directions are photographed. Values are reflectance times cosine, the mean of the channels. A value that is not known
 * is left out. Errors: those of weft_model_brdf. */
weft_code weft_flicker_measure(weft_model *model, double *excess, weft_error *error);

#endif

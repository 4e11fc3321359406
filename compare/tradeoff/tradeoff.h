/* The price list of a material: what each model of it costs, and how far it is from photographs that it was not fitted
 * to (docs/guide/tradeoff.md). */
#ifndef WEFT_COMPARE_TRADEOFF_TRADEOFF_H
#define WEFT_COMPARE_TRADEOFF_TRADEOFF_H

#include "compare/tradeoff/choice.h"
#include "compare/tradeoff/held_error.h"
#include "compare/tradeoff/price.h"

#include <jansson.h>

typedef struct weft_tradeoff_row {
    weft_priced_model model;
    weft_price price;
    weft_held_error measured;
    bool is_chosen[WEFT_PRESET_COUNT]; /* by each preset; by [WEFT_PRESET_NONE] where by any */
    bool is_of_neighbours; /* its error is that of the texels of its pictures, not of those that lie spread */
    bool is_beaten;        /* by another that weft compress makes (compare/tradeoff/choice.h) */
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

#endif

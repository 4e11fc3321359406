/* The error of a model on images that it was not fitted to, in all of them and where eyes look. */
#ifndef WEFT_COMPARE_TRADEOFF_HELD_ERROR_H
#define WEFT_COMPARE_TRADEOFF_HELD_ERROR_H

#include "base/picture/image.h"
#include "compare/pictures/picture_quality.h"
#include "compare/tradeoff/priced_model.h"
#include "compare/tradeoff/weight.h"
#include "compress/hold_out/split.h"
#include "compress/hold_out/texel_subset.h"
#include "compress/hold_out/trial.h"

/* ---- Kinds of samples ---- */

/* Samples of a subset told apart where eyes look. */

/* Which samples. A texel's brightness in an image is the mean of its channels, divided by the cosine of the light where
 * the dataset holds that. */
typedef enum weft_sample_kind {
    WEFT_SAMPLES_ALL,
    WEFT_SAMPLES_GRAZING,    /* view or light 52.5 degrees or more from the normal: the ring of 60 degrees or beyond */
    WEFT_SAMPLES_HIGHLIGHTS, /* the brightest twentieth of each texel over all images */
    WEFT_SAMPLES_SHADOWS,    /* the darkest fifth */
    WEFT_SAMPLE_KINDS
} weft_sample_kind;

/* "all", "grazing", "highlights", "shadows". Pure. */
const char *weft_sample_kind_name(weft_sample_kind kind);

/* Of every sample the bits 1 << weft_sample_kind: *kinds [texel][image], which the caller frees, also on failure.
 * Errors: WEFT_SYSTEM for memory. */
weft_code weft_sample_kinds_mark(const weft_texel_subset *subset, uint8_t **kinds, weft_error *error);

typedef struct weft_held_error {
    weft_error_summary held[WEFT_SAMPLE_KINDS], fitted[WEFT_SAMPLE_KINDS];
    double interval_width;        /* mean width of the interval of 95 % (compress/hold_out/certify.h) that these samples
                                     give, in units of the mean sample; 0 where all is black */
    int picture_count;            /* of held-out images whose texels are neighbours */
    weft_picture_quality quality; /* means over their pixels, each picture shown as its photograph needs; PSNR: of the
                                     pictures' decibels, weighted by pixels */
    long picture_pixels;          /* of these */
    double fit_s;
    weft_weight weight;           /* of the fit without what is held out */
    int worst_image;              /* the picture with the largest relative RMSE */
    weft_image sample, predicted; /* of it, sRGB encoded; empty without pictures */
} weft_held_error;
void weft_held_error_free(weft_held_error *measured);

/* Which splits are measured, with others for other numbers (compress/hold_out/split.h): 1 .. WEFT_HOLD_OUT_ENOUGH.
 * Their samples count together. */
typedef struct weft_splits_asked {
    uint64_t first;
    int count;
} weft_splits_asked;

/* Some texels of a dataset, and the images that are held out of them. */
typedef struct weft_held_bench weft_held_bench;

/* Reads at most side x side texels of the kind, of which `asked` says which directions are held out; of a handful of
 * images each is in turn. Pictures are compared where texels are neighbours (WEFT_TEXEL_SUBSET_BLOCK). Files are
 * written to the folder of `scratch_path`, nameless once they are complete. The caller frees. Of a dataset with a
 * surface the kind is to be WEFT_TEXEL_SUBSET_BLOCK: then more are read, to which components are fitted, and those in
 * the middle are measured, of which all models are asked for what is known through the surface alone. Dataset and path
 * must outlive the bench. Errors: those of weft_splits_create and of reading. */
weft_code weft_held_bench_create(weft_dataset *dataset, weft_texel_subset_kind kind, int side, weft_splits_asked asked,
                                 const char *scratch_path, weft_held_bench **result, weft_error *error);
void weft_held_bench_free(weft_held_bench *bench);

/* How many texels are measured, and what is held out of them. */
long weft_held_bench_texels(const weft_held_bench *bench);
const weft_splits *weft_held_bench_splits(const weft_held_bench *bench);

/* The pictures alone, by the first split, of a bench that has them: errors and the interval stay 0. The fit is that of
 * weft_held_bench_measure, which may be asked before and after. The caller frees *measured. Errors: those of
 * weft_compress. */
weft_code weft_held_bench_picture(weft_held_bench *bench, const weft_priced_model *model, weft_held_error *measured,
                                  weft_error *error);

/* Fits the model without what is held out, and measures it there. The fit of the model before is used again where it is
 * the same. The caller frees *measured. Errors: those of weft_compress; WEFT_BAD_USAGE where all that is held out is
 * masked. */
weft_code weft_held_bench_measure(weft_held_bench *bench, const weft_priced_model *model, weft_held_error *measured,
                                  weft_error *error);

/* ---- Pictures ---- */

/* Held-out images beside what a model makes of them, as pictures. */

enum { WEFT_HELD_PICTURES = 64 };

/* Of the images with the most reasons to be held out all, or WEFT_HELD_PICTURES of them, evenly, in their order: sets
 * image and returns how many. Reads the held-out images of the trial and their flags alone. Pure. */
int weft_held_pictures_choose(const weft_trial *trial, int image[WEFT_HELD_PICTURES]);

/* Lets the trial ask for these images alone, and for no fitted ones; weft_held_pictures_choose chooses the same again.
 */
void weft_held_pictures_keep(weft_trial *trial);

/* Compares some images that a trial holds out, of those with the most reasons to be, with what is said of them, under
 * the exposure that the photograph needs. Masked texels are black in both and do not count. Sets the pictures and their
 * quality in `measured`. Errors: WEFT_SYSTEM. */
weft_code weft_held_pictures_compare(const weft_trial *trial, const weft_asked_samples *said, weft_held_error *measured,
                                     weft_error *error);

#endif

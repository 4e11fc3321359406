/* One split of some texels at work: what models say of the images that it holds out and, to tell what being fitted is
 * worth, of as many from the same rings that were fitted: those that the next split holds out. */
#ifndef WEFT_COMPRESS_HOLD_OUT_TRIAL_H
#define WEFT_COMPRESS_HOLD_OUT_TRIAL_H

#include "base/numeric/error_summary.h"
#include "compress/hold_out/split.h"
#include "compress/hold_out/texel_subset.h"
#include "evaluate/error/predictor.h"

/* Samples channel by channel beside what a model says of them; masked ones and those below the horizon are not among
 * them. Freed with weft_asked_samples_free. */
typedef struct weft_asked_samples {
    size_t count;
    weft_compared *value; /* [count] */
    uint8_t *group;       /* [count] flags of compress/hold_out/split.h */
    uint32_t *sample;     /* [count] texel of the subset x image_count + image; red, green and blue follow each other */
} weft_asked_samples;
void weft_asked_samples_free(weft_asked_samples *asked);

/* Freed with weft_trial_free. */
typedef struct weft_trial {
    const weft_texel_subset *subset; /* not owned */
    const uint8_t *held;             /* [image_count] why each image is held out; not owned */
    int *image;                      /* [held_count + fitted_count] the images that are held out, then the others */
    uint8_t *flags;                  /* of those: why each is held out, here or in the next split */
    int held_count, fitted_count;
    weft_texel_block asked; /* of the subset: the texels that are asked for; at first all */
    bool predicts_asked;    /* predictors have the texels that are asked for alone; at first false */
} weft_trial;

/* `held` [image_count] are the flags of the split, `next` those of the one after it; both must outlive the trial, as
 * the subset must. Errors: WEFT_SYSTEM for memory; the caller frees then too. */
weft_code weft_trial_create(const weft_texel_subset *subset, const uint8_t *held, const uint8_t *next,
                            weft_trial *trial, weft_error *error);
void weft_trial_free(weft_trial *trial);

/* What a predictor for the layout of the subset, or for the part that is asked for, says of the images that are held
 * out, and of the fitted ones. The caller frees both, also on failure. Errors: WEFT_SYSTEM for memory. */
weft_code weft_trial_ask(const weft_trial *trial, const weft_predictor *predictor, weft_asked_samples *held,
                         weft_asked_samples *fitted, weft_error *error);

/* What the photographs that are not held out say of those that are (compress/hold_out/interpolation.h), where they say
 * anything; `through`: seen through the surface of the subset, which has one. The caller frees it, also on failure.
 * Errors: those of weft_interpolation_create. */
weft_code weft_trial_ask_photographs(const weft_trial *trial, bool through, weft_asked_samples *held,
                                     weft_error *error);

/* ---- Interpolation ---- */

/* The photographs themselves as a model: interpolated between those that are not held out. */

typedef struct weft_interpolation weft_interpolation;

/* For the images image [count], which are held out with others, as held_out [image_count] says; `through`: seen through
 * the surface of the subset, which has one. What is given must outlive the result, which the caller frees with
 * weft_interpolation_free. Errors: WEFT_BAD_INPUT for views that cannot be triangulated, WEFT_SYSTEM for memory. */
weft_code weft_interpolation_create(const weft_texel_subset *subset, const uint8_t *held_out, const int *image,
                                    int count, bool through, weft_interpolation **result, weft_error *error);
void weft_interpolation_free(weft_interpolation *interpolation);

/* What the photographs say of texel (x, y) in those images: prediction [count], in the quantity of the dataset,
 * barycentric between views and, within each, between lights. Samples are divided by the cosine of their own light
 * before. Masked ones take no part; NaN where none is left, and where one of the views saw the place beyond the
 * subset. Thread-safe. Errors: WEFT_SYSTEM for memory. */
weft_code weft_interpolation_predict(const weft_interpolation *interpolation, int x, int y, weft_rgb *prediction,
                                     weft_error *error);

/* ---- Mean error ---- */

/* Errors of what is held out, and their means over splits. */

/* How many splits are in each mean. */
typedef struct weft_means_taken {
    int all, view, light, both;
} weft_means_taken;

/* The errors of one split. Errors: WEFT_SYSTEM for memory. */
weft_code weft_hold_out_summarise(const weft_asked_samples *compared, weft_hold_out_error *result, weft_error *error);

/* Takes one more summary into a mean over `*taken` of them; one without values does not count. */
void weft_summary_take(const weft_error_summary *one, int *taken, weft_error_summary *mean);

/* The same of all summaries. */
void weft_hold_out_take(const weft_hold_out_error *one, weft_means_taken *taken, weft_hold_out_error *mean);

#endif

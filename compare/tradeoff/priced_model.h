/* The models that a price list offers for a dataset. */
#ifndef WEFT_COMPARE_TRADEOFF_PRICED_MODEL_H
#define WEFT_COMPARE_TRADEOFF_PRICED_MODEL_H

#include "base/status.h"
#include "compare/rti/rti.h"
#include "compare/tradeoff/factorised.h"
#include "compress/options/options.h"

#include <stdbool.h>
#include <stddef.h>

enum { WEFT_PRICED_MOST = 64, WEFT_PRICED_NAME = 48, WEFT_PRICED_ARGUMENTS = 64 };

typedef enum weft_priced_family {
    WEFT_PRICED_LOBES, /* with T where the photographs carry it */
    WEFT_PRICED_COMPONENTS,
    WEFT_PRICED_FEWER,      /* photographs */
    WEFT_PRICED_RAW,        /* the photographs, interpolated */
    WEFT_PRICED_BARD,       /* those under the light along the normal, which say all others (reflectance/bard/bard.h) */
    WEFT_PRICED_CLOTH,      /* analytic (compare/tradeoff/cloth.h) */
    WEFT_PRICED_RTI,        /* of one view: what users of RTI know (compare/rti/rti.h) */
    WEFT_PRICED_FACTORISED, /* the photographs of a grid, as files of Bonn (compare/tradeoff/factorised.h) */
    WEFT_PRICED_FAMILIES
} weft_priced_family;

/* Which rings of views and lights are taken. */
typedef enum weft_photographs_taken {
    WEFT_PHOTOGRAPHS_ALL,
    WEFT_PHOTOGRAPHS_SECOND_RINGS = 2, /* 0, 30 and 60 degrees of ubo81 */
    WEFT_PHOTOGRAPHS_THIRD_RINGS = 3   /* 0 and 45 degrees */
} weft_photographs_taken;

typedef struct weft_priced_model {
    char name[WEFT_PRICED_NAME];
    char arguments[WEFT_PRICED_ARGUMENTS]; /* of weft compress; "" where that has none for it */
    weft_priced_family family;
    weft_compress_options options; /* of raw only heights: seen through them */
    weft_photographs_taken photographs;
    const char *cloth;               /* file of a WEFT_PRICED_CLOTH; not owned */
    weft_rti_model rti;              /* of a WEFT_PRICED_RTI */
    weft_factorised_kind factorised; /* of a WEFT_PRICED_FACTORISED */
    int work;                        /* of a fit, relative to others */
} weft_priced_model;

/* What else of a dataset decides which models it can carry. */
typedef struct weft_priced_dataset {
    bool has_surface;  /* components and raw are offered with and without it (options.heights) */
    const char *cloth; /* file of a weave to be fitted, or of microcylinder cloth; NULL: none; not owned */
} weft_priced_dataset;

/* "lobes", "components", ... Pure. */
const char *weft_priced_family_name(weft_priced_family family);

/* Of a dataset, without analytic cloth. Pure. */
weft_priced_dataset weft_priced_dataset_of(const weft_dataset *dataset);

/* The models that the photographs of a dataset can carry: model [WEFT_PRICED_MOST]; returns how many.
 * Components through heights come right after the same without, and are made from the same fit. Pure. */
int weft_priced_models_list(const weft_dataset_layout *layout, const weft_priced_dataset *dataset,
                            weft_priced_model *model);

/* Whether weft compress makes models of these errors, the second of components through heights and the first of the
 * same without: it keeps heights only where they gain enough (compress/hold_out/hold_out.h). Pure. */
bool weft_priced_heights_are_kept(double without, double through);

/* Whether the model is what weft_compress fits; else it is raw, BARD, analytic cloth, of RTI or matrices. Pure. */
bool weft_priced_model_is_fit(const weft_priced_model *model);

/* Whether it is such a fit of each texel alone: of lobes and tables, not of components. Pure. */
bool weft_priced_model_is_of_lobes(const weft_priced_model *model);

/* Whether the model is made from the same fit as the other. Pure. */
bool weft_priced_models_share_fit(const weft_priced_model *model, const weft_priced_model *other);

/* Marks the images that are not taken with 1 in left_out [image_count], others with 0; returns how many are taken.
 * Pure.
 */
int weft_photographs_leave_out(const weft_dataset_layout *layout, weft_photographs_taken taken, uint8_t *left_out);

/* ---- The choice ---- */

/* Which models are worth their price. */

typedef enum weft_preset {
    WEFT_PRESET_NONE,
    WEFT_PRESET_SMALL,
    WEFT_PRESET_BALANCED,
    WEFT_PRESET_BEST,
    WEFT_PRESET_COUNT
} weft_preset;

/* "", "small", "balanced", "best". Pure. */
const char *weft_preset_name(weft_preset preset);

/* Why a preset is what it is: a sentence. Pure. */
const char *weft_preset_reason(weft_preset preset);

/* What a model costs and what it is worth. */
typedef struct weft_offer {
    double bytes, error; /* error: relative RMSE where it was not fitted */
    bool may_be_chosen;  /* `weft compress` makes it of this dataset; others neither are chosen nor beat one that is */
} weft_offer;

/* Whether another offer that may be chosen has neither more bytes nor more error, and less of one. Of two that are
 * equal in both the first is not beaten. Pure. */
bool weft_offer_is_beaten(const weft_offer *offer, size_t count, size_t which);

/* The offer that a preset chooses among those that may be chosen and are not beaten:
 *
 *     best:     the fewest bytes with an error within a hundredth of the least, which says nothing
 *     small:    the fewest bytes with an error of at most sqrt(least error x error of the smallest file): halfway, by
 *               ratio, between the best and the smallest
 *     balanced: of those between small and best the one farthest below the straight line between the two, both axes
 *               logarithmic: the bend of the curve; small where there is none below it
 *
 * Returns `count` where nothing may be chosen. Pure. */
size_t weft_preset_choose(const weft_offer *offer, size_t count, weft_preset preset);

/* Milliseconds of a frame of an offer; 0 where nothing can be drawn. */
typedef weft_code weft_offer_time(void *context, size_t which, double *frame_ms, weft_error *error);

/* The same among those whose frames take at most `most_ms`. A time is asked for only where the offer would be chosen:
 * one that is too slow may be chosen no longer, and the preset chooses anew. Where none is left *chosen is `count`, and
 * *fastest the offer that came nearest (`count` without any). Errors: those of `ask`. */
weft_code weft_preset_choose_fast(weft_offer *offer, size_t count, weft_preset preset, double most_ms,
                                  weft_offer_time *ask, void *context, size_t *chosen, size_t *fastest,
                                  weft_error *error);

#endif

/* The models that a price list offers for a dataset. */
#ifndef WEFT_COMPARE_TRADEOFF_PRICED_MODEL_H
#define WEFT_COMPARE_TRADEOFF_PRICED_MODEL_H

#include "compress/options/options.h"

enum { WEFT_PRICED_MOST = 64, WEFT_PRICED_NAME = 48, WEFT_PRICED_ARGUMENTS = 64 };

typedef enum weft_priced_family {
    WEFT_PRICED_LOBES, /* with T where the photographs carry it */
    WEFT_PRICED_COMPONENTS,
    WEFT_PRICED_FEWER, /* photographs */
    WEFT_PRICED_RAW,   /* the photographs, interpolated */
    WEFT_PRICED_BARD,  /* those under the light along the normal, which say all others (reflectance/bard/bard.h) */
    WEFT_PRICED_CLOTH, /* analytic (compare/tradeoff/cloth.h) */
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
    const char *cloth; /* file of a WEFT_PRICED_CLOTH; not owned */
    int work;          /* of a fit, relative to others */
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

/* Whether the model is what weft_compress fits; else it is raw, BARD or analytic cloth. Pure. */
bool weft_priced_model_is_fit(const weft_priced_model *model);

/* Whether it is such a fit of each texel alone: of lobes and tables, not of components. Pure. */
bool weft_priced_model_is_of_lobes(const weft_priced_model *model);

/* Whether the model is made from the same fit as the other. Pure. */
bool weft_priced_models_share_fit(const weft_priced_model *model, const weft_priced_model *other);

/* Marks the images that are not taken with 1 in left_out [image_count], others with 0; returns how many are taken.
 * Pure.
 */
int weft_photographs_leave_out(const weft_dataset_layout *layout, weft_photographs_taken taken, uint8_t *left_out);

#endif

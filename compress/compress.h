/* From a dataset to a material: every texel of every mip level fitted, packed, and measured against its samples. */
#ifndef WEFT_COMPRESS_COMPRESS_H
#define WEFT_COMPRESS_COMPRESS_H

#include "btf/material/material.h"
#include "compress/components/components_fit.h"
#include "compress/options/options.h"

/* What is fitted: components, or what of lobes the number of samples a texel allows: at least four for every free
 * parameter. */
typedef enum weft_compress_model {
    WEFT_COMPRESS_COMPONENTS,
    WEFT_COMPRESS_TABLE, /* every texel alone, lobes and T */
    WEFT_COMPRESS_LOBES, /* every texel alone, lobes only */
    WEFT_COMPRESS_SPARSE /* a handful of images: neighbours share normal and exponent, amplitudes are the texel's own */
} weft_compress_model;

typedef struct weft_compress_report {
    weft_compress_model model;
    int lobe_count;                    /* of the material */
    long sample_count;                 /* of level 0: texels times images that were not held out */
    long masked_count;                 /* of these, not used: masked, not finite, or light below the horizon */
    long texel_count;                  /* that were fitted: of all levels, of components those of level 0 */
    long empty_texel_count;            /* of these, without any valid sample; they are black */
    weft_components_report components; /* where there are any */
    double seconds;
} weft_compress_report;

/* The options with WEFT_COMPONENTS_AUTOMATIC decided: 8 components for fewer than 20 images, 16 for fewer than 100,
 * else 32; none for fewer than 20 near images, which are fitted by the sparse model. weft_compress decides so by
 * itself. Pure. */
weft_compress_options weft_compress_settle(const weft_compress_options *options, const weft_dataset *dataset);

/* The model that weft_compress fits to a dataset with this layout with settled options, and how many lobes. Pure. */
weft_compress_model weft_compress_plan(const weft_dataset_layout *layout, const weft_compress_options *options,
                                       int *lobe_count);

/* Gives the components of a material the heights of the dataset; does nothing where either has none. Errors: those of
 * reading; WEFT_SYSTEM for memory. */
weft_code weft_compress_take_heights(weft_dataset *dataset, weft_material *material, weft_error *error);

/* Fits `material`, which the caller frees with weft_material_free; errors by level are in it. `report` may be NULL. The
 * result depends neither on the number of threads (OpenMP) nor, but for components, on the order of the images, the
 * memory allowed or whether a checkpoint was used. The sparse model holds all samples and keeps no checkpoint. Nothing
 * else may use the dataset meanwhile. Errors: WEFT_BAD_USAGE for options out of range, where every image is held out,
 * or where the memory allowed does not suffice; WEFT_BAD_INPUT for a dataset without any valid sample; those of
 * reading; WEFT_SYSTEM for memory and for a checkpoint that cannot be opened or written, which then keeps what is in
 * it. */
weft_code weft_compress(weft_dataset *dataset, const weft_compress_options *options, const weft_progress *progress,
                        weft_material *material, weft_compress_report *report, weft_error *error);

#endif

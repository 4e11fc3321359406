/* From a dataset to a material: every texel of every mip level fitted, packed, and measured against its samples. */
#ifndef WEFT_COMPRESS_COMPRESS_H
#define WEFT_COMPRESS_COMPRESS_H

#include "btf/dataset.h"
#include "btf/material.h"
#include "btf/progress.h"

#include <stdbool.h>

typedef struct weft_compress_options {
    int lobe_count;          /* at most; 0..3 */
    bool table;              /* T(v), where the samples can carry it */
    bool levels;             /* mip levels, each fitted to the mean samples of its groups of texels */
    double max_exponent;     /* N <= this */
    const uint8_t *held_out; /* [image_count] images that the fit must not see (non-zero), or NULL */
} weft_compress_options;

/* 2 lobes, table, levels, N <= 512, nothing held out. */
weft_compress_options weft_compress_default_options(void);

/* What the number of samples a texel allows: at least four for every free parameter. */
typedef enum weft_compress_model {
    WEFT_COMPRESS_TABLE, /* every texel alone, lobes and T */
    WEFT_COMPRESS_LOBES, /* every texel alone, lobes only */
    WEFT_COMPRESS_SPARSE /* a handful of images: neighbours share normal and exponent, amplitudes are the texel's own */
} weft_compress_model;

typedef struct weft_compress_report {
    weft_compress_model model;
    int lobe_count;          /* of the material */
    long sample_count;       /* of level 0: texels times images that were not held out */
    long masked_count;       /* of these, not used: masked, not finite, or light below the horizon */
    long texel_count;        /* of all levels */
    long empty_texel_count;  /* without any valid sample; they are black */
    long turned_frame_count; /* texels whose frame was fitted rather than the surface's own */
    long second_start_count; /* texels whose fit began with a lobe thrown back to the light rather than mirrored */
    double seconds;
} weft_compress_report;

/* Fits `material`, which the caller frees with weft_material_free; errors by level are in it. `report` may be NULL. The
 * result does not depend on the number of threads (OpenMP) nor on the order of the images. Memory: bounded, about 150
 * MB plus what 1/1024 of the dataset needs as floats; the sparse model holds all samples. Errors: WEFT_BAD_USAGE for
 * options out of range or where every image is held out; WEFT_BAD_INPUT for a dataset without any valid sample; those
 * of reading; WEFT_SYSTEM for memory. */
weft_code weft_compress(weft_dataset *dataset, const weft_compress_options *options, const weft_progress *progress,
                        weft_material *material, weft_compress_report *report, weft_error *error);

#endif

/* The data and the models that are compared with it, as mean BRDFs. */
#ifndef WEFT_COMPARE_REPORT_CONTENDER_H
#define WEFT_COMPARE_REPORT_CONTENDER_H

#include "base/numeric/error_summary.h"
#include "btf/dataset/dataset.h"
#include "btf/material/material.h"
#include "evaluate/model.h"

enum { WEFT_CONTENDER_COUNT = 4 }; /* data, compressed, analytic, BARD */

typedef struct weft_contender {
    const char *name;
    weft_model *model;
    weft_real level; /* whose mean is taken: of a material the finest level of at most 1024 texels */
} weft_contender;

/* The first is the data. Freed with weft_contenders_close. */
typedef struct weft_contenders {
    int count;
    weft_contender contender[WEFT_CONTENDER_COUNT];
} weft_contenders;

/* `weave` and `bard` (a dataset as `weft bard` writes it) may be NULL. Errors: those of weft_model_open. */
weft_code weft_contenders_open(const char *dataset, const char *material_path, const weft_material *material,
                               const char *weave, const char *bard, weft_contenders *contenders, weft_error *error);
void weft_contenders_close(weft_contenders *contenders);

/* Mean BRDF over the material for one pair of directions, as `weft eval` gives it without texture coordinates. */
weft_code weft_contender_brdf(const weft_contender *contender, weft_vec3 light, weft_vec3 view, weft_rgb *brdf,
                              weft_error *error);

/* The error of each contender's mean BRDF against that of the data, error [count], over the directions of all images
 * (an even choice of at most about 7000); entry 0 is zero. Errors: those of weft_model_brdf; WEFT_SYSTEM for memory. */
weft_code weft_contenders_measure(const weft_contenders *contenders, const weft_dataset_layout *layout,
                                  const weft_progress *progress, weft_error_summary *result, weft_error *error);

#endif

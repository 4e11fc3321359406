/* One texel of 81 x 81 images and everything needed to fit it. */
#ifndef WEFT_TESTS_TEXEL_FIXTURE_H
#define WEFT_TESTS_TEXEL_FIXTURE_H

#include "tests/support/cmocka_all.h"

#include "btf/direction/direction.h"
#include "compress/fit/fit.h"
#include "tests/support/synthetic_texel.h"

#include <math.h>

typedef struct texel_fixture {
    weft_dataset_layout layout;
    weft_bundle bundle;
    weft_samples samples;
    weft_fit_workspace *workspace;
    float *sum, *count; /* [image_count][3], [image_count] */
    double *table;      /* [view_count] */
    weft_frame frame;   /* of the surface */
} texel_fixture;

/* cmocka's setup and teardown. */
int texel_fixture_setup(void **state);
int texel_fixture_teardown(void **state);

/* Puts a synthetic texel into the samples, all valid. */
void texel_fixture_fill(texel_fixture *fixture, synthetic_kind kind, uint64_t seed, double noise);

/* Gathers sum and count as they are. */
void texel_fixture_gather(texel_fixture *fixture);

/* Root of residual over energy. */
double texel_fixture_error(const texel_fixture *fixture, int channel, const weft_fit *fit, const double *table);

#endif

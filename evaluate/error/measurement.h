/* A model measured against a dataset in one pass over the samples. */
#ifndef WEFT_EVALUATE_ERROR_MEASUREMENT_H
#define WEFT_EVALUATE_ERROR_MEASUREMENT_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/direction/direction.h"
#include "btf/material/certificate.h"
#include "evaluate/error/coverage.h"
#include "evaluate/error/image_pair.h"

/* Freed with weft_measurement_free. */
typedef struct weft_measurement {
    int pair_count;
    weft_image_pair *pair; /* [pair_count] */
    long texel_count;      /* texels whose samples were measured */
    weft_error_summary all;
    weft_error_summary by_view[WEFT_RING_COUNT],
        by_light[WEFT_RING_COUNT];                /* rings of ubo81: theta nearest 0, 15, .. 75 degrees */
    weft_coverage coverage;                       /* of the certificate; of no samples without one */
    long sample_count, missing, saturated, other; /* texels times images, and how many of them are masked and why */
} weft_measurement;

/* Measures the error over all texels, or over an even choice of them where the samples would be more than about two
 * million; makes the pairs of the given images [image_count]. `certificate` is that of the model, or NULL. `what` names
 * the step for the progress. Errors:
 * WEFT_BAD_INPUT for a dataset that cannot be read. */
weft_code weft_measurement_make(weft_dataset *dataset, weft_predictor *predictor, const weft_certificate *certificate,
                                const char *what, const int *image, int image_count, const weft_progress *progress,
                                weft_measurement *measurement, weft_error *error);
void weft_measurement_free(weft_measurement *measurement);

#endif

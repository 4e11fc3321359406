/* How well a fit predicts a photograph it has not seen. */
#ifndef WEFT_COMPARE_REPORT_LEAVE_ONE_OUT_H
#define WEFT_COMPARE_REPORT_LEAVE_ONE_OUT_H

#include "base/progress.h"
#include "evaluate/error/measurement.h"

/* One photograph, predicted by a material fitted to all the others. */
typedef struct weft_left_out {
    weft_image_pair pair;
    char name[64];            /* of the photograph's file, else "image N" */
    weft_error_summary error; /* over all channels of its valid samples */
} weft_left_out;

/* Freed with weft_leave_one_out_free. */
typedef struct weft_leave_one_out {
    int count, capacity;
    weft_left_out *photograph; /* [capacity], the first `count` in use: those with any valid sample */
    double mean_relative_rmse, mean_median_relative; /* of the photographs */
    double seconds;                                  /* of all fits together */
} weft_leave_one_out;

/* Fits a material to all images but one, for each in turn, and compares its prediction with that image. The fits use
 * the defaults of weft_compress, without mip levels. Errors: those of reading and fitting. */
weft_code weft_leave_one_out_measure(weft_dataset *dataset, const weft_progress *progress, weft_leave_one_out *result,
                                     weft_error *error);
void weft_leave_one_out_free(weft_leave_one_out *result);

#endif

/* One lens and a pose for every photograph, from the corners of the markers. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_LENS_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_LENS_H

#include "registration/lamp/photograph.h"

/* What is known of a lens before any photograph is looked at. */
typedef enum weft_lens_knowledge {
    WEFT_LENS_UNKNOWN,    /* everything is estimated */
    WEFT_LENS_FOCAL_ONLY, /* the focal length as written is right; k1 is estimated: few views cannot determine more */
    WEFT_LENS_KNOWN       /* only poses are estimated */
} weft_lens_knowledge;

/* Standard errors under the scatter of the corners; 0 for what is not estimated. */
typedef struct weft_lens_errors {
    double focal_px, k1, k2;
} weft_lens_errors;

/* How a lens became known. */
typedef struct weft_lens_estimate {
    weft_camera camera; /* no vignetting */
    weft_lens_knowledge knowledge;
    weft_lens_errors errors;
    int distinct_views; /* whose directions differ by 10 degrees and more */
    double rms_px;      /* of all corners used */
} weft_lens_estimate;

/* Estimates the lens from photographs of width x height pixels, or takes `known` where it is not NULL; fills pose and
 * corner_rms_px of every photograph that is used. One whose corners do not fit gets a remark. Where too few distinct
 * views tell a lens, the focal length that the camera wrote is believed. Errors: WEFT_BAD_INPUT where no lens fits, or
 * where the photographs cannot tell it and no focal length is written; WEFT_SYSTEM. */
weft_code weft_lens_estimate_from(weft_photographs_photograph *photograph, int count, int width, int height,
                                  const weft_camera *known, weft_lens_estimate *lens, weft_error *error);

/* Squared distance from the axis of the farthest corner of a photograph, in focal lengths. Pure. */
double weft_lens_corner_radius_squared(const weft_camera *camera);

#endif

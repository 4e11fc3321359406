/* The one door to OpenCV. */
#ifndef WEFT_REGISTRATION_POSE_OPENCV_BRIDGE_H
#define WEFT_REGISTRATION_POSE_OPENCV_BRIDGE_H

#include "base/status.h"
#include "registration/pose/marker_detector.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* weft_opencv_find_markers_of for the markers of the target (DICT_4X4_50), at most WEFT_MARKERS_LIMIT. Errors:
 * WEFT_SYSTEM. */
weft_code weft_opencv_find_markers(const uint8_t *grey, int width, int height, weft_marker *marker, int *count,
                                   weft_error *error);

/* Homography (row-major, last element 1) from `count` >= 4 points to their images by RANSAC with the given reach, then
 * least squares over the points that agree, which get 1 in `agrees`. Errors: WEFT_BAD_INPUT where none fits;
 * WEFT_SYSTEM. */
weft_code weft_opencv_fit_homography(const double (*from)[2], const double (*to)[2], int count, double reach,
                                     double homography[3][3], uint8_t *agrees, weft_error *error);

/* Gaussian blur in place, the border replicated. Errors: WEFT_SYSTEM. */
weft_code weft_opencv_blur(float *picture, int width, int height, double deviation, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif

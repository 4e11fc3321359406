/* What calibration asks of OpenCV. */
#ifndef WEFT_REGISTRATION_LENS_CALIBRATE_BRIDGE_H
#define WEFT_REGISTRATION_LENS_CALIBRATE_BRIDGE_H

#include "base/status.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Finds all inner corners of a chessboard, in rows. Not found: *found is 0. Errors: WEFT_SYSTEM. */
weft_code weft_opencv_find_chessboard(const uint8_t *grey, int width, int height, int columns, int rows,
                                      double (*corner)[2], int *found, weft_error *error);

/* Moves corners where four squares meet to where the grey is symmetric about them, from within `reach` pixels. Errors:
 * WEFT_SYSTEM. */
weft_code weft_opencv_refine_corners(const uint8_t *grey, int width, int height, double (*corner)[2], int count,
                                     int reach, weft_error *error);

enum { WEFT_LENS_VALUES = 9 }; /* fx, fy, cx, cy, k1, k2, p1, p2, k3 */

/* Which of k2, p1 and p2, k3 are free: the others are 0. */
typedef struct weft_lens_model {
    int k2, tangential, k3;
} weft_lens_model;

/* Zhang's calibration over `views` photographs of a plane, with point_count[view] points each, one after the other.
 * rotation (Rodrigues) has three values a view, residual_px two a point. Standard
 * errors are those of least squares, as if errors were independent. Errors: WEFT_BAD_INPUT where no lens fits;
 * WEFT_SYSTEM. */
weft_code weft_opencv_calibrate(int width, int height, int views, const int *point_count, const double (*board_mm)[2],
                                const double (*pixel)[2], const weft_lens_model *model, double value[WEFT_LENS_VALUES],
                                double standard_error[WEFT_LENS_VALUES], double (*rotation)[3],
                                double (*residual_px)[2], double *rms_px, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif

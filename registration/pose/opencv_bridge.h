/* The one door to OpenCV, but for its finder of colour charts (registration/colour/chart_library.h): markers and
 * corners in pictures, homographies, lenses. */
#ifndef WEFT_REGISTRATION_POSE_OPENCV_BRIDGE_H
#define WEFT_REGISTRATION_POSE_OPENCV_BRIDGE_H

#include "base/status.h"
#include "btf/session/lens.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Markers ---- */

enum { WEFT_MARKERS_LIMIT = 64 };

/* A marker found: its corners in pixels (origin at the centre of the top left pixel), clockwise from the one that is
 * top left when the marker is upright. They lie where lines along the edges of the marker meet
 * (registration/pose/marker_edges.h). */
typedef struct weft_marker {
    int id;
    double corner[4][2];
} weft_marker;

/* Whether markers of a dictionary can be found, and how many it has: "4X4_50" to "7X7_1000" and "ARUCO_ORIGINAL" of
 * ArUco, "APRILTAG_16h5", "APRILTAG_25h9", "APRILTAG_36h10", "APRILTAG_36h11". 0: there is none of that name. Pure. */
int weft_marker_dictionary_size(const char *dictionary);

/* Finds the markers of a dictionary (NULL: that of the target) in an 8-bit grey picture. At most `limit` are written to
 * `marker`. Errors: WEFT_BAD_USAGE for a dictionary that there is not; WEFT_SYSTEM with the library's message. */
weft_code weft_opencv_find_markers(const char *dictionary, const uint8_t *grey, int width, int height,
                                   weft_marker *marker, int limit, int *count, weft_error *error);

/* Finds the markers of the target in a linear grey photograph [height][width] of any size and brightness, as above.
 * They are looked for in a reduced picture, and their edges in the full one. */
weft_code weft_opencv_find_markers_in_photograph(const float *grey, int width, int height, weft_marker *marker,
                                                 int limit, int *count, weft_error *error);

/* ---- Corners of a chessboard ---- */

/* Finds all inner corners of a chessboard, in rows. Not found: *found is false. Errors: WEFT_SYSTEM. */
weft_code weft_opencv_find_chessboard(const uint8_t *grey, int width, int height, int columns, int rows,
                                      double (*corner)[2], bool *found, weft_error *error);

/* Moves corners where four squares meet to where the grey is symmetric about them, from within `reach` pixels. Errors:
 * WEFT_SYSTEM. */
weft_code weft_opencv_refine_corners(const uint8_t *grey, int width, int height, double (*corner)[2], int count,
                                     int reach, weft_error *error);

/* ---- Geometry ---- */

/* Homography (row-major, last element 1) from `count` >= 4 points to their images by RANSAC with the given reach, then
 * least squares over the points that agree, which get 1 in `agrees`. Errors: WEFT_BAD_INPUT where none fits;
 * WEFT_SYSTEM. */
weft_code weft_opencv_fit_homography(const double (*from)[2], const double (*to)[2], int count, double reach,
                                     double homography[3][3], uint8_t *agrees, weft_error *error);

/* Points of a plane in one photograph: their places on the plane, mm, and where they are seen, pixels. */
typedef struct weft_corner_view {
    int count;
    const double (*plate)[2], (*seen)[2]; /* [count] */
} weft_corner_view;

/* Terms of a lens that are not estimated. */
enum {
    WEFT_FIX_FOCAL_LENGTH = 1,
    WEFT_FIX_MIDDLE = 2,
    WEFT_FIX_K1 = 4,
    WEFT_FIX_K2 = 8,
    WEFT_FIX_TANGENTIAL = 16, /* p1 and p2 */
    WEFT_FIX_K3 = 32
};

/* What came of a calibration; the caller allocates. */
typedef struct weft_corner_fit {
    double standard_error[WEFT_LENS_PARAMETERS]; /* as if the errors of corners were independent; 0: fixed */
    double rms_px;                               /* of all views */
    weft_pose *pose;                             /* [count] */
    double *view_rms_px;                         /* [count]; NULL: not wanted */
    double (*residual_px)[2];                    /* of all points, view after view; NULL: not wanted */
} weft_corner_fit;

/* One lens and a pose for each view, by bundle adjustment: least squares of the reprojection (Zhang 2000). `camera`
 * holds the size of the photographs and receives the lens. With `from_camera` it is the start, what is `fixed` of it
 * stays, and the ratio of fx to fy stays; else all is found, and fixed terms are 0. Errors: WEFT_BAD_INPUT where no
 * lens fits; WEFT_SYSTEM. */
weft_code weft_opencv_calibrate(const weft_corner_view *view, int count, unsigned fixed, bool from_camera,
                                weft_camera *camera, weft_corner_fit *fit, weft_error *error);

/* Gaussian blur in place, the border replicated. Errors: WEFT_SYSTEM. */
weft_code weft_opencv_blur(float *picture, int width, int height, double deviation, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif

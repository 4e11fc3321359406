/* OpenCV behind a C header: markers in large photographs, and one lens for many of them. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_PHOTOGRAPHS_BRIDGE_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_PHOTOGRAPHS_BRIDGE_H

#include "btf/session/camera.h"
#include "registration/pose/opencv_bridge.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Finds the markers of the target in a linear grey photograph [height][width] of any size and brightness. They are
 * looked for in a reduced picture; their corners lie where lines along their edges meet in the full one. At most
 * WEFT_MARKERS_LIMIT are written. Errors: WEFT_SYSTEM with the library's message. */
weft_code weft_opencv_find_markers_in_photograph(const float *grey, int width, int height, weft_marker *marker,
                                                 int *count, weft_error *error);

/* Corners of one photograph: places on the plate, mm, and where they are seen, pixels. */
typedef struct weft_corner_view {
    int count;
    const double (*plate)[2], (*seen)[2]; /* [count] */
} weft_corner_view;

/* What is known of a lens before any photograph is looked at. */
typedef enum weft_lens_knowledge {
    WEFT_LENS_UNKNOWN,    /* everything is estimated, from the focal length in `camera` on */
    WEFT_LENS_FOCAL_ONLY, /* the focal length in `camera` is right; k1 is estimated: few views cannot tell more */
    WEFT_LENS_KNOWN       /* `camera` is right: only poses are estimated */
} weft_lens_knowledge;

/* How well a lens is known: standard errors under the scatter of the corners; 0 for what is not estimated. */
typedef struct weft_lens_errors {
    double focal_px, k1, k2;
} weft_lens_errors;

/* One lens and a pose a view, by bundle adjustment: least squares of the reprojection (Zhang 2000). `camera` (in: size
 * and what is known; out: the lens, its vignetting untouched). pose [count]; rms_px [count] of every view. Errors:
 * WEFT_BAD_INPUT where no lens fits; WEFT_SYSTEM. */
weft_code weft_opencv_fit_lens(const weft_corner_view *view, int count, weft_lens_knowledge knowledge,
                               weft_camera *camera, weft_lens_errors *errors, weft_pose *pose, double *rms_px,
                               weft_error *error);

#ifdef __cplusplus
}
#endif
#endif

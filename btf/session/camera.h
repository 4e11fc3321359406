/* A calibrated camera: pinhole with radial distortion (Brown 1966), vignetting, and its pose.
 *
 * Pixel coordinates: (0, 0) is the centre of the top left pixel, x right, y down.
 * Camera frame: x right, y down, z forward. Plate frame: millimetres, origin at the centre of the sample,
 * axes as in base/vector.h. All functions are pure. */
#ifndef WEFT_BTF_SESSION_CAMERA_H
#define WEFT_BTF_SESSION_CAMERA_H

#include "btf/direction/direction.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct weft_camera {
    int width, height;     /* pixels */
    double fx, fy, cx, cy; /* focal lengths and principal point, pixels */
    double k1, k2;         /* distorted = undistorted x (1 + k1 r^2 + k2 r^4), r in normalised coordinates */
    double vignetting[3];  /* relative response 1 + a r^2 + b r^4 + c r^6, r normalised as above, undistorted */
} weft_camera;

typedef struct weft_pixel {
    double x, y;
} weft_pixel;

/* camera point = rotation . plate point + translation. */
typedef struct weft_pose {
    double rotation[3][3];
    weft_vec3 translation; /* mm */
} weft_pose;

/* A projective map of the plane, row-major, from plate millimetres to undistorted pixels. */
typedef struct weft_homography {
    double m[3][3];
} weft_homography;

/* The pose of a rig whose camera stands at `distance_mm` in direction `view`, looks at the origin and keeps the
 * direction to the zenith up in its image (at the zenith itself: up is -(cos phi, sin phi, 0)). */
weft_pose weft_pose_of_view(weft_angles view, double distance_mm);

/* Position of the camera in the plate frame, mm. */
weft_vec3 weft_pose_camera_position(const weft_pose *pose);

/* The plane z = 0 of the plate seen by an undistorted camera. */
weft_homography weft_homography_of_pose(const weft_camera *camera, const weft_pose *pose);
weft_pixel weft_homography_apply(const weft_homography *homography, double x, double y);
/* Errors: none; a singular map gives the zero matrix. */
weft_homography weft_homography_inverse(const weft_homography *homography);

/* Undistorted pixel <-> pixel of the photograph. The inverse iterates to 1e-12. */
weft_pixel weft_camera_distort(const weft_camera *camera, weft_pixel undistorted);
weft_pixel weft_camera_undistort(const weft_camera *camera, weft_pixel distorted);

/* Relative response at a pixel of the photograph, 1 on the axis. */
double weft_camera_vignetting(const weft_camera *camera, weft_pixel distorted);

#ifdef __cplusplus
}
#endif
#endif

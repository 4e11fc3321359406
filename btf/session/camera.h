/* A calibrated camera: pinhole with radial and decentring distortion (Brown 1966; Conrady 1919),
 * vignetting, and its pose.
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
    int width, height;         /* pixels */
    double fx, fy, cx, cy;     /* focal lengths and principal point, pixels */
    double k1, k2, p1, p2, k3; /* of the lens, as OpenCV orders and defines them */
    double vignetting[3];      /* relative response 1 + a r^2 + b r^4 + c r^6, r normalised as above, undistorted */
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

/* Undistorted pixel -> pixel of the photograph. With normalised coordinates (x, y) = ((u - cx) / fx, (v - cy) / fy) and
 * r^2 = x^2 + y^2, distorted ones are
 *   x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
 *   y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y */
weft_pixel weft_camera_distort(const weft_camera *camera, weft_pixel undistorted);

/* The inverse, by Newton's method to 1e-12 of normalised coordinates, on the side of the axis: far out, a polynomial
 * may turn back and show a second point in the same pixel, which is none of the lens. A pixel beyond what the
 * polynomial reaches gets a point whose image is about the nearest to it. */
weft_pixel weft_camera_undistort(const weft_camera *camera, weft_pixel distorted);

/* Relative response at a pixel of the photograph, 1 on the axis. */
double weft_camera_vignetting(const weft_camera *camera, weft_pixel distorted);

#ifdef __cplusplus
}
#endif
#endif

/* A plate that need not be flat, seen by a camera: paper bends, and the cloth on it bends with it. Every warp between
 * the plate and a photograph goes through here. Pure functions. */
#ifndef WEFT_REGISTRATION_POSE_PLATE_VIEW_H
#define WEFT_REGISTRATION_POSE_PLATE_VIEW_H

#include "btf/session/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Height of the plate over the plane that touches it at its origin: xx x^2 + xy x y + yy y^2, mm; 1/mm each. */
typedef struct weft_bend {
    double xx, xy, yy;
} weft_bend;

double weft_bend_height(const weft_bend *bend, double x_mm, double y_mm);

/* Unit normal at a place. */
weft_vec3 weft_bend_normal(const weft_bend *bend, double x_mm, double y_mm);

/* One pose of the camera. A plate point at height h is seen at the homogeneous pixel homography (x, y, 1) + h lift. */
typedef struct weft_plate_view {
    weft_homography homography, inverse; /* the plane h = 0, mm to undistorted pixels and back */
    double lift[3], lift_back[3];        /* and inverse lift */
    weft_bend bend;
} weft_plate_view;

/* `homography` may have any scale. Its third axis is that which makes a rotation with the first two. */
weft_plate_view weft_plate_view_of(const weft_camera *camera, const weft_homography *homography, const weft_bend *bend);

/* Plate mm to undistorted pixel, and back: a fixed-point iteration on the height, until that moves by less than 1e-5
 * mm. */
weft_pixel weft_plate_view_see(const weft_plate_view *view, double x_mm, double y_mm);
weft_pixel weft_plate_view_meet(const weft_plate_view *view, double u, double v);

/* Distance of a place along the camera's axis, relative to that of the origin. */
double weft_plate_view_depth(const weft_plate_view *view, double x_mm, double y_mm);

#ifdef __cplusplus
}
#endif
#endif

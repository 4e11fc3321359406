/* The lens of the camera in the hand, by the rays it lets through. Nothing here is a formula that registration uses:
 * its distortion is a division model, its light falls off by geometry, and its blur comes from a sampled pupil.
 *
 * Pixels and camera frame as in btf/session/camera.h. All functions but weft_synthetic_lens_prepare are pure. */
#ifndef WEFT_CAPTURE_SYNTHETIC_LENS_H
#define WEFT_CAPTURE_SYNTHETIC_LENS_H

#include "btf/session/camera.h"

#include <stdbool.h>

enum { WEFT_SYNTHETIC_FIELD_COUNT = 128 };

typedef struct weft_synthetic_lens {
    int width, height;            /* pixels */
    double sensor_width_mm;       /* of square pixels */
    double focal_length_mm;       /* as engraved, and in the EXIF */
    double image_distance_mm;     /* from the pupil to the sensor: what a pinhole's focal length would be */
    double axis_x, axis_y;        /* the pixel that the optical axis meets */
    double division[2];           /* undistorted = distorted / (1 + a q^2 + b q^4), q = 1 at half the sensor's diagonal
                                     (Fitzgibbon 2001) */
    double pupil_radius_mm;       /* the aperture, as seen from the scene */
    double focus_mm;              /* depth of the plane in focus */
    double rim_mm, rim_radius_mm; /* a ring before the pupil, which cuts off slanted rays */
    float open[WEFT_SYNTHETIC_FIELD_COUNT + 1]; /* part of the pupil that a pixel sees, by q from 0 to 1.1 */
} weft_synthetic_lens;

typedef struct weft_synthetic_ray {
    weft_vec3 from, along; /* mm; a unit vector */
} weft_synthetic_ray;

/* Fills `open` by counting rays. */
void weft_synthetic_lens_prepare(weft_synthetic_lens *lens);

/* Slopes x/z and y/z in the camera frame of the ray through a place on the sensor and the middle of the pupil. */
void weft_synthetic_lens_slopes(const weft_synthetic_lens *lens, double x, double y, double slope[2]);

/* The ray through a place on the sensor and a place in the pupil (a unit disc), in the camera frame. false where the
 * rim stops it. */
bool weft_synthetic_lens_ray(const weft_synthetic_lens *lens, double x, double y, const double pupil[2],
                             weft_synthetic_ray *ray);

/* Light that a pixel gets of a scene of uniform radiance, 1 on the axis: cos^4, times the part of the pupil that it
 * sees. weft_synthetic_lens_obliquity is the first factor. */
double weft_synthetic_lens_obliquity(const weft_synthetic_lens *lens, double x, double y);
double weft_synthetic_lens_vignetting(const weft_synthetic_lens *lens, double x, double y);

/* Where a point of the camera frame is pictured through the middle of the pupil, by bisection. false behind the camera.
 */
bool weft_synthetic_lens_project(const weft_synthetic_lens *lens, weft_vec3 point, double pixel[2]);

/* A unit square onto the unit disc, area for area (Shirley and Chiu 1997). */
void weft_synthetic_disc(double u, double v, double disc[2]);

#endif

/* Photographs of the target plate made without anything from registration/, for its tests. */
#ifndef WEFT_TESTS_REGISTRATION_PLATE_H
#define WEFT_TESTS_REGISTRATION_PLATE_H

#include "btf/session/camera.h"
#include "btf/session/target.h"

/* What lies on the plate and how it is lit. */
typedef struct plate_scene {
    weft_target target;
    double gradient; /* light falls off linearly by this fraction from the plate's centre to its right rim */
    double noise;    /* standard deviation of a pixel, in units of a white plate lit along its normal */
    double aperture; /* diameter of the circle of confusion in pixels at twice the distance in focus */
    double covered;  /* fraction of the plate's radius, from the right, that lies under grey cloth */
    double (*sample)(double x_mm, double y_mm); /* what is in the opening; NULL: a checker of 2 mm */
} plate_scene;

/* A camera of `size` x `size` pixels with some distortion and vignetting that holds the plate of an opening of 32 mm
 * from `distance_mm`. */
weft_camera plate_camera(int size, double distance_mm);

/* The pose of a rig that is slightly out of adjustment: turned by about 0.05 degrees and moved by about 0.3 mm, by
 * `seed`. */
weft_pose plate_jittered_pose(weft_angles view, double distance_mm, unsigned seed);

/* [height][width] linear values, allocated for the caller (free); reflectance times light, with vignetting. */
float *plate_photograph(const plate_scene *scene, const weft_camera *camera, const weft_pose *pose, unsigned seed);

/* RMS distance over the opening between where `found` and the pose put plate points, mm on the plate. */
double plate_error_mm(const weft_camera *camera, const weft_pose *pose, const weft_homography *found,
                      double opening_mm);

/* Uniform in 0..1, and standard normal, from a small seeded generator. */
double plate_uniform(unsigned *state);
double plate_normal(unsigned *state);

#endif

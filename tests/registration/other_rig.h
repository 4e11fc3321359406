/* A rig that shares no formula with registration and none with the virtual rig, but for the drawing of the target, the
 * format of a session and the conventions for directions. What it does and what its session says differ:
 *
 * - its lens follows the division model (Fitzgibbon 2001) and is decentred; the session holds Brown's k1 alone;
 * - its light falls off as cos^4 of an angle that is wider than that of the ray; the session knows of no vignetting;
 * - the plate is bent into a piece of a cylinder, the cloth on it with it;
 * - the print is larger than drawn, its paper lighter and its ink greyer;
 * - a pixel is a square that leaves gaps, the aperture a hexagon; both are integrated on a regular grid;
 * - its black level is not the one that is declared, nor are its focal length and its principal point.
 *
 * The sample has a pattern that is long against a pixel, so that its truth depends on no resolution. */
#ifndef WEFT_TESTS_REGISTRATION_OTHER_RIG_H
#define WEFT_TESTS_REGISTRATION_OTHER_RIG_H

#include "btf/session/session.h"

enum { OTHER_RIG_VIEWS = 6, OTHER_RIG_LIGHTS = 2, OTHER_RIG_SHOTS = OTHER_RIG_VIEWS * OTHER_RIG_LIGHTS };

/* What the session does not say. */
typedef struct other_rig {
    double bow_mm;        /* height of the middle of the plate above its rim, across the cylinder */
    double bow_rad;       /* azimuth of the direction across the cylinder */
    double print_scale;   /* of what is printed */
    double division[2];   /* radius undistorted = distorted / (1 + division[0] r^2 + division[1] r^4) */
    double decentring[2]; /* Conrady's, of the distorted coordinates */
    double wide;          /* the light falls off as cos^4 atan(wide r) */
    double fill;          /* side of the sensitive square of a pixel, in pixels */
    double aperture_px;   /* circumradius of the hexagon of confusion at the distance in focus, pixels */
    int black_off;        /* true black level minus the declared one */
    double focal_error;   /* relative */
    double principal_px;  /* error along both axes */
} other_rig;

/* All of it off, as the tests use it, and a rig that is what its session says but for the lens, which has no higher
 * orders. */
other_rig other_rig_off(void);
other_rig other_rig_true(void);

/* Writes a session of OTHER_RIG_SHOTS photographs, from 0 to 75 degrees, into the new folder `folder`. Fails the
 * running test where it cannot. Uses OpenMP. */
void other_rig_take(const other_rig *rig, const char *folder);

/* Theta of view `view`, degrees. */
double other_rig_tilt_deg(int view);

/* Where view `view` truly sees the place that is drawn (not printed) at x, y mm. */
weft_pixel other_rig_pixel(const other_rig *rig, int view, double x_mm, double y_mm);

/* Reflectance times the cosine of the light of texel (column, row) of `texels` a side, under shot `shot`. */
void other_rig_reflectance(int shot, int column, int row, int texels, double rgb[3]);

#endif

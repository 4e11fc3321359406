/* A photograph beside its prediction: the drawn target under an estimate of its pose, and a smooth lighting that takes
 * the one to the other. */
#ifndef WEFT_REGISTRATION_POSE_PLATE_COMPARISON_H
#define WEFT_REGISTRATION_POSE_PLATE_COMPARISON_H

#include "registration/pose/prediction.h"

/* Coefficients of the lighting: a polynomial of second degree over the photograph. */
enum { WEFT_LIGHTING_COUNT = 6 };

typedef struct weft_plate_comparison {
    const weft_sight *sight; /* borrowed */
    double blur_px;          /* of both sides; 0: they are compared as they are */
    float *photograph;       /* [height][width], owned */
    float *weight;           /* [height][width], owned; the blurred mask where blur_px > 0 */
    weft_prediction prediction;
    double gain[WEFT_LIGHTING_COUNT], stray; /* photograph = gain(x, y) . prediction + stray */
    double focus_limit;                      /* largest focus factor among the compared pixels */
} weft_plate_comparison;

/* The caller frees with weft_plate_comparison_free. `sight` is borrowed. Errors: WEFT_SYSTEM for memory. */
weft_code weft_plate_comparison_create(const weft_sight *sight, double blur_px, weft_plate_comparison *comparison,
                                       weft_error *error);
void weft_plate_comparison_free(weft_plate_comparison *comparison);

/* Draws the prediction under an estimate, and takes the photograph [height][width] anew; values of it that are not
 * finite are not compared. Both are blurred where blur_px > 0. Errors: WEFT_SYSTEM for memory. Uses OpenMP. */
weft_code weft_plate_comparison_look(weft_plate_comparison *comparison, const float *photograph,
                                     const weft_homography *homography, weft_point_spread point_spread,
                                     weft_error *error);

/* The lighting before the first step: even, without stray light. */
void weft_plate_comparison_guess_lighting(weft_plate_comparison *comparison);

/* 1, u, v, u u, u v, v v at pixel (x, y), where u and v are 0 at the centre and 1 at the longer edge. */
void weft_lighting_basis(const weft_camera *camera, int x, int y, double basis[WEFT_LIGHTING_COUNT]);
double weft_lighting_at(const double basis[WEFT_LIGHTING_COUNT], const double coefficient[WEFT_LIGHTING_COUNT]);

/* Correlation, -1..1, of the photograph with the prediction under the lighting, over what is left of both when their
 * smooth parts are taken away: a lighting gradient on a bare surface would correlate by itself. 0 where nothing is
 * compared. */
double weft_plate_comparison_correlate(const weft_plate_comparison *comparison);

#endif

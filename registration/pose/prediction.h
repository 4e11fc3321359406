/* The photograph of the target that a pose predicts: what is compared with the one that was taken. */
#ifndef WEFT_REGISTRATION_POSE_PREDICTION_H
#define WEFT_REGISTRATION_POSE_PREDICTION_H

#include "btf/session/camera.h"
#include "registration/pose/drawing.h"
#include "registration/pose/plate_view.h"

/* The point spread function of the lens, by how wide it is: the variance per axis, in pixels^2 beyond the pixel's own
 * square, of the light of a point of the plate on the sensor. It is constant + depth x (1 - focus / z)^2, with z the
 * distance along the camera's axis and focus that of the plate's origin. The second term is the circle of confusion of
 * a thin lens. */
typedef struct weft_point_spread {
    double constant, depth;
} weft_point_spread;

/* What stays the same for all photographs of a session. */
typedef struct weft_sight {
    weft_camera camera;
    weft_drawing drawing;
    double opening_mm;
    weft_bend bend;            /* of the plate; weft_sight_create makes it flat */
    float (*undistorted)[2];   /* [height][width] undistorted pixel coordinates of the pixel centres */
    float *inverse_vignetting; /* [height][width]; 0: the pixel counts for nothing */
} weft_sight;

/* Per pixel, [height][width], of the size of the camera. */
typedef struct weft_prediction {
    float *reflectance; /* of the drawn target, averaged as a pixel would; 0 off the plate */
    float *focus;       /* (1 - focus / z)^2, the factor of weft_point_spread.depth */
    uint8_t *compared;  /* 1 where nothing but the drawing is within reach of the pixel and of its neighbours */
} weft_prediction;

/* The caller frees with weft_sight_free. Errors: WEFT_BAD_INPUT for an impossible camera or target; WEFT_SYSTEM. */
weft_code weft_sight_create(const weft_camera *camera, const weft_target *target, double pixels_per_mm,
                            weft_sight *sight, weft_error *error);
void weft_sight_free(weft_sight *sight);

weft_code weft_prediction_create(const weft_camera *camera, weft_prediction *prediction, weft_error *error);
void weft_prediction_free(weft_prediction *prediction);

/* Draws what the camera sees of the target under `homography` (plate mm to undistorted pixels, any scale), in focus at
 * the origin of the plate. Pure; uses OpenMP. */
void weft_prediction_draw(const weft_sight *sight, const weft_homography *homography, weft_point_spread point_spread,
                          weft_prediction *prediction);

#endif

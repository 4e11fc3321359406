/* The highlight of the lamp on a mirror ball of the sheet. */
#ifndef WEFT_REGISTRATION_LAMP_BALL_H
#define WEFT_REGISTRATION_LAMP_BALL_H

#include "registration/lamp/photograph.h"
#include "registration/lamp/read.h"

/* Where a highlight is seen. */
typedef struct weft_highlight {
    bool found;
    weft_vec3 ray;        /* unit, plate frame, from the camera toward the highlight */
    double deviation_rad; /* standard error of the direction that it mirrors: what a fraction of a pixel makes */
} weft_highlight;

/* Looks for the brightest small spot within the outline of the ball that touches the plate at (place[0], place[1]), mm,
 * where it mirrors what is above the sheet.
 * A ball that is hidden, or out of the picture, or without a bright spot has none. Pure. */
weft_highlight weft_ball_highlight(const weft_camera *camera, const weft_pose *pose, const weft_light_values *values,
                                   const double place[2], double diameter_mm);

#endif

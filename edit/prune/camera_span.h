/* Camera and lights of a scene between two moments of its path, with bounds: all that lies between two scenes whose
 * values are the least and the largest there (weft_path_span). */
#ifndef WEFT_EDIT_PRUNE_CAMERA_SPAN_H
#define WEFT_EDIT_PRUNE_CAMERA_SPAN_H

#include "base/vector.h"
#include "player/scene/scene.h"

/* All unit vectors within an angle of an axis. */
typedef struct weft_direction_cap {
    weft_vec3 axis;
    double angle_rad;
} weft_direction_cap;

typedef struct weft_camera_span {
    weft_vec3 eye;                  /* in the middle of the span */
    double eye_shift;               /* the eye is never further from there */
    weft_orbit_axes axes;           /* of the picture, unit, in the middle of the span */
    double turn_rad;                /* they are never turned further than that */
    double half_width, half_height; /* of the picture at unit distance */
    double pixel;                   /* side of a pixel there */
    double nearest;                 /* what is nearer along the view is not drawn */
    int light_count;                /* lights that are not black */
    weft_direction_cap light[WEFT_SCENE_MAX_LIGHTS];
} weft_camera_span;

/* `low` and `high` bound the scene; centre and radius are those of the mesh. Pure. */
weft_camera_span weft_camera_span_of(const weft_scene *low, const weft_scene *high, weft_vec3 centre, double radius,
                                     int width, int height);

/* How far, in radians or shares of the distance, anything moves within the span: what spans are halved by. Under an
 * environment lights do not count, as there is light from everywhere. Pure. */
double weft_camera_span_width(const weft_scene *low, const weft_scene *high);

#endif

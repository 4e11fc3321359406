/* A camera that circles round a centre. The world has z up. Pure. */
#ifndef WEFT_PLAYER_SCENE_ORBIT_H
#define WEFT_PLAYER_SCENE_ORBIT_H

#include "base/vector.h"

/* distance in radii of what is looked at (1 touches its bounding sphere). azimuth from x toward y; elevation from the
 * horizon, up to 90 degrees, where the azimuth still says which way is up in the picture: away from it. */
typedef struct weft_orbit {
    double azimuth_rad, elevation_rad, distance;
    double pan_right, pan_up; /* of what is looked at from the centre, in radii along the picture's axes */
} weft_orbit;

/* Right, up and backward (toward the eye) of the picture, unit. */
typedef struct weft_orbit_axes {
    weft_vec3 right, up, backward;
} weft_orbit_axes;

/* Half of the smaller side of the picture at unit distance. */
double weft_orbit_slope(void);

/* The distance at which the bounding sphere just touches the smaller sides of the picture. */
double weft_orbit_whole(void);

weft_orbit_axes weft_orbit_axes_of(const weft_orbit *orbit);

/* What moves a camera, within its limits: elevation up to 89.9 degrees either way, distance 1.05 to 60, pans up to 4.
 */
void weft_orbit_turn(weft_orbit *orbit, double azimuth_rad, double elevation_rad);
void weft_orbit_pan(weft_orbit *orbit, double right, double up);
void weft_orbit_zoom(weft_orbit *orbit, double factor); /* of the distance */

/* Place of the eye around a bounding sphere. */
weft_vec3 weft_orbit_eye(const weft_orbit *orbit, weft_vec3 centre, double radius);

/* The ray from the eye through the point x, y of a picture of width x height pixels (from its lower left corner) is
 * x right + y up - backward, of no particular length; shifts as below. */
weft_orbit_axes weft_orbit_rays(const weft_orbit *orbit, int width, int height, double shift_x, double shift_y);

/* OpenGL's clip_of_world, column-major, for a picture of the given aspect (width / height); the smaller side spans 30
 * degrees. shift_x, shift_y move the picture, in units of its width and height. */
void weft_orbit_clip_of_world(const weft_orbit *orbit, weft_vec3 centre, double radius, double aspect, double shift_x,
                              double shift_y, float matrix[16]);

#endif

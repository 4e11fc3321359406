#include "player/window/space_mouse/space_mouse.h"

static const double dead_zone = 0.04;
static const double turn_rad_per_s = WEFT_PI, pan_pictures_per_s = 0.5, zoom_per_s = 1.4;
/* A loop that stood still (a window being moved, a file dialog) is no long push. */
static const double longest_step_s = 0.1;

static double speed_of(double deflection)
{
    if (!(fabs(deflection) > dead_zone))
        return 0;
    double beyond = (fmin(fabs(deflection), 1) - dead_zone) / (1 - dead_zone);
    return copysign(beyond * beyond, deflection);
}

bool weft_space_mouse_move(weft_orbit *orbit, const weft_space_motion *motion, double elapsed_s)
{
    double step_s = weft_clamp(elapsed_s, 0, longest_step_s);
    weft_orbit before = *orbit;
    double pan = 2 * weft_orbit_slope() * orbit->distance * pan_pictures_per_s * step_s;
    weft_orbit_turn(orbit, -turn_rad_per_s * step_s * speed_of(motion->rotation[1]),
                    turn_rad_per_s * step_s * speed_of(motion->rotation[0]));
    weft_orbit_pan(orbit, -pan * speed_of(motion->translation[0]), -pan * speed_of(motion->translation[1]));
    weft_orbit_zoom(orbit, exp(-zoom_per_s * step_s * speed_of(motion->translation[2])));
    return orbit->azimuth_rad != before.azimuth_rad || orbit->elevation_rad != before.elevation_rad ||
           orbit->distance != before.distance || orbit->pan_right != before.pan_right || orbit->pan_up != before.pan_up;
}

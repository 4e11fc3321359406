#include "capture/plan.h"

#include <stdbool.h>

static const double lowest_light_deg = 89;

/* Unit vector perpendicular to `view` that leads from it to `light`, or toward the zenith where the two coincide
 * (toward +x where the view is the zenith). */
static weft_vec3 way_aside(weft_vec3 light, weft_vec3 view)
{
    weft_vec3 goal = weft_length(weft_subtract(light, view)) > 1e-9 ? light : weft_vec3_of(0, 0, 1);
    weft_vec3 aside = weft_subtract(goal, weft_scale(view, weft_dot(goal, view)));
    if (weft_length(aside) < 1e-9)
        aside = weft_vec3_of(1, 0, 0);
    return weft_unit(aside);
}

/* The direction at `half_angle_rad` from the view, `turn_rad` round it from `aside`. */
static weft_vec3 beside(weft_vec3 view, weft_vec3 aside, double half_angle_rad, double turn_rad)
{
    weft_vec3 across = weft_cross(view, aside);
    weft_vec3 way = weft_add(weft_scale(aside, cos(turn_rad)), weft_scale(across, sin(turn_rad)));
    return weft_unit(weft_add(weft_scale(view, cos(half_angle_rad)), weft_scale(way, sin(half_angle_rad))));
}

weft_angles weft_light_beside_camera(weft_angles light, weft_angles view, double half_angle_rad)
{
    weft_vec3 toward_light = weft_direction_of_angles(light), toward_view = weft_direction_of_angles(view);
    if (weft_dot(toward_light, toward_view) < cos(half_angle_rad))
        return light;
    weft_vec3 aside = way_aside(toward_light, toward_view);
    /* The farther the turn from the direct way, the farther the direction from the light. */
    for (int step = 0; step <= 180; step++) {
        for (int side = 1; side >= -1; side -= 2) {
            weft_vec3 driven = beside(toward_view, aside, half_angle_rad, side * weft_rad_of_deg(step));
            weft_angles angles = weft_angles_of_direction(driven);
            if (driven.z > 0 && angles.theta_rad <= weft_rad_of_deg(lowest_light_deg))
                return angles;
        }
    }
    return light;
}

void weft_plan_avoid_camera(weft_plan *plan, double half_angle_rad)
{
    for (int i = 0; i < plan->shot_count; i++) {
        weft_shot *shot = &plan->shot[i];
        shot->light_driven = weft_light_beside_camera(shot->light, shot->view, half_angle_rad);
    }
}

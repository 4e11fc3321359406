#include "capture/virtual/ring.h"

#include <math.h>

static double sector_rad(const weft_virtual_world *world)
{
    return 2 * WEFT_PI / world->settings.cameras;
}

/* From 0 to below one turn, and 0 for what is nearly one. */
static double wrapped(double rad)
{
    const double turn = 2 * WEFT_PI, nearly = 1e-9;
    double within = rad - turn * floor(rad / turn);
    return within > turn - nearly ? 0 : within;
}

int weft_virtual_ring_camera(const weft_virtual_world *world, weft_angles view)
{
    const double nearly = 1e-9;
    return (int)floor(wrapped(view.phi_rad) / sector_rad(world) + nearly);
}

weft_angles weft_virtual_ring_view(const weft_virtual_world *world, weft_angles view, int other)
{
    return (weft_angles){view.theta_rad, wrapped(view.phi_rad + (other - world->index) * sector_rad(world))};
}

bool weft_virtual_ring_shadows(const weft_virtual_world *world, weft_angles view, weft_vec3 light)
{
    double covered_rad = 0.9 * weft_rad_of_deg(world->settings.rig.camera_half_angle_deg);
    bool shadowed = false;
    for (int other = 0; view.theta_rad > 0 && other < (int)world->settings.cameras; other++) {
        weft_vec3 body = weft_direction_of_angles(weft_virtual_ring_view(world, view, other));
        shadowed = shadowed || (other != world->index && weft_dot(body, weft_unit(light)) > cos(covered_rad));
    }
    return shadowed;
}

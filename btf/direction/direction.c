#include "btf/direction/direction.h"

static const int ring_size[6] = {1, 6, 12, 18, 20, 24};
static const int ring_step_deg = 15;

weft_vec3 weft_direction_of_angles(weft_angles angles)
{
    weft_real sine = sin(angles.theta_rad);
    return (weft_vec3){sine * cos(angles.phi_rad), sine * sin(angles.phi_rad), cos(angles.theta_rad)};
}

weft_angles weft_angles_of_direction(weft_vec3 d)
{
    weft_real horizontal = hypot(d.x, d.y);
    weft_real phi = horizontal > 0 ? atan2(d.y, d.x) : 0;
    return (weft_angles){atan2(horizontal, d.z), phi < 0 ? phi + 2 * WEFT_PI : phi};
}

weft_angles weft_ubo81_angles(int index)
{
    int ring = 0;
    while (index >= ring_size[ring])
        index -= ring_size[ring++];
    weft_real theta_deg = ring * ring_step_deg;
    weft_real phi_deg = (weft_real)360 * index / ring_size[ring];
    return (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
}

int weft_ubo81_ring(weft_real theta_rad)
{
    long ring = lround(weft_deg_of_rad(theta_rad) / ring_step_deg);
    return ring < 0 ? 0 : ring > 5 ? 5 : (int)ring;
}

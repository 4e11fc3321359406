#include "btf/direction/direction.h"

static const int ring_step_deg = 15;

/* Directions at one theta, equally spaced. */
typedef struct sampling_ring {
    double theta_deg;
    int size;
    double first_deg;
} sampling_ring;

static const sampling_ring ubo81[] = {{0, 1, 0}, {15, 6, 0}, {30, 12, 0}, {45, 18, 0}, {60, 20, 0}, {75, 24, 0}};
static const sampling_ring ubo151[] = {{0, 1, 0},   {11, 6, 15},     {23.5, 12, 0}, {30, 12, 15},    {37.5, 12, 0},
                                       {45, 18, 0}, {52.5, 18, 7.5}, {60, 24, 0},   {67.5, 24, 7.5}, {75, 24, 0}};

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

static weft_angles angles_in_rings(const sampling_ring *r, int index)
{
    for (; index >= r->size; r++)
        index -= r->size;
    weft_real phi_deg = (weft_real)r->first_deg + (weft_real)360 * index / r->size;
    return (weft_angles){weft_rad_of_deg((weft_real)r->theta_deg), weft_rad_of_deg(phi_deg)};
}

weft_angles weft_ubo81_angles(int index)
{
    return angles_in_rings(ubo81, index);
}

weft_angles weft_ubo151_angles(int index)
{
    return angles_in_rings(ubo151, index);
}

int weft_ubo81_ring(weft_real theta_rad)
{
    long ring = lround(weft_deg_of_rad(theta_rad) / ring_step_deg);
    return ring < 0 ? 0 : ring > 5 ? 5 : (int)ring;
}

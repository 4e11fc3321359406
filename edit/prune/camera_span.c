#include "edit/prune/visibility_bounds.h"

static double middle(double low, double high)
{
    return low + (high - low) / 2;
}

static weft_orbit middle_orbit(const weft_orbit *low, const weft_orbit *high)
{
    return (weft_orbit){middle(low->azimuth_rad, high->azimuth_rad), middle(low->elevation_rad, high->elevation_rad),
                        middle(low->distance, high->distance), middle(low->pan_right, high->pan_right),
                        middle(low->pan_up, high->pan_up)};
}

/* Half of what the angles of the orbit span: turning about two axes in turn turns by no more than their sum. */
static double turn_of(const weft_orbit *low, const weft_orbit *high)
{
    return (high->azimuth_rad - low->azimuth_rad + high->elevation_rad - low->elevation_rad) / 2;
}

static double farther(double low, double high)
{
    return fmax(fabs(low), fabs(high));
}

/* The eye lies at an offset from the centre that turns and changes: each by its own bound. In radii. */
static double shift_of(const weft_orbit *low, const weft_orbit *high)
{
    double change =
        (high->distance - low->distance + high->pan_right - low->pan_right + high->pan_up - low->pan_up) / 2;
    double visibility = high->distance + farther(low->pan_right, high->pan_right) + farther(low->pan_up, high->pan_up);
    return change + visibility * turn_of(low, high);
}

/* A colatitude and an azimuth move a direction by no more than their sum. */
static void add_light(const weft_scene *low, const weft_scene *high, int i, weft_camera_span *span)
{
    const weft_light *from = &low->light[i], *to = &high->light[i];
    const double *irradiance = from->irradiance;
    if (!(irradiance[0] > 0 || irradiance[1] > 0 || irradiance[2] > 0))
        return;
    const weft_angles angles = {middle(from->direction.theta_rad, to->direction.theta_rad),
                                middle(from->direction.phi_rad, to->direction.phi_rad)};
    double moved =
        (to->direction.theta_rad - from->direction.theta_rad + to->direction.phi_rad - from->direction.phi_rad) / 2;
    span->light[span->light_count++] =
        (weft_direction_cap){weft_direction_of_angles(angles), moved + (i == 0 ? high->key_size_rad : 0)};
}

weft_camera_span weft_camera_span_of(const weft_scene *low, const weft_scene *high, weft_vec3 centre, double radius,
                                     int width, int height)
{
    weft_orbit orbit = middle_orbit(&low->orbit, &high->orbit);
    double slope = weft_orbit_slope(), shorter = width < height ? width : height;
    weft_camera_span span = {
        .eye = weft_orbit_eye(&orbit, centre, radius),
        .eye_shift = radius * shift_of(&low->orbit, &high->orbit),
        .axes = weft_orbit_axes_of(&orbit),
        .turn_rad = turn_of(&low->orbit, &high->orbit),
        .half_width = slope * width / shorter,
        .half_height = slope * height / shorter,
        .pixel = 2 * slope / shorter,
        .nearest = radius * fmax(low->orbit.distance - 1.1, 0.02),
    };
    for (int i = 0; i < low->light_count; i++)
        add_light(low, high, i, &span);
    return span;
}

double weft_camera_span_width(const weft_scene *low, const weft_scene *high)
{
    const weft_orbit *a = &low->orbit, *b = &high->orbit;
    const weft_angles *from = &low->light[0].direction, *to = &high->light[0].direction;
    double clearance = fmax(a->distance - 1, 0.05);
    double moved = shift_of(a, b) / clearance;
    bool lights_matter = low->light_count > 0 && !low->environment;
    double lit = lights_matter ? to->theta_rad - from->theta_rad + to->phi_rad - from->phi_rad : 0;
    return fmax(2 * moved, lit);
}

#include "player/scene/orbit.h"

static const double field_of_view_rad = 30 * WEFT_PI / 180;
static const double highest_elevation_rad = 89.9 * WEFT_PI / 180;
static const double nearest_distance = 1.05, farthest_distance = 60, farthest_pan = 4;

void weft_orbit_turn(weft_orbit *orbit, double azimuth_rad, double elevation_rad)
{
    orbit->azimuth_rad = fmod(orbit->azimuth_rad + azimuth_rad, 2 * WEFT_PI);
    orbit->elevation_rad =
        weft_clamp(orbit->elevation_rad + elevation_rad, -highest_elevation_rad, highest_elevation_rad);
}

void weft_orbit_pan(weft_orbit *orbit, double right, double up)
{
    orbit->pan_right = weft_clamp(orbit->pan_right + right, -farthest_pan, farthest_pan);
    orbit->pan_up = weft_clamp(orbit->pan_up + up, -farthest_pan, farthest_pan);
}

void weft_orbit_zoom(weft_orbit *orbit, double factor)
{
    orbit->distance = weft_clamp(orbit->distance * factor, nearest_distance, farthest_distance);
}

weft_orbit_axes weft_orbit_axes_of(const weft_orbit *orbit)
{
    double sa = sin(orbit->azimuth_rad), ca = cos(orbit->azimuth_rad);
    double se = sin(orbit->elevation_rad), ce = cos(orbit->elevation_rad);
    return (weft_orbit_axes){
        .right = {-sa, ca, 0},
        .up = {-se * ca, -se * sa, ce},
        .backward = {ce * ca, ce * sa, se},
    };
}

weft_vec3 weft_orbit_eye(const weft_orbit *orbit, weft_vec3 centre, double radius)
{
    weft_orbit_axes axes = weft_orbit_axes_of(orbit);
    weft_vec3 aside = weft_add(weft_scale(axes.right, orbit->pan_right), weft_scale(axes.up, orbit->pan_up));
    return weft_add(centre, weft_scale(weft_add(aside, weft_scale(axes.backward, orbit->distance)), radius));
}

double weft_orbit_slope(void)
{
    return tan(field_of_view_rad / 2);
}

double weft_orbit_whole(void)
{
    return 1 / sin(field_of_view_rad / 2);
}

/* Half the picture's width and height at unit distance. */
static void half_sizes(double aspect, double *x, double *y)
{
    double slope = weft_orbit_slope();
    *x = aspect > 1 ? slope * aspect : slope;
    *y = aspect > 1 ? slope : slope / aspect;
}

weft_orbit_axes weft_orbit_rays(const weft_orbit *orbit, int width, int height, double shift_x, double shift_y)
{
    weft_orbit_axes axes = weft_orbit_axes_of(orbit);
    double x, y;
    half_sizes((double)width / height, &x, &y);
    weft_vec3 corner =
        weft_add(weft_scale(axes.right, -x * (1 + 2 * shift_x)), weft_scale(axes.up, -y * (1 + 2 * shift_y)));
    return (weft_orbit_axes){
        .right = weft_scale(axes.right, 2 * x / width),
        .up = weft_scale(axes.up, 2 * y / height),
        .backward = weft_subtract(axes.backward, corner),
    };
}

/* One clip coordinate: the distance from the eye along `axis`, plus a constant. */
static void set_row(float matrix[16], int row, weft_vec3 axis, weft_vec3 eye, double constant)
{
    matrix[row] = (float)axis.x;
    matrix[4 + row] = (float)axis.y;
    matrix[8 + row] = (float)axis.z;
    matrix[12 + row] = (float)(constant - weft_dot(axis, eye));
}

void weft_orbit_clip_of_world(const weft_orbit *orbit, weft_vec3 centre, double radius, double aspect, double shift_x,
                              double shift_y, float matrix[16])
{
    weft_orbit_axes axes = weft_orbit_axes_of(orbit);
    weft_vec3 eye = weft_orbit_eye(orbit, centre, radius), forward = weft_scale(axes.backward, -1);
    double half_x, half_y;
    half_sizes(aspect, &half_x, &half_y);
    double nearest = fmax(orbit->distance - 1.1, 0.02) * radius, farthest = (orbit->distance + 1.1) * radius;
    double depth = (farthest + nearest) / (farthest - nearest);
    double offset = -2 * farthest * nearest / (farthest - nearest);
    /* A shift is a multiple of w, and w is the forward distance. */
    set_row(matrix, 0, weft_add(weft_scale(axes.right, 1 / half_x), weft_scale(forward, 2 * shift_x)), eye, 0);
    set_row(matrix, 1, weft_add(weft_scale(axes.up, 1 / half_y), weft_scale(forward, 2 * shift_y)), eye, 0);
    set_row(matrix, 2, weft_scale(forward, depth), eye, offset);
    set_row(matrix, 3, forward, eye, 0);
}

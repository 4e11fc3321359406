#include "registration/hand/ball.h"

#include <math.h>
#include <stdlib.h>

/* A spot is what is brighter than this share of its brightest pixel; one larger than this share of the ball's outline,
 * or dimmer than this many times what the ball shows at the median, is no lamp. */
static const double spot_share = 0.5, largest_share = 0.12, least_contrast = 3;

/* How far the centre of a spot lies from the middle of the highlight, and what the shape of ball and lamp add. */
static const double spot_error_px = 0.2, least_deviation_rad = 0.002;

/* Of the outline: beyond it lies the paper. */
static const double inner_share = 0.97;

/* The pixels of the outline, as a disc in the photograph. */
typedef struct disc {
    double x, y, radius;
} disc;

static weft_vec3 in_camera(const weft_pose *pose, weft_vec3 p)
{
    const double(*r)[3] = pose->rotation;
    return (weft_vec3){r[0][0] * p.x + r[0][1] * p.y + r[0][2] * p.z + pose->translation.x,
                       r[1][0] * p.x + r[1][1] * p.y + r[1][2] * p.z + pose->translation.y,
                       r[2][0] * p.x + r[2][1] * p.y + r[2][2] * p.z + pose->translation.z};
}

static disc outline_of(const weft_camera *camera, const weft_pose *pose, const double place[2], double diameter_mm)
{
    weft_vec3 c = in_camera(pose, weft_vec3_of(place[0], place[1], diameter_mm / 2));
    if (!(c.z > diameter_mm))
        return (disc){0, 0, 0};
    weft_pixel ideal = {camera->cx + camera->fx * c.x / c.z, camera->cy + camera->fy * c.y / c.z};
    weft_pixel seen = weft_camera_distort(camera, ideal);
    return (disc){seen.x, seen.y, camera->fx * diameter_mm / 2 / c.z};
}

/* Brightness of a pixel; a clipped one is brighter than all others. */
static double brightness(const weft_light_values *values, int x, int y)
{
    float grey = values->grey[(long)y * values->width + x];
    return isfinite(grey) ? (double)grey : 2;
}

static weft_vec3 ray_of(const weft_camera *camera, const weft_pose *pose, double x, double y)
{
    weft_pixel ideal = weft_camera_undistort(camera, (weft_pixel){x, y});
    double a = (ideal.x - camera->cx) / camera->fx, b = (ideal.y - camera->cy) / camera->fy;
    const double(*r)[3] = pose->rotation;
    return weft_unit(weft_vec3_of(r[0][0] * a + r[1][0] * b + r[2][0], r[0][1] * a + r[1][1] * b + r[2][1],
                                  r[0][2] * a + r[1][2] * b + r[2][2]));
}

typedef struct spot {
    double x, y, weight, sum; /* sum over all pixels of the disc */
    long pixels, disc_pixels;
    double brightest;
    int at_x, at_y;
} spot;

static bool in_disc(const disc *d, int x, int y)
{
    return (x - d->x) * (x - d->x) + (y - d->y) * (y - d->y) <= d->radius * d->radius;
}

static void find_brightest(const weft_light_values *values, const disc *d, const int box[4], spot *s)
{
    for (int y = box[1]; y <= box[3]; y++) {
        for (int x = box[0]; x <= box[2]; x++) {
            if (!in_disc(d, x, y))
                continue;
            double value = brightness(values, x, y);
            s->sum += value;
            s->disc_pixels++;
            if (value > s->brightest)
                s->brightest = value, s->at_x = x, s->at_y = y;
        }
    }
}

/* The centre of what is bright around the brightest pixel. */
static void weigh(const weft_light_values *values, const disc *d, const int box[4], spot *s)
{
    double reach = fmax(2, d->radius * sqrt(largest_share));
    for (int y = box[1]; y <= box[3]; y++) {
        for (int x = box[0]; x <= box[2]; x++) {
            double value = brightness(values, x, y);
            if (!in_disc(d, x, y) || value < spot_share * s->brightest)
                continue;
            s->pixels++;
            if (hypot(x - s->at_x, y - s->at_y) > reach)
                continue;
            s->x += value * x, s->y += value * y, s->weight += value;
        }
    }
}

weft_highlight weft_ball_highlight(const weft_camera *camera, const weft_pose *pose, const weft_light_values *values,
                                   const double place[2], double diameter_mm)
{
    const double fewest_px = 8;
    weft_highlight none = {0};
    disc d = outline_of(camera, pose, place, diameter_mm);
    if (!(d.radius >= fewest_px) || !(d.x - d.radius >= 1) || !(d.y - d.radius >= 1) ||
        !(d.x + d.radius <= values->width - 2) || !(d.y + d.radius <= values->height - 2))
        return none;
    d.radius *= inner_share;
    const int box[4] = {(int)(d.x - d.radius), (int)(d.y - d.radius), (int)(d.x + d.radius + 1),
                        (int)(d.y + d.radius + 1)};
    spot s = {0};
    find_brightest(values, &d, box, &s);
    weigh(values, &d, box, &s);
    if (!(s.brightest > least_contrast * s.sum / (double)s.disc_pixels) ||
        (double)s.pixels > largest_share * (double)s.disc_pixels)
        return none;
    /* The ball's normal turns by 1 / radius a pixel, and what it mirrors by twice that. */
    double deviation_rad = hypot(least_deviation_rad, 2 * spot_error_px / d.radius);
    return (weft_highlight){true, ray_of(camera, pose, s.x / s.weight, s.y / s.weight), deviation_rad};
}

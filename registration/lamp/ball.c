#include "registration/lamp/evidence.h"

#include <math.h>
#include <stdlib.h>

/* A spot is what is brighter than this share of its brightest pixel; one larger than this share of the ball's outline,
 * or dimmer than this many times what the ball shows at the median, is no lamp. */
static const double spot_share = 0.5, largest_share = 0.12, least_contrast = 3;

/* How far the centre of a spot lies from the middle of the highlight, and what the shape of ball and lamp add. */
static const double spot_error_px = 0.2, least_deviation_rad = 0.002;

/* Of the outline: beyond it lies the paper. */
static const double inner_share = 0.97;

/* What a ball shows of the sheet beside it can be as bright as the lamp where the file is clipped. So only what it
 * mirrors from above counts: where the mirrored ray rises more than this. */
static const double least_rise = 0.07;

/* The pixels of the outline, as a disc in the photograph. */
typedef struct disc {
    double x, y, radius;
} disc;

/* A ball before the camera. */
typedef struct sight {
    const weft_camera *camera;
    const weft_pose *pose;
    weft_vec3 eye, centre;
    double radius_mm;
    disc outline;
} sight;

static weft_vec3 in_camera(const weft_pose *pose, weft_vec3 p)
{
    const double(*r)[3] = pose->rotation;
    return (weft_vec3){r[0][0] * p.x + r[0][1] * p.y + r[0][2] * p.z + pose->translation.x,
                       r[1][0] * p.x + r[1][1] * p.y + r[1][2] * p.z + pose->translation.y,
                       r[2][0] * p.x + r[2][1] * p.y + r[2][2] * p.z + pose->translation.z};
}

static disc outline_of(const weft_camera *camera, const weft_pose *pose, weft_vec3 centre, double diameter_mm)
{
    weft_vec3 c = in_camera(pose, centre);
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

bool weft_ball_mirror(weft_vec3 eye, weft_vec3 ray, weft_vec3 centre, double radius_mm, weft_vec3 *from,
                      weft_vec3 *mirrored)
{
    weft_vec3 offset = weft_subtract(eye, centre);
    double half = weft_dot(offset, ray), root = half * half - weft_dot(offset, offset) + radius_mm * radius_mm;
    if (!(root >= 0))
        return false;
    *from = weft_add(eye, weft_scale(ray, -half - sqrt(root)));
    weft_vec3 normal = weft_scale(weft_subtract(*from, centre), 1 / radius_mm);
    *mirrored = weft_subtract(ray, weft_scale(normal, 2 * weft_dot(ray, normal)));
    return true;
}

/* How the ray of a pixel meets the ball: the cosine of its incidence, and how much the mirrored ray rises. False where
 * it passes. */
static bool meet_ball(const sight *s, double x, double y, double *cosine, double *rise)
{
    weft_vec3 ray = ray_of(s->camera, s->pose, x, y), from, mirrored;
    if (!weft_ball_mirror(s->eye, ray, s->centre, s->radius_mm, &from, &mirrored))
        return false;
    *cosine = weft_dot(ray, weft_subtract(s->centre, from)) / s->radius_mm;
    *rise = mirrored.z;
    return true;
}

static bool shows_above(const sight *s, int x, int y)
{
    double cosine, rise;
    return meet_ball(s, x, y, &cosine, &rise) && rise > least_rise;
}

typedef struct spot {
    double x, y, weight, sum; /* sum over all pixels of the disc */
    long pixels, disc_pixels;
    double brightest;
    double most; /* around (at_x, at_y) */
    int at_x, at_y;
} spot;

static bool in_disc(const disc *d, int x, int y)
{
    return (x - d->x) * (x - d->x) + (y - d->y) * (y - d->y) <= d->radius * d->radius;
}

/* Of the pixel and the eight around it. The other ball mirrors the lamp, too: a speck that is clipped as the lamp's own
 * highlight is, and smaller. */
static double brightness_around(const weft_light_values *values, const sight *ball, int x, int y)
{
    double sum = 0;
    for (int i = 0; i < 9; i++) {
        int at_x = x + i % 3 - 1, at_y = y + i / 3 - 1;
        if (in_disc(&ball->outline, at_x, at_y) && shows_above(ball, at_x, at_y))
            sum += brightness(values, at_x, at_y);
    }
    return sum;
}

static void find_brightest(const weft_light_values *values, const sight *ball, const int box[4], spot *s)
{
    for (int y = box[1]; y <= box[3]; y++) {
        for (int x = box[0]; x <= box[2]; x++) {
            if (!in_disc(&ball->outline, x, y) || !shows_above(ball, x, y))
                continue;
            double value = brightness(values, x, y);
            s->sum += value;
            s->disc_pixels++;
            double around = value >= s->brightest ? brightness_around(values, ball, x, y) : 0;
            if (value > s->brightest || around > s->most)
                s->brightest = value, s->most = around, s->at_x = x, s->at_y = y;
        }
    }
}

/* The centre of what is bright around the brightest pixel. */
static void weigh(const weft_light_values *values, const sight *ball, const int box[4], spot *s)
{
    const disc *d = &ball->outline;
    double reach = fmax(2, d->radius * sqrt(largest_share));
    for (int y = box[1]; y <= box[3]; y++) {
        for (int x = box[0]; x <= box[2]; x++) {
            double value = brightness(values, x, y);
            if (!in_disc(d, x, y) || value < spot_share * s->brightest || !shows_above(ball, x, y))
                continue;
            s->pixels++;
            if (hypot(x - s->at_x, y - s->at_y) > reach)
                continue;
            s->x += value * x, s->y += value * y, s->weight += value;
        }
    }
}

weft_highlight weft_ball_highlight(const weft_camera *camera, const weft_pose *pose, const weft_light_values *values,
                                   weft_vec3 place, double diameter_mm)
{
    const double fewest_px = 8;
    weft_highlight none = {0};
    weft_vec3 centre = weft_add(place, weft_vec3_of(0, 0, diameter_mm / 2));
    disc d = outline_of(camera, pose, centre, diameter_mm);
    if (!(d.radius >= fewest_px) || !(d.x - d.radius >= 1) || !(d.y - d.radius >= 1) ||
        !(d.x + d.radius <= values->width - 2) || !(d.y + d.radius <= values->height - 2))
        return none;
    d.radius *= inner_share;
    const sight ball = {camera, pose, weft_pose_camera_position(pose), centre, diameter_mm / 2, d};
    const int box[4] = {(int)(d.x - d.radius), (int)(d.y - d.radius), (int)(d.x + d.radius + 1),
                        (int)(d.y + d.radius + 1)};
    spot s = {0};
    find_brightest(values, &ball, box, &s);
    weigh(values, &ball, box, &s);
    if (!(s.brightest > least_contrast * s.sum / (double)s.disc_pixels) ||
        (double)s.pixels > largest_share * (double)s.disc_pixels)
        return none;
    /* The ball's normal turns by 1 / radius a pixel, more toward the rim, and what it mirrors by twice that. */
    double cosine, rise;
    if (!meet_ball(&ball, s.x / s.weight, s.y / s.weight, &cosine, &rise))
        return none;
    double deviation_rad = hypot(least_deviation_rad, 2 * spot_error_px / (d.radius * cosine));
    return (weft_highlight){true, ray_of(camera, pose, s.x / s.weight, s.y / s.weight), deviation_rad};
}

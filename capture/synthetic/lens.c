#include "capture/synthetic/scene.h"

static const double field_end = 1.1;

static double pitch_mm(const weft_synthetic_lens *lens)
{
    return lens->sensor_width_mm / lens->width;
}

static double half_diagonal_mm(const weft_synthetic_lens *lens)
{
    return 0.5 * pitch_mm(lens) * hypot(lens->width, lens->height);
}

/* q^2 of a pixel. */
static double field_squared(const weft_synthetic_lens *lens, double x, double y)
{
    double scale = pitch_mm(lens) / half_diagonal_mm(lens);
    double dx = (x - lens->axis_x) * scale, dy = (y - lens->axis_y) * scale;
    return dx * dx + dy * dy;
}

static double division_of(const weft_synthetic_lens *lens, double q2)
{
    return 1 + q2 * (lens->division[0] + q2 * lens->division[1]);
}

void weft_synthetic_lens_slopes(const weft_synthetic_lens *lens, double x, double y, double slope[2])
{
    double scale = pitch_mm(lens) / (lens->image_distance_mm * division_of(lens, field_squared(lens, x, y)));
    slope[0] = (x - lens->axis_x) * scale;
    slope[1] = (y - lens->axis_y) * scale;
}

bool weft_synthetic_lens_ray(const weft_synthetic_lens *lens, double x, double y, const double pupil[2],
                             weft_synthetic_ray *ray)
{
    double slope[2];
    weft_synthetic_lens_slopes(lens, x, y, slope);
    ray->from = weft_vec3_of(pupil[0] * lens->pupil_radius_mm, pupil[1] * lens->pupil_radius_mm, 0);
    weft_vec3 focused = {slope[0] * lens->focus_mm, slope[1] * lens->focus_mm, lens->focus_mm};
    weft_vec3 d = weft_subtract(focused, ray->from);
    double rim_x = ray->from.x + d.x / d.z * lens->rim_mm, rim_y = ray->from.y + d.y / d.z * lens->rim_mm;
    ray->along = weft_unit(d);
    return rim_x * rim_x + rim_y * rim_y <= lens->rim_radius_mm * lens->rim_radius_mm;
}

double weft_synthetic_lens_obliquity(const weft_synthetic_lens *lens, double x, double y)
{
    double slope[2];
    weft_synthetic_lens_slopes(lens, x, y, slope);
    double cosine_squared = 1 / (1 + slope[0] * slope[0] + slope[1] * slope[1]);
    return cosine_squared * cosine_squared;
}

void weft_synthetic_disc(double u, double v, double disc[2])
{
    double a = 2 * u - 1, b = 2 * v - 1;
    bool wide = fabs(a) > fabs(b);
    double radius = wide ? a : b, quotient = wide ? b / a : b != 0 ? a / b : 0;
    double angle = WEFT_PI / 4 * (wide ? quotient : 2 - quotient);
    disc[0] = radius * cos(angle);
    disc[1] = radius * sin(angle);
}

/* Of a grid of rays from one place on the sensor, those that pass. */
static float part_open(const weft_synthetic_lens *lens, double q)
{
    enum { SIDE = 48 };
    double x = lens->axis_x + q * half_diagonal_mm(lens) / pitch_mm(lens);
    int passed = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double pupil[2];
        weft_synthetic_ray ray;
        weft_synthetic_disc((i % SIDE + 0.5) / SIDE, (i / SIDE + 0.5) / SIDE, pupil);
        passed += weft_synthetic_lens_ray(lens, x, lens->axis_y, pupil, &ray);
    }
    return (float)passed / (SIDE * SIDE);
}

void weft_synthetic_lens_prepare(weft_synthetic_lens *lens)
{
    for (int i = 0; i <= WEFT_SYNTHETIC_FIELD_COUNT; i++)
        lens->open[i] = part_open(lens, field_end * i / WEFT_SYNTHETIC_FIELD_COUNT);
}

double weft_synthetic_lens_vignetting(const weft_synthetic_lens *lens, double x, double y)
{
    double at = sqrt(field_squared(lens, x, y)) / field_end * WEFT_SYNTHETIC_FIELD_COUNT;
    int below = at < WEFT_SYNTHETIC_FIELD_COUNT - 1 ? (int)at : WEFT_SYNTHETIC_FIELD_COUNT - 1;
    double part = fmin(at - below, 1);
    return weft_synthetic_lens_obliquity(lens, x, y) * (lens->open[below] * (1 - part) + lens->open[below + 1] * part);
}

/* The distorted q whose undistorted q is `wanted`. It grows with q within the field. */
static double distort(const weft_synthetic_lens *lens, double wanted)
{
    double low = 0, high = 3 * wanted + 1;
    for (int i = 0; i < 55; i++) {
        double middle = 0.5 * (low + high);
        if (middle / division_of(lens, middle * middle) < wanted)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

bool weft_synthetic_lens_project(const weft_synthetic_lens *lens, weft_vec3 point, double pixel[2])
{
    if (!(point.z > 0))
        return false;
    double x = point.x / point.z * lens->image_distance_mm, y = point.y / point.z * lens->image_distance_mm;
    double undistorted = hypot(x, y) / half_diagonal_mm(lens);
    double scale = undistorted > 0 ? distort(lens, undistorted) / undistorted : 1;
    pixel[0] = lens->axis_x + x * scale / pitch_mm(lens);
    pixel[1] = lens->axis_y + y * scale / pitch_mm(lens);
    return true;
}

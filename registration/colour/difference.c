#include "registration/colour/difference.h"

#include "base/picture/colour_space.h"

#include <math.h>
#include <stdbool.h>

static const double pi = 3.14159265358979323846;

/* ---- Lab ---- */

static const double xyz_of_rgb[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};

static void multiply(const double m[3][3], const double v[3], double product[3])
{
    for (int i = 0; i < 3; i++)
        product[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

static double response(double t)
{
    const double edge = 6.0 / 29;
    return t > edge * edge * edge ? cbrt(t) : t / (3 * edge * edge) + 4.0 / 29;
}

static double inverse_response(double f)
{
    const double edge = 6.0 / 29;
    return f > edge ? f * f * f : 3 * edge * edge * (f - 4.0 / 29);
}

void weft_lab_of_linear_srgb(const double rgb[3], double lab[3])
{
    double xyz[3], f[3];
    multiply(xyz_of_rgb, rgb, xyz);
    for (int i = 0; i < 3; i++)
        f[i] = response(xyz[i] / weft_d65[i]);
    lab[0] = 116 * f[1] - 16;
    lab[1] = 500 * (f[0] - f[1]);
    lab[2] = 200 * (f[1] - f[2]);
}

void weft_linear_srgb_of_lab_d50(const double lab[3], double rgb[3])
{
    double middle = (lab[0] + 16) / 116, f[3] = {middle + lab[1] / 500, middle, middle - lab[2] / 200};
    double xyz[3];
    for (int i = 0; i < 3; i++)
        xyz[i] = weft_d50[i] * inverse_response(f[i]);
    weft_linear_srgb_of_xyz(xyz, weft_d50, rgb);
}

/* ---- CIEDE2000 ---- */

static double cos_deg(double angle_deg)
{
    return cos(angle_deg * pi / 180);
}

/* The share by which chroma C moves out of the neutral: sqrt(C^7 / (C^7 + 25^7)). */
static double chroma_share(double chroma)
{
    double seventh = pow(chroma, 7);
    return sqrt(seventh / (seventh + 6103515625.0));
}

static double hue_deg(double a, double b)
{
    double hue = a == 0 && b == 0 ? 0 : atan2(b, a) * 180 / pi;
    return hue < 0 ? hue + 360 : hue;
}

/* By what differences of lightness, chroma and hue are divided at a place, and how those of chroma and hue join. */
typedef struct tolerances {
    double lightness, chroma, hue, rotation;
} tolerances;

static tolerances tolerances_at(double lightness, double chroma, double h_deg)
{
    double away = (lightness - 50) * (lightness - 50), turn = (h_deg - 275) / 25;
    double t = 1 - 0.17 * cos_deg(h_deg - 30) + 0.24 * cos_deg(2 * h_deg) + 0.32 * cos_deg(3 * h_deg + 6) -
               0.20 * cos_deg(4 * h_deg - 63);
    return (tolerances){1 + 0.015 * away / sqrt(20 + away), 1 + 0.045 * chroma, 1 + 0.015 * chroma * t,
                        -2 * chroma_share(chroma) * sin(60 * exp(-turn * turn) * pi / 180)};
}

static double mean_hue_deg(double one, double other)
{
    if (fabs(one - other) <= 180)
        return (one + other) / 2;
    return (one + other + (one + other < 360 ? 360 : -360)) / 2;
}

double weft_ciede2000(const double lab[3], const double other[3])
{
    double stretch = 1.5 - 0.5 * chroma_share((hypot(lab[1], lab[2]) + hypot(other[1], other[2])) / 2);
    double a1 = stretch * lab[1], a2 = stretch * other[1];
    double c1 = hypot(a1, lab[2]), c2 = hypot(a2, other[2]);
    double h1 = hue_deg(a1, lab[2]), h2 = hue_deg(a2, other[2]), turn = h2 - h1;
    bool neutral = c1 * c2 == 0;
    if (fabs(turn) > 180)
        turn += turn > 0 ? -360 : 360;
    tolerances s = tolerances_at((lab[0] + other[0]) / 2, (c1 + c2) / 2, neutral ? h1 + h2 : mean_hue_deg(h1, h2));
    double lightness = (other[0] - lab[0]) / s.lightness, chroma = (c2 - c1) / s.chroma;
    double hue = neutral ? 0 : 2 * sqrt(c1 * c2) * sin(turn * pi / 360) / s.hue;
    return sqrt(lightness * lightness + chroma * chroma + hue * hue + s.rotation * chroma * hue);
}

/* ---- Near a colour ---- */

/* Differences of Lab at `lab` as lightness l, chroma c and hue h over their tolerances; then l^2 + c^2 + h^2 + r c h,
 * with r the rotation, as a sum of squares: of l, c + r h / 2 and h sqrt(1 - r^2 / 4). */
static void scale_at(const double lab[3], double scale[3][3])
{
    double stretch = 1.5 - 0.5 * chroma_share(hypot(lab[1], lab[2])), a = stretch * lab[1], b = lab[2];
    double chroma = hypot(a, b), x = chroma > 0 ? a / chroma : 1, y = chroma > 0 ? b / chroma : 0;
    tolerances s = tolerances_at(lab[0], chroma, hue_deg(a, b));
    double half = s.rotation / 2, rest = sqrt(1 - half * half);
    const double c[2] = {stretch * x / s.chroma, y / s.chroma}, h[2] = {-stretch * y / s.hue, x / s.hue};
    const double at[3][3] = {
        {1 / s.lightness, 0, 0}, {0, c[0] + half * h[0], c[1] + half * h[1]}, {0, rest * h[0], rest * h[1]}};
    for (int i = 0; i < 9; i++)
        scale[i / 3][i % 3] = at[i / 3][i % 3];
}

void weft_ciede2000_metric(const double rgb[3], double metric[3][3])
{
    double lab[3], scale[3][3];
    weft_lab_of_linear_srgb(rgb, lab);
    scale_at(lab, scale);
    for (int c = 0; c < 3; c++) {
        double step = 1e-4 * (fabs(rgb[c]) + 0.01), below[3] = {rgb[0], rgb[1], rgb[2]};
        double above[3] = {rgb[0], rgb[1], rgb[2]}, low[3], high[3], slope[3], column[3];
        below[c] -= step;
        above[c] += step;
        weft_lab_of_linear_srgb(below, low);
        weft_lab_of_linear_srgb(above, high);
        for (int i = 0; i < 3; i++)
            slope[i] = (high[i] - low[i]) / (2 * step);
        multiply((const double(*)[3])scale, slope, column);
        for (int i = 0; i < 3; i++)
            metric[i][c] = column[i];
    }
}

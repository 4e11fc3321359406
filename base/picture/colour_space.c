#include "base/picture/colour_space.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- Curves ---- */

static double table_at(const weft_curve *curve, double x)
{
    double place = fmin(x, 1) * (curve->count - 1);
    int below = (int)fmin(place, curve->count - 2);
    double low = (double)curve->table[below], high = (double)curve->table[below + 1];
    return low + (place - below) * (high - low);
}

float weft_curve_compute(const weft_curve *curve, float encoded)
{
    double size = fabs((double)encoded);
    if (!isfinite(size))
        return encoded;
    double light = curve->kind == WEFT_CURVE_POWER ? pow(size, curve->gamma) : table_at(curve, size);
    return (float)copysign(light, (double)encoded);
}

static weft_curve power(double gamma)
{
    return (weft_curve){.kind = WEFT_CURVE_POWER, .gamma = gamma};
}

/* Within what tables of 1024 steps and gammas of 16 bits are off; 2.2 for sRGB is farther off. */
static bool is_near_srgb(const weft_curve *curve)
{
    for (int i = 0; i <= 255; i++) {
        double x = i / 255.0, exact = (double)weft_linear_of_srgb((float)x);
        if (!(fabs((double)weft_curve_decode(curve, (float)x) - exact) <= 1e-4 + 0.005 * exact))
            return false;
    }
    return true;
}

/* ---- Primaries ---- */

static const double identity[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const double d65_xy[2] = {0.3127, 0.3290};

static double determinant(const weft_colorants *colorants)
{
    const double(*m)[3] = colorants->xyz;
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
    return sum;
}

static void xyz_of_xy(const double xy[2], double xyz[3])
{
    xyz[0] = xy[0];
    xyz[1] = xy[1];
    xyz[2] = 1 - xy[0] - xy[1];
}

bool weft_colour_space_of_colorants(const weft_colorants *colorants, weft_colour_space *space)
{
    const double(*xyz)[3] = colorants->xyz;
    double white[3], sum[3] = {0};
    for (int i = 0; i < 3; i++)
        white[i] = xyz[0][i] + xyz[1][i] + xyz[2][i];
    if (!(white[1] > 0 && fabs(determinant(colorants)) > 1e-6 * white[1] * white[1] * white[1]))
        return false;
    memset(space, 0, sizeof *space);
    for (int primary = 0; primary < 3; primary++) {
        double rgb[3];
        weft_linear_srgb_of_xyz(xyz[primary], white, rgb);
        for (int i = 0; i < 3; i++) {
            space->matrix[i][primary] = rgb[i];
            sum[i] += rgb[i];
        }
    }
    /* The constants have seven digits; white is white to the last. */
    for (int i = 0; i < 3; i++) {
        if (!(sum[i] > 0.5 && sum[i] < 2))
            return false;
        for (int primary = 0; primary < 3; primary++)
            space->matrix[i][primary] /= sum[i];
    }
    return true;
}

/* How bright each primary is follows from the white that they make together (Cramer's rule). */
static bool scale_to_white(weft_colorants *colorants, const double white[3])
{
    double whole = determinant(colorants), part[3];
    for (int i = 0; i < 3; i++) {
        weft_colorants replaced = *colorants;
        memcpy(replaced.xyz[i], white, sizeof replaced.xyz[i]);
        part[i] = determinant(&replaced) / whole;
        if (!isfinite(part[i]))
            return false;
    }
    for (int i = 0; i < 3; i++) {
        for (int axis = 0; axis < 3; axis++)
            colorants->xyz[i][axis] *= part[i];
    }
    return true;
}

static bool is_xyz(const double xy[8])
{
    static const double expected[6] = {1, 0, 0, 1, 0, 0};
    for (int i = 0; i < 6; i++) {
        if (!(fabs(xy[i] - expected[i]) < 1e-4))
            return false;
    }
    return true;
}

/* No adaptation: the values are relative to D65, whatever white such a file names. */
static void make_xyz(weft_colour_space *space)
{
    memset(space, 0, sizeof *space);
    for (int axis = 0; axis < 3; axis++) {
        double rgb[3];
        weft_linear_srgb_of_xyz(identity[axis], weft_d65, rgb);
        for (int i = 0; i < 3; i++)
            space->matrix[i][axis] = rgb[i];
    }
    snprintf(space->name, sizeof space->name, "CIE XYZ");
}

bool weft_colour_space_of_primaries(const double xy[8], weft_colour_space *space)
{
    if (is_xyz(xy)) {
        make_xyz(space);
        return true;
    }
    weft_colorants primaries;
    double white[3];
    for (int i = 0; i < 3; i++)
        xyz_of_xy(xy + 2 * (size_t)i, primaries.xyz[i]);
    xyz_of_xy(xy + 6, white);
    if (!(xy[7] > 0) || !scale_to_white(&primaries, white) || !weft_colour_space_of_colorants(&primaries, space))
        return false;
    snprintf(space->name, sizeof space->name, "red %.3g,%.3g green %.3g,%.3g blue %.3g,%.3g white %.3g,%.3g", xy[0],
             xy[1], xy[2], xy[3], xy[4], xy[5], xy[6], xy[7]);
    return true;
}

/* ---- Spaces ---- */

static void set_curve(weft_colour_space *space, const weft_curve *curve)
{
    for (int c = 0; c < 3; c++)
        space->curve[c] = *curve;
}

/* Green is what tells the two apart from sRGB, red as well for Display P3. */
static void make_of_d65(double red_x, double red_y, double green_x, double green_y, weft_colour_space *space)
{
    const double xy[8] = {red_x, red_y, green_x, green_y, 0.15, 0.06, d65_xy[0], d65_xy[1]};
    weft_colour_space_of_primaries(xy, space);
}

void weft_colour_space_make(weft_known_colours which, weft_colour_space *space)
{
    static const char *const name[] = {"sRGB", "gamma 2.2", "Adobe RGB", "Display P3", "CIE XYZ"};
    const weft_curve srgb = {.kind = WEFT_CURVE_SRGB}, gamma = power(2.2), adobe = power(563.0 / 256);
    if (which == WEFT_COLOURS_XYZ)
        make_xyz(space);
    else if (which == WEFT_COLOURS_ADOBE_RGB)
        make_of_d65(0.64, 0.33, 0.21, 0.71, space);
    else if (which == WEFT_COLOURS_DISPLAY_P3)
        make_of_d65(0.68, 0.32, 0.265, 0.69, space);
    else
        memset(space, 0, sizeof *space), weft_colour_space_make_grey(space);
    if (which == WEFT_COLOURS_SRGB || which == WEFT_COLOURS_DISPLAY_P3)
        set_curve(space, &srgb);
    else if (which != WEFT_COLOURS_XYZ)
        set_curve(space, which == WEFT_COLOURS_GAMMA_22 ? &gamma : &adobe);
    snprintf(space->name, sizeof space->name, "%s", name[which]);
}

void weft_colour_space_make_linear(weft_colour_space *space)
{
    for (int c = 0; c < 3; c++)
        space->curve[c].kind = WEFT_CURVE_LINEAR;
}

void weft_colour_space_make_grey(weft_colour_space *space)
{
    memcpy(space->matrix, identity, sizeof space->matrix);
}

void weft_colour_space_round(weft_colour_space *space)
{
    double farthest = 0;
    for (int i = 0; i < 9; i++)
        farthest = fmax(farthest, fabs(space->matrix[i / 3][i % 3] - identity[i / 3][i % 3]));
    if (farthest < 0.003)
        weft_colour_space_make_grey(space);
    for (int c = 0; c < 3; c++) {
        if (space->curve[c].kind != WEFT_CURVE_LINEAR && is_near_srgb(&space->curve[c]))
            space->curve[c].kind = WEFT_CURVE_SRGB;
    }
}

bool weft_colour_space_has_srgb_primaries(const weft_colour_space *space)
{
    bool is = true;
    for (int i = 0; i < 9; i++)
        is = is && space->matrix[i / 3][i % 3] == identity[i / 3][i % 3];
    return is;
}

bool weft_colour_space_is_srgb(const weft_colour_space *space)
{
    bool is = weft_colour_space_has_srgb_primaries(space);
    for (int c = 0; c < 3; c++)
        is = is && space->curve[c].kind == WEFT_CURVE_SRGB;
    return is;
}

void weft_colour_space_to_srgb(const weft_colour_space *space, float *rgb, size_t count)
{
    if (weft_colour_space_has_srgb_primaries(space))
        return;
    for (size_t i = 0; i < count; i++, rgb += 3) {
        const double from[3] = {(double)rgb[0], (double)rgb[1], (double)rgb[2]};
        for (int c = 0; c < 3; c++)
            rgb[c] =
                (float)(space->matrix[c][0] * from[0] + space->matrix[c][1] * from[1] + space->matrix[c][2] * from[2]);
    }
}

/* ---- Cie ---- */

const double weft_d50[3] = {0.9642, 1, 0.8249}, weft_d65[3] = {0.95047, 1, 1.08883};

static const double rgb_of_xyz[3][3] = {
    {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};

/* Bradford's cone responses of XYZ, and back. */
static const double cones_of_xyz[3][3] = {
    {0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
static const double xyz_of_cones[3][3] = {
    {0.9869929, -0.1470543, 0.1599627}, {0.4323053, 0.5183603, 0.0492912}, {-0.0085287, 0.0400428, 0.9684867}};

static void multiply(const double m[3][3], const double v[3], double product[3])
{
    for (int i = 0; i < 3; i++)
        product[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

void weft_linear_srgb_of_xyz(const double xyz[3], const double white[3], double rgb[3])
{
    double cones[3], from[3], to[3], adapted[3];
    multiply(cones_of_xyz, xyz, cones);
    multiply(cones_of_xyz, white, from);
    multiply(cones_of_xyz, weft_d65, to);
    for (int i = 0; i < 3; i++)
        cones[i] *= to[i] / from[i];
    multiply(xyz_of_cones, cones, adapted);
    multiply(rgb_of_xyz, adapted, rgb);
}

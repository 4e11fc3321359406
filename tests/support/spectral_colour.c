#include "tests/support/spectral_colour.h"

#include "tests/support/cmocka_all.h"

#include <math.h>

enum { FIRST_NM = 390, LAST_NM = 730, STEP_NM = 5 };

/* One of wide bands, whose raw colours are pale, and one of narrow bands. */
const spectral_camera spectral_cameras[2] = {{{600, 540, 458}, {52, 54, 38}, {0.12, 0.05, 0.08}},
                                             {{618, 530, 455}, {27, 30, 24}, {0.04, 0.08, 0.05}}};
const spectral_lamp spectral_lamps[2] = {{3200, 0}, {5200, 0.5}};

static double bell(double x)
{
    return exp(-x * x / 2);
}

static double sided(double nm, double peak, double left, double right)
{
    return bell((nm - peak) * (nm < peak ? left : right));
}

static void eye(double nm, double xyz[3])
{
    xyz[0] = 0.362 * sided(nm, 442.0, 0.0624, 0.0374) + 1.056 * sided(nm, 599.8, 0.0264, 0.0323) -
             0.065 * sided(nm, 501.1, 0.0490, 0.0382);
    xyz[1] = 0.821 * sided(nm, 568.8, 0.0213, 0.0247) + 0.286 * sided(nm, 530.9, 0.0613, 0.0322);
    xyz[2] = 1.217 * sided(nm, 437.0, 0.0845, 0.0278) + 0.681 * sided(nm, 459.0, 0.0385, 0.0725);
}

static double black_body(double nm, double kelvin)
{
    return pow(560 / nm, 5) * (exp(1.4388e7 / (560 * kelvin)) - 1) / (exp(1.4388e7 / (nm * kelvin)) - 1);
}

static double reflect(const spectral_reflectance *r, double nm)
{
    double t = (nm - 560) / 170, x = r->parabola[0] + t * (r->parabola[1] + t * r->parabola[2]);
    return 0.5 + x / (2 * sqrt(1 + x * x));
}

/* ---- The eye under D50 ---- */

/* A black body of 5003 K in the place of daylight; the white is its own, so that colours are relative to it. */
static void xyz_of(const spectral_reflectance *r, double xyz[3])
{
    double white[3] = {0, 0, 0}, sum[3] = {0, 0, 0};
    for (int nm = FIRST_NM; nm <= LAST_NM; nm += STEP_NM) {
        double response[3], light = black_body(nm, 5003);
        eye(nm, response);
        for (int i = 0; i < 3; i++) {
            white[i] += response[i] * light;
            sum[i] += response[i] * light * reflect(r, nm);
        }
    }
    for (int i = 0; i < 3; i++)
        xyz[i] = sum[i] / white[i];
}

static double root(double t)
{
    return t > 216.0 / 24389 ? cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}

void spectral_lab_d50(const spectral_reflectance *reflectance, double lab[3])
{
    double xyz[3];
    xyz_of(reflectance, xyz);
    lab[0] = 116 * root(xyz[1]) - 16;
    lab[1] = 500 * (root(xyz[0]) - root(xyz[1]));
    lab[2] = 200 * (root(xyz[1]) - root(xyz[2]));
}

/* ---- A reflectance of a colour ---- */

static double determinant(double m[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* Newton's step, by Cramer's rule. */
static void newton_step(const spectral_reflectance *r, const double wanted[3], double step[3])
{
    double here[3], slope[3][3];
    spectral_lab_d50(r, here);
    for (int k = 0; k < 3; k++) {
        spectral_reflectance moved = *r;
        double there[3];
        moved.parabola[k] += 1e-5;
        spectral_lab_d50(&moved, there);
        for (int i = 0; i < 3; i++)
            slope[i][k] = (there[i] - here[i]) / 1e-5;
    }
    for (int k = 0; k < 3; k++) {
        double replaced[3][3];
        for (int i = 0; i < 9; i++)
            replaced[i / 3][i % 3] = i % 3 == k ? wanted[i / 3] - here[i / 3] : slope[i / 3][i % 3];
        step[k] = determinant(replaced) / determinant(slope);
    }
}

spectral_reflectance spectral_of_lab_d50(const double lab[3])
{
    spectral_reflectance r = {{0, 0, 0}};
    double found[3];
    spectral_lab_d50(&r, found);
    for (int round = 0; round < 200 && distance(found, lab) > 1e-6; round++) {
        double step[3], left = distance(found, lab), share = 1;
        newton_step(&r, lab, step);
        for (int halving = 0; halving < 30; halving++, share /= 2) {
            spectral_reflectance next = r;
            for (int k = 0; k < 3; k++)
                next.parabola[k] += share * step[k];
            spectral_lab_d50(&next, found);
            if (distance(found, lab) < left) {
                r = next;
                break;
            }
        }
        spectral_lab_d50(&r, found);
    }
    if (!(distance(found, lab) < 0.5))
        fail_msg("no smooth reflectance has L*a*b* %g, %g, %g", lab[0], lab[1], lab[2]);
    return r;
}

spectral_reflectance spectral_random(unsigned *state)
{
    double value[3];
    for (int i = 0; i < 3; i++) {
        *state = *state * 1664525u + 1013904223u;
        value[i] = (*state >> 8) / (double)(1 << 24) - 0.5;
    }
    return (spectral_reflectance){{2 * value[0] - 0.5, 6 * value[1], 6 * value[2]}};
}

/* ---- A camera ---- */

static double sensitivity(const spectral_camera *camera, int channel, double nm)
{
    double beside = camera->peak_nm[channel] + (channel == 0 ? -110 : 110);
    return bell((nm - camera->peak_nm[channel]) / camera->width_nm[channel]) +
           camera->bump[channel] * bell((nm - beside) / 30);
}

void spectral_see(const spectral_camera *camera, const spectral_lamp *lamp, const spectral_reflectance *reflectance,
                  double rgb[3])
{
    for (int c = 0; c < 3; c++) {
        rgb[c] = 0;
        for (int nm = FIRST_NM; nm <= LAST_NM; nm += STEP_NM) {
            double light = black_body(nm, lamp->kelvin) + lamp->blue * bell((nm - 450) / 12.0);
            rgb[c] += light * sensitivity(camera, c, nm) * (reflectance ? reflect(reflectance, nm) : 1) * STEP_NM / 100;
        }
    }
}

void spectral_white(const spectral_camera *camera, const spectral_lamp *lamp, double rgb[3])
{
    spectral_see(camera, lamp, NULL, rgb);
}

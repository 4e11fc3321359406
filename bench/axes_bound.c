/* How well any calibration can know the lines of a goniometer's axes, and how well `weft calibrate` does, by the number
 * of shots. Usage: bench_axes_bound [SEEDS [SCATTER_DEG]].
 *
 * The bound is that of Cramer and Rao, for whoever sees the rotation of each shot exactly: what is unknown is home, two
 * lines, and a rotation of every shot by chance, normal with SCATTER_DEG a component. Where things are tells nothing of
 * the directions of lines, for the lines pass the middle of the target. The calibration sees the virtual goniometer
 * (tests/support/axes_series.h), which has offsets, a lens of its own and scatter in place, too. */
#include "base/numeric/cholesky.h"
#include "tests/support/axes_series.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { UNKNOWNS = 7 }; /* rotation of home; lean of the lines of theta and phi to both sides */

/* ---- The bound ---- */

static weft_pose turn_of(weft_vec3 vector)
{
    return weft_pose_of_motion(&(weft_motion){{vector.x, vector.y, vector.z}, {0, 0, 0}});
}

/* The line of theta is y of the plate and that of phi is z. */
static weft_pose rotation_of(weft_angles view, const double *unknown)
{
    weft_vec3 theta = weft_unit((weft_vec3){unknown[3], 1, unknown[4]});
    weft_vec3 phi = weft_unit((weft_vec3){unknown[5], unknown[6], 1});
    weft_pose home = turn_of((weft_vec3){unknown[0], unknown[1], unknown[2]});
    weft_pose arm = turn_of(weft_scale(theta, view.theta_rad)), ring = turn_of(weft_scale(phi, view.phi_rad));
    weft_pose carried = weft_pose_after(&arm, &ring);
    return weft_pose_after(&home, &carried);
}

/* derivative[component][unknown] of the rotation that a shot is off by. */
static void differentiate(weft_angles view, double derivative[3][UNKNOWNS])
{
    const double step = 1e-5;
    const double none[UNKNOWNS] = {0};
    weft_pose rest = rotation_of(view, none), back = {{{0}}, {0, 0, 0}};
    for (int i = 0; i < 9; i++)
        back.rotation[i / 3][i % 3] = rest.rotation[i % 3][i / 3];
    for (int k = 0; k < UNKNOWNS; k++) {
        double unknown[UNKNOWNS] = {0};
        unknown[k] = step;
        weft_pose there = rotation_of(view, unknown), off = weft_pose_after(&there, &back);
        weft_motion motion = weft_motion_of_pose(&off);
        for (int c = 0; c < 3; c++)
            derivative[c][k] = motion.rotation[c] / step;
    }
}

typedef weft_angles plan(int index);

/* Half of the shots at the zenith, half at 75 degrees, all round. */
static weft_angles ends(int index)
{
    int half = AXES_SERIES_SHOTS / 2;
    return axes_degrees(index < half ? 0 : 75, 360.0 * (index % half) / half);
}

/* Root mean square of the angles by which the two lines are off at least. */
static void bound(plan *view, double scatter_deg, int shots, double line_deg[2])
{
    double information[UNKNOWNS * UNKNOWNS] = {0};
    for (int i = 0; i < shots; i++) {
        double derivative[3][UNKNOWNS];
        differentiate(view(i % AXES_SERIES_SHOTS), derivative);
        for (int k = 0; k < UNKNOWNS * UNKNOWNS; k++) {
            for (int c = 0; c < 3; c++)
                information[k] += derivative[c][k / UNKNOWNS] * derivative[c][k % UNKNOWNS];
        }
    }
    if (!weft_cholesky_factor(UNKNOWNS, UNKNOWNS, information))
        abort();
    double variance[2] = {0};
    for (int k = 3; k < UNKNOWNS; k++) {
        double column[UNKNOWNS] = {0};
        column[k] = 1;
        weft_cholesky_solve(UNKNOWNS, UNKNOWNS, information, column);
        variance[(k - 3) / 2] += column[k];
    }
    for (int line = 0; line < 2; line++)
        line_deg[line] = scatter_deg * sqrt(variance[line]);
}

/* ---- What is found ---- */

/* Adds the squares of the errors of both lines, and of those that the calibration expects. */
static void calibrate(double scatter_deg, int rounds, uint64_t seed, double found[2], double expected[2])
{
    weft_virtual_settings settings = axes_off_settings();
    settings.viewpoint_rotation_deg = scatter_deg;
    settings.viewpoint_translation_mm = 2 * scatter_deg;
    axes_series s = axes_series_take(&settings, seed, rounds);
    weft_virtual_world rest = axes_at_rest(&s.world);
    weft_axes_report report;
    weft_error error = {0};
    if (weft_axes_calibrate(s.shot, s.count, &s.nominal, false, &report, &error) != WEFT_OK) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    const weft_angles zenith = axes_degrees(0, 0);
    const weft_pose turn[2] = {axes_true_turn(&rest, zenith, axes_degrees(60, 0)),
                               axes_true_turn(&rest, zenith, axes_degrees(0, 90))};
    for (int line = 0; line < 2; line++) {
        double off_deg = axes_angle_deg(axes_direction(&turn[line]), report.file.poses.joint[line].direction);
        found[line] += off_deg * off_deg;
        expected[line] += 2 * pow(weft_deg_of_rad(report.file.error[line].direction_rad), 2);
    }
    weft_axes_report_free(&report);
}

int main(int argc, char **argv)
{
    int seeds = argc > 1 ? atoi(argv[1]) : 96;
    double scatter_deg = argc > 2 ? atof(argv[2]) : 0.05, line_deg[2];
    bound(ends, scatter_deg, AXES_SERIES_SHOTS, line_deg);
    printf("half at the zenith, half at 75 degrees: %d shots, bound %.4f %.4f degrees\n", AXES_SERIES_SHOTS,
           line_deg[0], line_deg[1]);
    for (int rounds = 1; rounds * AXES_SERIES_SHOTS <= AXES_SERIES_MOST; rounds *= 2) {
        double found[2] = {0}, expected[2] = {0};
        for (int seed = 1; seed <= seeds; seed++)
            calibrate(scatter_deg, rounds, (uint64_t)seed, found, expected);
        bound(axes_series_view, scatter_deg, rounds * AXES_SERIES_SHOTS, line_deg);
        printf("%d shots, lines of theta and phi: bound %.4f %.4f, found %.4f %.4f, expected %.4f %.4f degrees\n",
               rounds * AXES_SERIES_SHOTS, line_deg[0], line_deg[1], sqrt(found[0] / seeds), sqrt(found[1] / seeds),
               sqrt(expected[0] / seeds), sqrt(expected[1] / seeds));
    }
    return 0;
}

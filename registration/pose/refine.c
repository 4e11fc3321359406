#include "registration/pose/refine.h"

#include "registration/pose/normal_equations.h"
#include "registration/pose/plate_comparison.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The unknowns of one step. The homography is multiplied from the left by I + D, D's last element zero, in normalised
 * camera coordinates; the lighting is a polynomial of second degree over the photograph times the drawing, plus stray
 * light; the point spread enters by the heat equation, d T / d variance = laplacian(T) / 2. */
enum {
    motion_at = 0,
    motion_count = 8,
    gain_at = 8,
    gain_count = WEFT_LIGHTING_COUNT,
    stray_at = 14,
    spread_at = 15,
    unknown_count = 17,
    bend_at = 17,
    bend_count = 3,
    unknown_count_blurred = spread_at,
    strip_count = 32, /* fixed, so that sums do not depend on the number of threads */
    spread_steps = 4, /* the point spread creeps for long in a direction that hardly matters; then it is held */
    iteration_limit = 15
};

static const double settled_px = 0.005, held_stiffness = 1e12, largest_step_px = 3, robust_reach = 6;

typedef struct refining {
    weft_plate_comparison seen;
    bool weighs_bend;
    weft_plate_view view; /* where it does */
    double deviation;     /* of the residual of the last step, 0 before the first */
    weft_normal_equations equations;
} refining;

static weft_code look(refining *c, const float *photograph, const weft_refinement *estimate, weft_error *error)
{
    return weft_plate_comparison_look(&c->seen, photograph, &estimate->homography, estimate->point_spread, error);
}

/* Motion, in pixels, of the image of a plate point at normalised coordinates (x, y) by D: du . d and dv . d. */
static void motion_rows(const weft_camera *camera, double x, double y, double du[motion_count], double dv[motion_count])
{
    const double u[motion_count] = {x, y, 1, 0, 0, 0, -x * x, -x * y};
    const double v[motion_count] = {0, 0, 0, x, y, 1, -x * y, -y * y};
    for (int k = 0; k < motion_count; k++) {
        du[k] = camera->fx * u[k];
        dv[k] = camera->fy * v[k];
    }
}

/* The same by the bend of the plate, mm at its unit. */
static void bend_rows(const refining *c, const float undistorted[2], double du[bend_count], double dv[bend_count])
{
    const weft_plate_view *view = &c->view;
    const double(*m)[3] = view->homography.m, unit = weft_bend_unit_mm(c->seen.sight);
    weft_pixel plate = weft_plate_view_meet(view, undistorted[0], undistorted[1]);
    double x = plate.x / unit, y = plate.y / unit, height = weft_bend_height(&view->bend, plate.x, plate.y);
    double w = m[2][0] * plate.x + m[2][1] * plate.y + m[2][2] + height * view->lift[2];
    double rise_u = (view->lift[0] - undistorted[0] * view->lift[2]) / w;
    double rise_v = (view->lift[1] - undistorted[1] * view->lift[2]) / w;
    const double rise[bend_count] = {x * x, x * y, y * y};
    for (int k = 0; k < bend_count; k++) {
        du[k] = rise_u * rise[k];
        dv[k] = rise_v * rise[k];
    }
}

static void equation_at(const refining *c, int x, int y, double row[WEFT_UNKNOWNS_LIMIT], double *residual)
{
    const weft_camera *camera = &c->seen.sight->camera;
    long width = camera->width, at = y * width + x;
    const float *t = c->seen.prediction.reflectance + at;
    double basis[gain_count], du[motion_count], dv[motion_count];
    weft_lighting_basis(camera, x, y, basis);
    double gain = weft_lighting_at(basis, c->seen.gain);
    const float *undistorted = c->seen.sight->undistorted[at];
    motion_rows(camera, (undistorted[0] - camera->cx) / camera->fx, (undistorted[1] - camera->cy) / camera->fy, du, dv);
    double slope_x = gain * 0.5 * (t[1] - t[-1]), slope_y = gain * 0.5 * (t[width] - t[-width]);
    double half_laplacian = 0.5 * gain * (t[1] + t[-1] + t[width] + t[-width] - 4 * t[0]);
    for (int k = 0; k < motion_count; k++)
        row[motion_at + k] = -(slope_x * du[k] + slope_y * dv[k]);
    if (c->weighs_bend) {
        double bend_u[bend_count], bend_v[bend_count];
        bend_rows(c, undistorted, bend_u, bend_v);
        for (int k = 0; k < bend_count; k++)
            row[bend_at + k] = -(slope_x * bend_u[k] + slope_y * bend_v[k]);
    }
    for (int k = 0; k < gain_count; k++)
        row[gain_at + k] = basis[k] * t[0];
    row[stray_at] = 1;
    row[spread_at] = half_laplacian;
    row[spread_at + 1] = half_laplacian * c->seen.prediction.focus[at];
    *residual = c->seen.photograph[at] - gain * t[0] - c->seen.stray;
}

/* Cauchy's weight: what the drawing does not explain (a hair, a hand, a stain) hardly counts. */
static double robust_weight(double residual, double deviation)
{
    if (deviation <= 0)
        return 1;
    double t = residual / (robust_reach * deviation);
    return 1 / (1 + t * t);
}

WEFT_HOT static void gather_strip(const refining *c, int first, int end, weft_normal_equations *equations,
                                  double *deviation)
{
    double row[WEFT_UNKNOWNS_LIMIT] = {0};
    for (int y = first; y < end; y++) {
        for (int x = 1; x + 1 < c->seen.sight->camera.width; x++) {
            if (!c->seen.prediction.compared[(long)y * c->seen.sight->camera.width + x])
                continue;
            double residual;
            equation_at(c, x, y, row, &residual);
            weft_normal_equations_add(equations, row, c->seen.photograph[(long)y * c->seen.sight->camera.width + x],
                                      robust_weight(residual, c->deviation));
            deviation[0] += fabs(residual);
            deviation[1]++;
        }
    }
}

static weft_code gather(refining *c, weft_error *error)
{
    weft_normal_equations *strip = calloc(strip_count, sizeof *strip);
    double deviation[strip_count][2] = {{0}}, sum = 0, count = 0;
    if (!strip)
        return weft_fail_memory(error, "refinement", strip_count * sizeof *strip);
    int rows = c->seen.sight->camera.height - 2;
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < strip_count; i++)
        gather_strip(c, 1 + rows * i / strip_count, 1 + rows * (i + 1) / strip_count, &strip[i], deviation[i]);
    c->equations = (weft_normal_equations){0};
    for (int i = 0; i < strip_count; i++) {
        weft_normal_equations_merge(&c->equations, &strip[i]);
        sum += deviation[i][0];
        count += deviation[i][1];
    }
    free(strip);
    c->deviation = count > 0 ? 1.25 * sum / count : 0; /* of a normal distribution, from its mean modulus */
    return WEFT_OK;
}

/* H <- K (I + D) K^-1 H, scaled so that the last element stays as it is in size. */
static weft_homography moved(const weft_camera *camera, const weft_homography *homography, const double *d)
{
    const double k[3][3] = {{camera->fx, 0, camera->cx}, {0, camera->fy, camera->cy}, {0, 0, 1}};
    const double change[3][3] = {{1 + d[0], d[1], d[2]}, {d[3], 1 + d[4], d[5]}, {d[6], d[7], 1}};
    weft_homography result = {{{0}}};
    for (int column = 0; column < 3; column++) {
        double w = homography->m[2][column];
        const double ray[3] = {(homography->m[0][column] - camera->cx * w) / camera->fx,
                               (homography->m[1][column] - camera->cy * w) / camera->fy, w};
        double turned[3];
        for (int row = 0; row < 3; row++)
            turned[row] = change[row][0] * ray[0] + change[row][1] * ray[1] + change[row][2] * ray[2];
        for (int row = 0; row < 3; row++)
            result.m[row][column] = k[row][0] * turned[0] + k[row][1] * turned[1] + k[row][2] * turned[2];
    }
    return result;
}

/* Largest motion of a point on the rim of the plate, pixels. */
static double largest_motion(const weft_sight *sight, const weft_homography *from, const weft_homography *to)
{
    double largest = 0, radius = sight->drawing.half_mm;
    for (int i = 0; i < 8; i++) {
        double x = radius * cos(i * WEFT_PI / 4), y = radius * sin(i * WEFT_PI / 4);
        weft_pixel a = weft_homography_apply(from, x, y), b = weft_homography_apply(to, x, y);
        largest = fmax(largest, hypot(a.x - b.x, a.y - b.y));
    }
    return largest;
}

/* Applies a solution, its motion shortened where it leaves the reach of the linearisation. Returns the motion, pixels.
 */
static double apply_step(refining *c, const double *solution, weft_refinement *refinement)
{
    const weft_camera *camera = &c->seen.sight->camera;
    weft_homography next = moved(camera, &refinement->homography, solution);
    double motion = largest_motion(c->seen.sight, &refinement->homography, &next);
    double limit = largest_step_px * fmax(1, c->seen.blur_px);
    if (motion > limit) {
        double shorter[motion_count];
        for (int k = 0; k < motion_count; k++)
            shorter[k] = solution[k] * limit / motion;
        next = moved(camera, &refinement->homography, shorter);
    }
    refinement->homography = next;
    memcpy(c->seen.gain, solution + gain_at, sizeof c->seen.gain);
    c->seen.stray = solution[stray_at];
    if (c->seen.blur_px <= 0) {
        refinement->point_spread.constant = fmax(0, refinement->point_spread.constant + solution[spread_at]);
        refinement->point_spread.depth = fmax(0, refinement->point_spread.depth + solution[spread_at + 1]);
    }
    return motion;
}

/* At a frontal view the depth term has no effect: hold it where it is. */
static void hold_point_spread(refining *c)
{
    double(*m)[WEFT_UNKNOWNS_LIMIT] = c->equations.matrix;
    double scale = fmax(c->seen.focus_limit, 1e-3);
    m[spread_at][spread_at] *= 1 + 1e-6;
    m[spread_at + 1][spread_at + 1] += 1e-4 * scale * scale * m[spread_at][spread_at];
}

/* Standard error of positions in the opening, mm RMS, from the factored equations. */
static double uncertainty_mm(const weft_sight *sight, const weft_normal_equations *factored, int count, double variance,
                             const weft_homography *homography)
{
    const weft_camera *camera = &sight->camera;
    weft_homography inverse = weft_homography_inverse(homography);
    enum { grid = 5 };
    double sum = 0, half = sight->opening_mm / 2;
    for (int i = 0; i < grid * grid; i++) {
        double px = half * (2 * (i % grid + 0.5) / grid - 1), py = half * (2 * (i / grid + 0.5) / grid - 1);
        weft_pixel at = weft_homography_apply(homography, px, py);
        weft_pixel right = weft_homography_apply(&inverse, at.x + 0.5, at.y);
        weft_pixel left = weft_homography_apply(&inverse, at.x - 0.5, at.y);
        weft_pixel below = weft_homography_apply(&inverse, at.x, at.y + 0.5);
        weft_pixel above = weft_homography_apply(&inverse, at.x, at.y - 0.5);
        double du[motion_count], dv[motion_count], row[2][WEFT_UNKNOWNS_LIMIT] = {{0}};
        motion_rows(camera, (at.x - camera->cx) / camera->fx, (at.y - camera->cy) / camera->fy, du, dv);
        for (int k = 0; k < motion_count; k++) {
            row[0][k] = (right.x - left.x) * du[k] + (below.x - above.x) * dv[k];
            row[1][k] = (right.y - left.y) * du[k] + (below.y - above.y) * dv[k];
        }
        sum += weft_normal_equations_variance(factored, count, row[0]) +
               weft_normal_equations_variance(factored, count, row[1]);
    }
    return sqrt(variance * sum / (grid * grid));
}

/* Solves for a step; a point spread that would become negative is held (an active set, at most two constraints), and so
 * are both where `hold_both`. False where the equations have no solution. `factored` receives what the uncertainty is
 * computed from. */
static bool solve(const refining *c, weft_point_spread point_spread, bool hold_both, int count, double *solution,
                  weft_normal_equations *factored)
{
    bool held[2] = {hold_both, hold_both};
    const double current[2] = {point_spread.constant, point_spread.depth};
    for (bool again = true; again;) {
        again = false;
        *factored = c->equations;
        for (int k = 0; k < 2; k++)
            factored->matrix[spread_at + k][spread_at + k] *= held[k] ? held_stiffness : 1;
        if (!weft_normal_equations_factor(factored, count))
            return false;
        weft_normal_equations_solve(factored, count, solution);
        for (int k = 0; k < 2 && count == unknown_count; k++) {
            if (!held[k] && current[k] <= 0 && solution[spread_at + k] < 0)
                held[k] = again = true;
        }
    }
    return true;
}

/* One step. False where the equations have no solution. */
static bool step(refining *c, weft_refinement *refinement, bool hold_point_spread_now, double *motion)
{
    int count = c->seen.blur_px > 0 ? unknown_count_blurred : unknown_count;
    double solution[WEFT_UNKNOWNS_LIMIT] = {0};
    weft_normal_equations factored;
    hold_point_spread(c);
    if (!solve(c, refinement->point_spread, hold_point_spread_now, count, solution, &factored))
        return false;
    double freedom = fmax(1, c->equations.weights - count);
    double variance = c->deviation * c->deviation * fmax(1, c->equations.weights) / freedom;
    refinement->uncertainty_mm = uncertainty_mm(c->seen.sight, &factored, count, variance, &refinement->homography);
    *motion = apply_step(c, solution, refinement);
    return isfinite(*motion);
}

static weft_code iterate(refining *c, const float *photograph, weft_refinement *refinement, weft_error *error)
{
    for (int i = 0; i < iteration_limit && !refinement->converged; i++) {
        double motion;
        WEFT_TRY(look(c, photograph, refinement, error));
        if (i == 0)
            weft_plate_comparison_guess_lighting(&c->seen);
        WEFT_TRY(gather(c, error));
        refinement->iterations = i + 1;
        if (!step(c, refinement, i >= spread_steps, &motion))
            return WEFT_OK;
        /* The second step is the first one with robust weights. */
        refinement->converged = i > 0 && motion < settled_px * fmax(1, 10 * c->seen.blur_px);
    }
    return WEFT_OK;
}

weft_code weft_refinement_run(const weft_sight *sight, const float *photograph, double blur_px,
                              weft_refinement *refinement, weft_error *error)
{
    refining c = {0};
    WEFT_TRY(weft_plate_comparison_create(sight, blur_px, &c.seen, error));
    refinement->converged = false;
    refinement->correlation = refinement->uncertainty_mm = 0;
    weft_code code = iterate(&c, photograph, refinement, error);
    if (code == WEFT_OK)
        code = look(&c, photograph, refinement, error);
    if (code == WEFT_OK)
        refinement->correlation = weft_plate_comparison_correlate(&c.seen);
    weft_plate_comparison_free(&c.seen);
    return code;
}

double weft_bend_unit_mm(const weft_sight *sight)
{
    return sight->drawing.half_mm;
}

/* One step for the lighting, then the equations with the bend among the unknowns. */
static weft_code weigh_bend(refining *c, const float *photograph, weft_refinement *refinement,
                            weft_bend_evidence *evidence, weft_error *error)
{
    double motion;
    WEFT_TRY(look(c, photograph, refinement, error));
    weft_plate_comparison_guess_lighting(&c->seen);
    WEFT_TRY(gather(c, error));
    if (!step(c, refinement, true, &motion))
        return WEFT_OK;
    WEFT_TRY(look(c, photograph, refinement, error));
    c->weighs_bend = true;
    c->view = weft_plate_view_of(&c->seen.sight->camera, &refinement->homography, &c->seen.sight->bend);
    WEFT_TRY(gather(c, error));
    for (int k = 0; k < 2; k++)
        c->equations.matrix[spread_at + k][spread_at + k] =
            c->equations.matrix[spread_at + k][spread_at + k] * held_stiffness + 1;
    if (!(c->deviation > 0) || !weft_normal_equations_factor(&c->equations, unknown_count + bend_count))
        return WEFT_OK;
    weft_normal_equations_reduce(&c->equations, unknown_count + bend_count, bend_count, evidence->information[0],
                                 evidence->gradient);
    double precision = 1 / (c->deviation * c->deviation);
    for (int i = 0; i < bend_count; i++) {
        evidence->gradient[i] *= precision;
        for (int j = 0; j < bend_count; j++)
            evidence->information[i][j] *= precision;
    }
    return WEFT_OK;
}

weft_code weft_refinement_weigh_bend(const weft_sight *sight, const float *photograph, weft_refinement *refinement,
                                     weft_bend_evidence *evidence, weft_error *error)
{
    refining c = {0};
    *evidence = (weft_bend_evidence){0};
    WEFT_TRY(weft_plate_comparison_create(sight, 0, &c.seen, error));
    weft_code code = weigh_bend(&c, photograph, refinement, evidence, error);
    weft_plate_comparison_free(&c.seen);
    return code;
}

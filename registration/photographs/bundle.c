#include "registration/photographs/lens.h"

#include "base/numeric/cholesky.h"
#include "btf/session/rig_poses.h"
#include "registration/pose/normal_equations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POSE = 6, SHARED = WEFT_BUNDLE_SHARED, ALL = POSE + SHARED, MOST_STEPS = 40 };

/* Unit of the bend: mm at 100 mm from the middle. */
static const double bend_square = 100 * 100;

static const double first_damping = 1e-4, least_damping = 1e-9, most_damping = 1e6, settled = 1e-10;

/* What one view follows from. */
typedef struct state {
    weft_camera camera;
    weft_bend bend;
    weft_pose pose;
} state;

static weft_pixel seen_at(const state *s, const double plate[2])
{
    const double at[3] = {plate[0], plate[1], weft_bend_height(&s->bend, plate[0], plate[1])};
    const weft_camera *c = &s->camera;
    double eye[3] = {s->pose.translation.x, s->pose.translation.y, s->pose.translation.z};
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            eye[row] += s->pose.rotation[row][column] * at[column];
    }
    return weft_camera_distort(c, (weft_pixel){c->cx + c->fx * eye[0] / eye[2], c->cy + c->fy * eye[1] / eye[2]});
}

/* Moves an unknown by `by` of its unit: each moves corners by some pixels. */
static void move(int unknown, double by, state *s)
{
    double *const bend[3] = {&s->bend.xx, &s->bend.xy, &s->bend.yy};
    if (unknown < POSE) {
        weft_motion motion = {{0, 0, 0}, {0, 0, 0}};
        double unit = unknown < 3 ? 1e-3 : 1e-3 * weft_length(s->pose.translation);
        (unknown < 3 ? motion.rotation : motion.translation)[unknown % 3] = by * unit;
        weft_pose moved = weft_pose_of_motion(&motion);
        s->pose = weft_pose_after(&moved, &s->pose);
        return;
    }
    switch (unknown - POSE) {
    case WEFT_BUNDLE_FOCAL_LENGTH:
        s->camera.fx *= 1 + 1e-3 * by;
        s->camera.fy *= 1 + 1e-3 * by;
        break;
    case WEFT_BUNDLE_MIDDLE_X:
        s->camera.cx += by;
        break;
    case WEFT_BUNDLE_MIDDLE_Y:
        s->camera.cy += by;
        break;
    case WEFT_BUNDLE_K1:
        s->camera.k1 += 0.01 * by;
        break;
    case WEFT_BUNDLE_K2:
        s->camera.k2 += 0.05 * by;
        break;
    default:
        *bend[unknown - POSE - WEFT_BUNDLE_BEND] += by / bend_square;
    }
}

static bool is_free(unsigned terms, int unknown)
{
    return unknown < POSE || terms >> (unknown - POSE) & 1;
}

/* The equations of a view: poses first, then what all views share. What is fixed stays. */
static void gather(const weft_corner_view *view, const state *s, unsigned terms, weft_normal_equations *equations)
{
    const double step = 0.01;
    state less[ALL], more[ALL];
    *equations = (weft_normal_equations){0};
    for (int k = 0; k < ALL; k++) {
        less[k] = more[k] = *s;
        move(k, -step, &less[k]);
        move(k, step, &more[k]);
    }
    for (int i = 0; i < view->count; i++) {
        double row[2][WEFT_UNKNOWNS_LIMIT] = {{0}};
        weft_pixel at = seen_at(s, view->plate[i]);
        for (int k = 0; k < ALL; k++) {
            if (!is_free(terms, k))
                continue;
            weft_pixel a = seen_at(&less[k], view->plate[i]), b = seen_at(&more[k], view->plate[i]);
            row[0][k] = (b.x - a.x) / (2 * step);
            row[1][k] = (b.y - a.y) / (2 * step);
        }
        weft_normal_equations_add(equations, row[0], view->seen[i][0] - at.x, 1);
        weft_normal_equations_add(equations, row[1], view->seen[i][1] - at.y, 1);
    }
    for (int k = POSE; k < ALL; k++)
        equations->matrix[k][k] += !is_free(terms, k);
}

/* All views at work. */
typedef struct adjustment {
    const weft_corner_view *view;
    int count;
    unsigned terms;                   /* that are estimated */
    weft_normal_equations *equations; /* [count] */
    double (*gradient)[SHARED];       /* [count] of what is shared, poses eliminated */
    double information[SHARED][SHARED];
} adjustment;

/* Returns the sum of squared residuals. */
static double gather_all(adjustment *b, const weft_bundle *at)
{
    double squares = 0;
    for (int i = 0; i < b->count; i++) {
        gather(&b->view[i], &(state){at->camera, at->bend, at->pose[i]}, b->terms, &b->equations[i]);
        squares += b->equations[i].squares;
    }
    return squares;
}

/* Eliminates the poses, and factors what is left. False where that determines nothing. */
static bool reduce(adjustment *b, double damping)
{
    memset(b->information, 0, sizeof b->information);
    for (int i = 0; i < b->count; i++) {
        weft_normal_equations damped = b->equations[i];
        double own[SHARED][SHARED];
        for (int k = 0; k < ALL; k++)
            damped.matrix[k][k] *= 1 + damping;
        if (!weft_normal_equations_factor(&damped, ALL))
            return false;
        weft_normal_equations_reduce(&damped, ALL, SHARED, own[0], b->gradient[i]);
        for (int k = 0; k < SHARED * SHARED; k++)
            b->information[k / SHARED][k % SHARED] += own[k / SHARED][k % SHARED];
    }
    return weft_cholesky_factor(SHARED, SHARED, b->information[0]);
}

static void move_pose(const weft_normal_equations *equations, const double shared[SHARED], double damping,
                      weft_pose *pose)
{
    weft_normal_equations own = *equations;
    double motion[WEFT_UNKNOWNS_LIMIT];
    for (int row = 0; row < POSE; row++) {
        for (int k = 0; k < SHARED; k++)
            own.right[row] -= equations->matrix[POSE + k][row] * shared[k];
        own.matrix[row][row] *= 1 + damping;
    }
    if (!weft_normal_equations_factor(&own, POSE))
        return;
    weft_normal_equations_solve(&own, POSE, motion);
    state moved = {.pose = *pose};
    for (int k = 0; k < POSE; k++)
        move(k, motion[k], &moved);
    *pose = moved.pose;
}

/* One step from `from` to `to`; false where there is none. */
static bool step(adjustment *b, double damping, const weft_bundle *from, weft_bundle *to)
{
    double shared[SHARED] = {0};
    state all = {from->camera, from->bend, from->pose[0]};
    if (!reduce(b, damping))
        return false;
    for (int i = 0; i < b->count * SHARED; i++)
        shared[i % SHARED] += b->gradient[i / SHARED][i % SHARED];
    weft_cholesky_solve(SHARED, SHARED, b->information[0], shared);
    for (int k = 0; k < SHARED; k++)
        move(POSE + k, shared[k], &all);
    to->camera = all.camera;
    to->bend = all.bend;
    for (int i = 0; i < b->count; i++) {
        to->pose[i] = from->pose[i];
        move_pose(&b->equations[i], shared, damping, &to->pose[i]);
    }
    return true;
}

/* Levenberg's method. */
static void minimise(adjustment *b, weft_bundle *best, weft_pose *spare)
{
    double damping = first_damping;
    weft_bundle trial = *best;
    trial.pose = spare;
    best->squares = gather_all(b, best);
    for (int i = 0; i < MOST_STEPS && damping < most_damping && step(b, damping, best, &trial); i++) {
        trial.squares = gather_all(b, &trial);
        bool better = trial.squares<best->squares, done = trial.squares> best->squares * (1 - settled);
        damping = better ? fmax(least_damping, damping / 10) : damping * 10;
        if (better) {
            memcpy(best->pose, trial.pose, (size_t)b->count * sizeof *trial.pose);
            best->camera = trial.camera, best->bend = trial.bend, best->squares = trial.squares;
        }
        if (better && done)
            return;
        if (!better)
            gather_all(b, best);
    }
}

/* The larger of the standard errors that corners have if each errs on its own, and those if each photograph does: by
 * how much the solution moves without it (jackknife). The latter decide what the bend is worth. */
static void judge(adjustment *b, weft_bundle *found)
{
    double variance[SHARED] = {0}, spread[3][3] = {{0}}, corners = 0, unknowns = POSE * b->count;
    const double value[3] = {found->bend.xx * bend_square, found->bend.xy * bend_square, found->bend.yy * bend_square};
    double score[3] = {value[0], value[1], value[2]};
    gather_all(b, found);
    if (!reduce(b, least_damping))
        return;
    for (int i = 0; i < b->count; i++) {
        double *apart = b->gradient[i];
        corners += b->view[i].count;
        weft_cholesky_solve(SHARED, SHARED, b->information[0], apart);
        for (int k = 0; k < SHARED; k++)
            variance[k] += apart[k] * apart[k];
        for (int k = 0; k < 9; k++)
            spread[k / 3][k % 3] += apart[WEFT_BUNDLE_BEND + k / 3] * apart[WEFT_BUNDLE_BEND + k % 3];
    }
    for (int k = 0; k < SHARED; k++)
        unknowns += is_free(b->terms, POSE + k);
    for (int k = 0; k < SHARED; k++) {
        double unit[SHARED] = {0};
        unit[k] = 1;
        weft_cholesky_solve(SHARED, SHARED, b->information[0], unit);
        variance[k] = fmax(variance[k], unit[k] * found->squares / fmax(1, 2 * corners - unknowns));
        found->standard_error[k] = is_free(b->terms, POSE + k) ? sqrt(variance[k]) : 0;
    }
    if (b->count > 4 && is_free(b->terms, POSE + WEFT_BUNDLE_BEND) && weft_cholesky_factor(3, 3, spread[0])) {
        weft_cholesky_solve(3, 3, spread[0], score);
        for (int k = 0; k < 3; k++)
            found->bend_score += value[k] * score[k] * (b->count - 3) / (3.0 * (b->count - 1));
    }
    found->standard_error[WEFT_BUNDLE_FOCAL_LENGTH] *= 1e-3 * found->camera.fx;
    found->standard_error[WEFT_BUNDLE_K1] *= 0.01;
    found->standard_error[WEFT_BUNDLE_K2] *= 0.05;
}

weft_code weft_bundle_adjust(const weft_corner_view *view, int count, unsigned terms, weft_bundle *found,
                             weft_error *error)
{
    size_t n = (size_t)count;
    adjustment b = {view, count, terms, malloc(n * sizeof *b.equations), malloc(n * sizeof *b.gradient), {{0}}};
    weft_pose *spare = malloc(n * sizeof *spare);
    weft_code code =
        b.equations && b.gradient && spare ? WEFT_OK : weft_fail_memory(error, "poses", n * sizeof *b.equations);
    memset(found->standard_error, 0, sizeof found->standard_error);
    found->bend_score = 0;
    if (code == WEFT_OK) {
        minimise(&b, found, spare);
        judge(&b, found);
    }
    free(b.equations);
    free(b.gradient);
    free(spare);
    return code;
}

double weft_bundle_rms_px(const weft_bundle *bundle, int pose, const weft_corner_view *view)
{
    const state s = {bundle->camera, bundle->bend, bundle->pose[pose]};
    double squares = 0;
    for (int i = 0; i < view->count; i++) {
        weft_pixel at = seen_at(&s, view->plate[i]);
        squares += pow(view->seen[i][0] - at.x, 2) + pow(view->seen[i][1] - at.y, 2);
    }
    return sqrt(squares / fmax(1, view->count));
}

#include "registration/axes/calibration.h"

#include "base/numeric/statistics.h"

#include <stdlib.h>
#include <string.h>

enum { GRID = 5, PLACES = GRID * GRID };

/* Of a standard deviation beforehand. */
static const double step = 1e-4;

/* What a pose shows: where on the plate the pixels lie that another pose sees the places of a grid in, and the
 * direction that it is seen from. */
typedef struct shown {
    double mm[PLACES][2], direction[3];
} shown;

static void place(double opening_mm, int index, double mm[2])
{
    mm[0] = opening_mm * ((index % GRID + 0.5) / GRID - 0.5);
    mm[1] = opening_mm * ((index / GRID + 0.5) / GRID - 0.5);
}

/* `taken` and its camera are what is taken for true; `true_pose` puts the places into pixels. */
static shown show(const weft_camera *taken_camera, const weft_pose *taken, const weft_camera *true_camera,
                  const weft_pose *true_pose, double opening_mm)
{
    shown s;
    weft_homography seen = weft_homography_of_pose(taken_camera, taken), back = weft_homography_inverse(&seen);
    weft_vec3 direction = weft_unit(weft_pose_camera_position(true_pose));
    for (int i = 0; i < PLACES; i++) {
        double mm[2];
        place(opening_mm, i, mm);
        weft_pixel pixel = weft_camera_undistort(taken_camera, weft_pose_sees(true_camera, true_pose, mm[0], mm[1]));
        weft_pixel on_plate = weft_homography_apply(&back, pixel.x, pixel.y);
        s.mm[i][0] = on_plate.x;
        s.mm[i][1] = on_plate.y;
    }
    s.direction[0] = direction.x;
    s.direction[1] = direction.y;
    s.direction[2] = direction.z;
    return s;
}

static shown slope(const shown *above, const shown *below, double twice)
{
    shown s;
    for (int i = 0; i < PLACES; i++) {
        s.mm[i][0] = (above->mm[i][0] - below->mm[i][0]) / twice;
        s.mm[i][1] = (above->mm[i][1] - below->mm[i][1]) / twice;
    }
    for (int i = 0; i < 3; i++)
        s.direction[i] = (above->direction[i] - below->direction[i]) / twice;
    return s;
}

/* Inner products of slopes: mean over the places, mm^2, and of the directions. */
static double shift_product(const shown *a, const shown *b)
{
    double sum = 0;
    for (int i = 0; i < PLACES; i++)
        sum += a->mm[i][0] * b->mm[i][0] + a->mm[i][1] * b->mm[i][1];
    return sum / PLACES;
}

static double turn_product(const shown *a, const shown *b)
{
    return a->direction[0] * b->direction[0] + a->direction[1] * b->direction[1] + a->direction[2] * b->direction[2];
}

typedef struct variance {
    double mm2, rad2;
} variance;

/* How what is shown changes with unknown k of the model, or, from `unknowns` on, with the shot's own place. */
static shown slope_of(const weft_axes_fit *fit, const weft_rig_poses *nominal, double opening_mm,
                      const weft_turns *turns, int k)
{
    weft_pose taken = weft_rig_poses_at(&fit->poses, turns);
    shown side[2];
    for (int s = 0; s < 2; s++) {
        double unknown[WEFT_UNKNOWNS], moved = s ? -step : step;
        weft_motion motion = {{0, 0, 0}, {0, 0, 0}};
        memcpy(unknown, fit->unknown, sizeof unknown);
        if (k < fit->unknowns)
            unknown[k] += moved;
        else
            (k < fit->unknowns + 3 ? motion.rotation : motion.translation)[(k - fit->unknowns) % 3] = moved;
        weft_rig_poses other = k < fit->unknowns ? weft_rig_poses_with(nominal, &fit->terms, unknown) : fit->poses;
        weft_pose pose = weft_rig_poses_at(&other, turns), own = weft_pose_of_motion(&motion);
        pose = weft_pose_after(&pose, &own);
        side[s] = show(&fit->poses.camera, &taken, &other.camera, &pose, opening_mm);
    }
    return slope(&side[0], &side[1], 2 * step);
}

static void add(double covariance, const shown *a, const shown *b, variance *v)
{
    v->mm2 += covariance * shift_product(a, b);
    v->rad2 += covariance * turn_product(a, b);
}

/* A pose that shows the opening from behind or from the side, if only for some unknowns, says nothing. */
static double deviation(double square)
{
    return square >= 0 ? sqrt(square) : INFINITY;
}

weft_expected_pose weft_axes_expect_pose(const weft_axes_fit *fit, const weft_rig_poses *nominal, double opening_mm,
                                         int texels, const weft_turns *turns)
{
    double per_mm = texels / opening_mm;
    const double own[2] = {fit->scatter.rotation_rad, fit->scatter.translation_mm};
    shown slopes[WEFT_UNKNOWNS + WEFT_OWN_UNKNOWNS] = {0};
    variance model = {0, 0}, scatter = {0, 0};
    for (int k = 0; k < fit->unknowns + WEFT_OWN_UNKNOWNS; k++)
        slopes[k] = slope_of(fit, nominal, opening_mm, turns, k);
    for (int i = 0; i < fit->unknowns; i++)
        for (int j = 0; j < fit->unknowns; j++)
            add(fit->covariance[i * fit->unknowns + j], &slopes[i], &slopes[j], &model);
    for (int k = 0; k < WEFT_OWN_UNKNOWNS; k++)
        add(own[k / 3] * own[k / 3], &slopes[fit->unknowns + k], &slopes[fit->unknowns + k], &scatter);
    return (weft_expected_pose){*turns, deviation(model.mm2) * per_mm, deviation(scatter.mm2) * per_mm,
                                deviation(model.mm2 + scatter.mm2) * per_mm, deviation(model.rad2 + scatter.rad2)};
}

/* ---- Poses of a plan ---- */

static const double same_deg = 0.01;

static bool turned_in(const weft_axes_shot *shot, int count, int joint)
{
    for (int i = 1; i < count; i++) {
        if (fabs(shot[i].turns.deg[joint] - shot[0].turns.deg[joint]) > same_deg)
            return true;
    }
    return false;
}

static double wrapped(double deg)
{
    return deg - 360 * round(deg / 360);
}

/* By whole turns to the middle of where a joint stood in the series. */
static double turned_to_series(const weft_axes_shot *shot, int count, int joint, double deg)
{
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < count; i++) {
        low = fmin(low, shot[i].turns.deg[joint]);
        high = fmax(high, shot[i].turns.deg[joint]);
    }
    return (low + high) / 2 + wrapped(deg - (low + high) / 2);
}

bool weft_axes_turns_like(const weft_axes_shot *shot, int count, weft_angles view, weft_turns *turns)
{
    double theta_deg = weft_deg_of_rad(view.theta_rad), phi_deg = weft_deg_of_rad(view.phi_rad);
    *turns = shot[0].turns;
    if (turned_in(shot, count, WEFT_CAMERA_THETA))
        turns->deg[WEFT_CAMERA_THETA] = theta_deg;
    if (turned_in(shot, count, WEFT_CAMERA_PHI))
        turns->deg[WEFT_CAMERA_PHI] =
            turned_to_series(shot, count, WEFT_CAMERA_PHI, phi_deg + turns->deg[WEFT_SAMPLE_PHI]);
    else if (turned_in(shot, count, WEFT_SAMPLE_PHI))
        turns->deg[WEFT_SAMPLE_PHI] =
            turned_to_series(shot, count, WEFT_SAMPLE_PHI, turns->deg[WEFT_CAMERA_PHI] - phi_deg);
    bool same_theta = fabs(turns->deg[WEFT_CAMERA_THETA] - theta_deg) <= same_deg;
    double phi_off = wrapped(turns->deg[WEFT_CAMERA_PHI] - turns->deg[WEFT_SAMPLE_PHI] - phi_deg);
    return same_theta && (fabs(phi_off) <= same_deg || theta_deg < same_deg);
}

weft_code weft_axes_expect(const weft_axes_fit *fit, const weft_rig_poses *nominal, double opening_mm, int texels,
                           const weft_turns *turns, int count, weft_expectation *expectation, weft_error *error)
{
    double *each = calloc((size_t)count + 1, sizeof *each);
    *expectation = (weft_expectation){.poses = count};
    if (!each)
        return weft_fail_memory(error, "poses", (size_t)count * sizeof *each);
    for (int i = 0; i < count; i++) {
        weft_expected_pose one = weft_axes_expect_pose(fit, nominal, opening_mm, texels, &turns[i]);
        each[i] = one.texels;
        if (one.texels > expectation->worst.texels)
            expectation->worst = one;
        expectation->direction_rad = fmax(expectation->direction_rad, one.direction_rad);
    }
    expectation->median_texels = weft_quantile(each, (size_t)count, 0.5);
    free(each);
    return WEFT_OK;
}

#include "capture/axes/axes.h"

#include <math.h>
#include <stdio.h>

const char *const weft_body_name[] = {"camera", "light", "sample", NULL};
const char *const weft_turn_name[] = {"theta", "phi", NULL};

/* Positions closer than this are one: a hundredth of what controllers count. */
static const double same_deg = 1e-5;
/* Angles that no axis turns need not agree better than this with those of a plan. */
static const double fixed_tolerance_deg = 0.01;

int weft_axes_find(const weft_axes *axes, weft_body body, weft_turn turn)
{
    for (int k = 0; k < axes->count; k++) {
        if (axes->axis[k].moves == body && axes->axis[k].angle == turn)
            return k;
    }
    return -1;
}

/* ---- A rig that makes sense ---- */

static weft_code check_pair(const weft_axis *a, const weft_axis *b, const char *path, weft_error *error)
{
    if (a->moves == b->moves && a->angle == b->angle)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: axes '%s' and '%s' both turn %s of the %s", path, a->name, b->name,
                         weft_turn_name[a->angle], weft_body_name[a->moves]);
    if (a->channel == b->channel)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: axes '%s' and '%s' are both channel %d of the controller", path,
                         a->name, b->name, a->channel);
    return WEFT_OK;
}

weft_code weft_axes_check(const weft_axes *axes, const char *path, weft_error *error)
{
    for (int k = 0; k < axes->count; k++) {
        for (int other = 0; other < k; other++)
            WEFT_TRY(check_pair(&axes->axis[other], &axes->axis[k], path, error));
    }
    if (weft_axes_find(axes, WEFT_BODY_SAMPLE, WEFT_TURN_THETA) >= 0)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: a sample turns in phi alone", path);
    bool all_turn = weft_axes_find(axes, WEFT_BODY_SAMPLE, WEFT_TURN_PHI) >= 0 &&
                    weft_axes_find(axes, WEFT_BODY_CAMERA, WEFT_TURN_PHI) >= 0 &&
                    (axes->lamps || weft_axes_find(axes, WEFT_BODY_LIGHT, WEFT_TURN_PHI) >= 0);
    if (all_turn)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: camera, light and sample all turn in phi; leave one out", path);
    return WEFT_OK;
}

/* ---- Poses ---- */

/* One way to take up a pose: with camera or light beyond the zenith, or not. */
typedef struct way {
    bool camera_beyond, light_beyond;
} way;

/* From -180 to 180. */
static double wrapped(double deg)
{
    return deg - 360 * round(deg / 360);
}

static double position_of_angle(const weft_axis *axis, double angle_deg)
{
    return axis->zero_deg + (axis->reversed ? -angle_deg : angle_deg);
}

/* By whole turns as near as can be to the middle of where the axis may stand. */
static double turned_to_middle(const weft_axis *axis, double position_deg)
{
    double middle = (axis->low_deg + axis->high_deg) / 2;
    return middle + wrapped(position_deg - middle);
}

static weft_code place(const weft_axes *axes, weft_body body, weft_turn turn, double angle_deg,
                       weft_axis_positions *positions, weft_error *error)
{
    int k = weft_axes_find(axes, body, turn);
    double fixed = axes->fixed_deg[body][turn];
    if (k < 0 && fabs(wrapped(angle_deg - fixed)) > fixed_tolerance_deg)
        return weft_fail(error, WEFT_BAD_INPUT, "the %s stands at %s %g degrees and cannot turn to %g",
                         weft_body_name[body], weft_turn_name[turn], fixed, wrapped(angle_deg));
    if (k < 0)
        return WEFT_OK;
    const weft_axis *axis = &axes->axis[k];
    double position = position_of_angle(axis, angle_deg);
    if (turn == WEFT_TURN_PHI)
        position = turned_to_middle(axis, position);
    /* It comes to its target from one side, and must have room to do so. */
    double low = axis->low_deg + (axis->approach_down ? 0 : axis->backlash_deg);
    double high = axis->high_deg - (axis->approach_down ? axis->backlash_deg : 0);
    if (position < low - same_deg || position > high + same_deg)
        return weft_fail(error, WEFT_BAD_INPUT, "axis '%s' would have to turn to %g degrees; its range is %g to %g",
                         axis->name, position, low, high);
    positions->deg[k] = position;
    return WEFT_OK;
}

/* Phi of the laboratory less that of the sample. */
static double sample_turn(const weft_axes *axes, double view_phi_deg, double light_phi_deg)
{
    if (weft_axes_find(axes, WEFT_BODY_SAMPLE, WEFT_TURN_PHI) < 0)
        return axes->fixed_deg[WEFT_BODY_SAMPLE][WEFT_TURN_PHI];
    if (weft_axes_find(axes, WEFT_BODY_CAMERA, WEFT_TURN_PHI) < 0)
        return axes->fixed_deg[WEFT_BODY_CAMERA][WEFT_TURN_PHI] - view_phi_deg;
    return axes->fixed_deg[WEFT_BODY_LIGHT][WEFT_TURN_PHI] - light_phi_deg;
}

static weft_code place_light(const weft_axes *axes, double theta_deg, double phi_deg, weft_axis_positions *positions,
                             weft_error *error)
{
    if (axes->lamps)
        return WEFT_OK;
    WEFT_TRY(place(axes, WEFT_BODY_LIGHT, WEFT_TURN_THETA, theta_deg, positions, error));
    /* A light at the zenith has no phi. */
    bool needs_phi = fabs(theta_deg) > same_deg || weft_axes_find(axes, WEFT_BODY_LIGHT, WEFT_TURN_PHI) >= 0;
    return needs_phi ? place(axes, WEFT_BODY_LIGHT, WEFT_TURN_PHI, phi_deg, positions, error) : WEFT_OK;
}

static weft_code try_way(const weft_axes *axes, way w, weft_angles view, weft_angles light,
                         weft_axis_positions *positions, weft_error *error)
{
    double view_theta = weft_deg_of_rad(view.theta_rad), light_theta = weft_deg_of_rad(light.theta_rad);
    double view_phi = weft_deg_of_rad(view.phi_rad) + (w.camera_beyond ? 180 : 0);
    double light_phi = weft_deg_of_rad(light.phi_rad) + (w.light_beyond ? 180 : 0);
    double turn = sample_turn(axes, view_phi, light_phi);
    *positions = (weft_axis_positions){0};
    WEFT_TRY(
        place(axes, WEFT_BODY_CAMERA, WEFT_TURN_THETA, w.camera_beyond ? -view_theta : view_theta, positions, error));
    WEFT_TRY(place(axes, WEFT_BODY_CAMERA, WEFT_TURN_PHI, view_phi + turn, positions, error));
    WEFT_TRY(place(axes, WEFT_BODY_SAMPLE, WEFT_TURN_PHI, turn, positions, error));
    return place_light(axes, w.light_beyond ? -light_theta : light_theta, light_phi + turn, positions, error);
}

weft_code weft_axes_solve(const weft_axes *axes, weft_angles view, weft_angles light, weft_axis_positions *positions,
                          weft_error *error)
{
    static const way others[3] = {{false, true}, {true, false}, {true, true}};
    weft_code code = try_way(axes, (way){false, false}, view, light, positions, error);
    for (int i = 0; code != WEFT_OK && i < 3; i++) {
        if (try_way(axes, others[i], view, light, positions, NULL) == WEFT_OK)
            code = WEFT_OK;
    }
    return code;
}

double weft_axes_angle(const weft_axes *axes, const weft_axis_positions *positions, weft_body body, weft_turn turn)
{
    int k = weft_axes_find(axes, body, turn);
    return k < 0 ? axes->fixed_deg[body][turn]
                 : (positions->deg[k] - axes->axis[k].zero_deg) * (axes->axis[k].reversed ? -1 : 1);
}

weft_angles weft_axes_light_on_sample(const weft_axes *axes, const weft_axis_positions *positions, weft_angles lamp)
{
    double turn = weft_axes_angle(axes, positions, WEFT_BODY_SAMPLE, WEFT_TURN_PHI);
    double phi_deg = weft_deg_of_rad(lamp.phi_rad) - turn;
    return (weft_angles){lamp.theta_rad, weft_rad_of_deg(phi_deg - 360 * floor(phi_deg / 360))};
}

bool weft_axes_same_viewpoint(const weft_axes *axes, const weft_axis_positions *a, const weft_axis_positions *b)
{
    for (int k = 0; k < axes->count; k++) {
        if (axes->axis[k].moves != WEFT_BODY_LIGHT && fabs(a->deg[k] - b->deg[k]) > same_deg)
            return false;
    }
    return true;
}

/* ---- Time ---- */

double weft_axis_first_leg(const weft_axis *axis, double from_deg, double to_deg)
{
    double side = axis->approach_down ? -1 : 1;
    if (axis->backlash_deg == 0 || (to_deg - from_deg) * side >= axis->backlash_deg) /* false from nowhere */
        return to_deg;
    return to_deg - side * axis->backlash_deg;
}

double weft_axis_leg_s(const weft_axis *axis, double distance_deg)
{
    double distance = fabs(distance_deg), speed = axis->speed_deg_s, acceleration = axis->acceleration_deg_s2;
    double reaches_speed = speed * speed / acceleration;
    return distance < reaches_speed ? 2 * sqrt(distance / acceleration) : distance / speed + speed / acceleration;
}

/* The two legs of a move and its settling, over the axes. */
typedef struct move_time {
    double first_s, last_s, settle_s;
} move_time;

static void add_axis(const weft_axis *axis, bool together, double from_deg, double to_deg, move_time *time)
{
    if (fabs(to_deg - from_deg) <= same_deg)
        return;
    double first = weft_axis_first_leg(axis, from_deg, to_deg);
    double first_s = weft_axis_leg_s(axis, first - from_deg), last_s = weft_axis_leg_s(axis, to_deg - first);
    time->first_s = together ? fmax(time->first_s, first_s) : time->first_s + first_s;
    time->last_s = together ? fmax(time->last_s, last_s) : time->last_s + last_s;
    time->settle_s = fmax(time->settle_s, axis->settle_s);
}

double weft_axes_move_s(const weft_axes *axes, const weft_axis_positions *from, const weft_axis_positions *to)
{
    move_time time = {0};
    for (int k = 0; k < axes->count; k++)
        add_axis(&axes->axis[k], axes->together, from->deg[k], to->deg[k], &time);
    return time.first_s + time.last_s + time.settle_s;
}

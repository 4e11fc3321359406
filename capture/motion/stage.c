#include "capture/motion/stage.h"

#include "capture/axes/path.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double same_deg = 1e-5;

struct weft_stage {
    weft_stage_parts parts;
    weft_stage *body; /* which has the axes; of several cameras, that of the first */
    long seen;        /* body->viewpoints, when this camera was placed last; -1: not since it was homed */
    /* Of a body. */
    weft_axis_positions at; /* NAN: not known */
    bool homed, placed;     /* placed: since it was homed, in a pose of a photograph */
    int lamp;               /* that lights the pose */
    long viewpoints;        /* how often camera or sample have come to stand elsewhere */
};

/* ---- Lamps ---- */

static double angle_between(weft_angles a, weft_angles b)
{
    weft_vec3 p = weft_direction_of_angles(a), q = weft_direction_of_angles(b);
    return atan2(weft_length(weft_cross(p, q)), weft_dot(p, q));
}

static weft_angles lamp_on_sample(const weft_stage_parts *parts, const weft_axis_positions *positions, int lamp)
{
    return weft_axes_light_on_sample(parts->axes, positions, parts->lamp[lamp]);
}

static int nearest_lamp(const weft_stage_parts *parts, const weft_axis_positions *positions, weft_angles light)
{
    int best = 0;
    double least = INFINITY;
    for (int lamp = 0; lamp < parts->lamp_count; lamp++) {
        double angle = angle_between(light, lamp_on_sample(parts, positions, lamp));
        if (angle < least) {
            least = angle;
            best = lamp;
        }
    }
    return best;
}

/* ---- Poses ---- */

static weft_code fail_shot(const weft_shot *shot, weft_error *error)
{
    weft_error cause = error ? *error : (weft_error){0};
    return weft_fail(error, WEFT_BAD_INPUT, "light %.2f/%.2f, view %.2f/%.2f degrees: %s",
                     weft_deg_of_rad(shot->light.theta_rad), weft_deg_of_rad(shot->light.phi_rad),
                     weft_deg_of_rad(shot->view.theta_rad), weft_deg_of_rad(shot->view.phi_rad), cause.message);
}

static weft_code choose_lamp(const weft_stage_parts *parts, const weft_axis_positions *positions, weft_shot *shot,
                             weft_error *error)
{
    int lamp = nearest_lamp(parts, positions, shot->light);
    weft_angles found = lamp_on_sample(parts, positions, lamp);
    double angle = angle_between(found, shot->light);
    if (angle > parts->lamp_tolerance_rad)
        return weft_fail(error, WEFT_BAD_INPUT, "the nearest lamp, %d, is %.2f degrees away", lamp,
                         weft_deg_of_rad(angle));
    shot->light_driven = found;
    return WEFT_OK;
}

static weft_code reach(void *device, weft_shot *shot, weft_error *error)
{
    const weft_stage_parts *parts = &((weft_stage *)device)->parts;
    weft_axis_positions positions;
    weft_code code = weft_axes_solve(parts->axes, shot->view, shot->light_driven, &positions, error);
    if (code == WEFT_OK && parts->lamp_count > 0)
        code = choose_lamp(parts, &positions, shot, error);
    return code == WEFT_OK ? WEFT_OK : fail_shot(shot, error);
}

static weft_code turns(void *device, const weft_shot *shot, weft_turns *at, weft_error *error)
{
    const weft_axes *axes = ((weft_stage *)device)->parts.axes;
    weft_axis_positions positions;
    WEFT_TRY(weft_axes_solve(axes, shot->view, shot->light_driven, &positions, error));
    at->deg[WEFT_CAMERA_THETA] = weft_axes_angle(axes, &positions, WEFT_BODY_CAMERA, WEFT_TURN_THETA);
    at->deg[WEFT_CAMERA_PHI] = weft_axes_angle(axes, &positions, WEFT_BODY_CAMERA, WEFT_TURN_PHI);
    at->deg[WEFT_SAMPLE_PHI] = weft_axes_angle(axes, &positions, WEFT_BODY_SAMPLE, WEFT_TURN_PHI);
    return WEFT_OK;
}

/* ---- Several cameras ---- */

static weft_code place(void *device, const weft_shot *shot, weft_place *place, weft_error *error)
{
    const weft_stage_parts *parts = &((weft_stage *)device)->parts;
    weft_axis_positions positions;
    WEFT_TRY(weft_axes_solve(parts->axes, shot->view, shot->light_driven, &positions, error));
    *place = (weft_place){0};
    for (int k = 0; k < parts->axes->count; k++)
        place->at[k] = positions.deg[k];
    if (parts->lamp_count > 0)
        place->at[WEFT_AXES_MAX] = nearest_lamp(parts, &positions, shot->light_driven);
    return WEFT_OK;
}

static weft_code view_of(void *device, void *taker, const weft_shot *shot, weft_angles *view, weft_error *error)
{
    const weft_axes *own = ((weft_stage *)device)->parts.axes, *other = ((weft_stage *)taker)->parts.axes;
    weft_axis_positions positions;
    WEFT_TRY(weft_axes_solve(other, shot->view, shot->light_driven, &positions, error));
    double theta_deg = weft_axes_angle(own, &positions, WEFT_BODY_CAMERA, WEFT_TURN_THETA);
    double phi_deg = weft_axes_angle(own, &positions, WEFT_BODY_CAMERA, WEFT_TURN_PHI) -
                     weft_axes_angle(own, &positions, WEFT_BODY_SAMPLE, WEFT_TURN_PHI);
    if (theta_deg < 0) {
        theta_deg = -theta_deg;
        phi_deg += 180;
    }
    *view = (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg - 360 * floor(phi_deg / 360))};
    return WEFT_OK;
}

/* ---- Order ---- */

static weft_code order_poses(const weft_stage *stage, const weft_shot *shot, int count, int *numbers,
                             weft_axis_positions *pose, weft_stage_estimate *estimate, weft_error *error)
{
    int *index = malloc((size_t)count * sizeof *index), *before = malloc((size_t)count * sizeof *before);
    weft_axes_path path = {0};
    weft_code code = index && before ? WEFT_OK : weft_fail_memory(error, "plan", 2 * (size_t)count * sizeof *index);
    for (int i = 0; code == WEFT_OK && i < count; i++) {
        const weft_shot *s = &shot[numbers[i]];
        index[i] = i;
        before[i] = numbers[i];
        code = weft_axes_solve(stage->parts.axes, s->view, s->light_driven, &pose[i], error);
    }
    if (code == WEFT_OK)
        code = weft_axes_order(stage->parts.axes, pose, count, index, &path, error);
    for (int i = 0; code == WEFT_OK && i < count; i++)
        numbers[i] = before[index[i]];
    *estimate = (weft_stage_estimate){path.seconds, path.moves};
    free(index);
    free(before);
    return code;
}

static weft_code order(void *device, const weft_shot *shot, int count, int *numbers, weft_stage_estimate *estimate,
                       weft_error *error)
{
    *estimate = (weft_stage_estimate){0};
    if (count == 0)
        return WEFT_OK;
    weft_axis_positions *pose = calloc((size_t)count, sizeof *pose);
    if (!pose)
        return weft_fail_memory(error, "plan", (size_t)count * sizeof *pose);
    weft_code code = order_poses(device, shot, count, numbers, pose, estimate, error);
    free(pose);
    return code;
}

/* ---- Moving ---- */

static void forget_places(weft_stage *stage)
{
    for (int k = 0; k < stage->parts.axes->count; k++) {
        if (!stage->parts.axes->axis[k].by_hand)
            stage->at.deg[k] = NAN;
    }
    stage->homed = stage->placed = false;
}

static unsigned driven_axes(const weft_axes *axes)
{
    unsigned mask = 0;
    for (int k = 0; k < axes->count; k++)
        mask |= (unsigned)!axes->axis[k].by_hand << k;
    return mask;
}

static weft_code drive_home(weft_stage *stage, weft_move_failure *failure, weft_error *error)
{
    weft_controller *controller = stage->parts.controller;
    forget_places(stage);
    if (controller)
        WEFT_TRY(weft_controller_home(controller, driven_axes(stage->parts.axes), failure, error));
    stage->homed = true;
    return WEFT_OK;
}

/* One leg of the axes in `mask`: at once, or one after another. */
static weft_code drive_leg(weft_stage *stage, unsigned mask, const weft_axis_positions *to, weft_move_failure *failure,
                           weft_error *error)
{
    for (int k = 0; k < stage->parts.axes->count; k++) {
        unsigned now = stage->parts.axes->together ? mask : mask & 1u << k;
        if (now == 0)
            continue;
        WEFT_TRY(weft_controller_move(stage->parts.controller, now, to, failure, error));
        if (stage->parts.axes->together)
            break;
    }
    return WEFT_OK;
}

static weft_code drive_legs(weft_stage *stage, const weft_axis_positions *to, weft_move_failure *failure,
                            weft_error *error)
{
    const weft_axes *axes = stage->parts.axes;
    weft_axis_positions first = *to;
    unsigned moving = 0, beside = 0;
    for (int k = 0; k < axes->count; k++) {
        if (axes->axis[k].by_hand || fabs(stage->at.deg[k] - to->deg[k]) <= same_deg)
            continue;
        moving |= 1u << k;
        first.deg[k] = weft_axis_first_leg(&axes->axis[k], stage->at.deg[k], to->deg[k]);
        beside |= (unsigned)(first.deg[k] != to->deg[k]) << k;
    }
    WEFT_TRY(drive_leg(stage, moving, &first, failure, error));
    WEFT_TRY(drive_leg(stage, beside, to, failure, error));
    for (int k = 0; k < axes->count; k++) {
        if (moving >> k & 1)
            stage->at.deg[k] = to->deg[k];
    }
    return WEFT_OK;
}

/* Until the axes stand there, homed again as often as they lose their references. */
static weft_code drive(weft_stage *stage, const weft_axis_positions *to, weft_error *error)
{
    weft_code code = WEFT_SYSTEM;
    weft_move_failure failure = WEFT_MOVE_LOST;
    for (int attempt = 0; code != WEFT_OK && failure == WEFT_MOVE_LOST && attempt <= stage->parts.retries; attempt++) {
        code = stage->homed ? WEFT_OK : drive_home(stage, &failure, error);
        if (code == WEFT_OK)
            code = drive_legs(stage, to, &failure, error);
        if (code != WEFT_OK)
            forget_places(stage);
    }
    return code;
}

/* ---- Axes that an operator turns ---- */

static weft_code turn_by_hand(weft_stage *stage, const weft_axis_positions *to, weft_error *error)
{
    const weft_axes *axes = stage->parts.axes;
    for (int k = 0; k < axes->count; k++) {
        char text[128];
        if (!axes->axis[k].by_hand || fabs(stage->at.deg[k] - to->deg[k]) <= same_deg)
            continue;
        snprintf(text, sizeof text, "Set the axis '%s' to %.2f degrees.", axes->axis[k].name, to->deg[k]);
        WEFT_TRY(stage->parts.rig_operator.ask(stage->parts.rig_operator.context, text, error));
        stage->at.deg[k] = to->deg[k];
    }
    return WEFT_OK;
}

/* ---- The rig's interface ---- */

static void settle(double seconds)
{
    const struct timespec pause = {(time_t)seconds, (long)((seconds - floor(seconds)) * 1e9)};
    if (seconds > 0)
        nanosleep(&pause, NULL);
}

static double settle_time(const weft_stage *stage, const weft_axis_positions *from, const weft_axis_positions *to)
{
    double seconds = 0;
    for (int k = 0; k < stage->parts.axes->count; k++) {
        if (!(fabs(from->deg[k] - to->deg[k]) <= same_deg))
            seconds = fmax(seconds, stage->parts.axes->axis[k].settle_s);
    }
    return seconds;
}

static weft_code home(void *device, int first_viewpoint, weft_error *error)
{
    weft_stage *seat = device, *stage = seat->body;
    weft_move_failure failure = WEFT_MOVE_LOST;
    weft_code code = WEFT_SYSTEM;
    (void)first_viewpoint;
    seat->seen = -1;
    if (seat != stage && stage->homed)
        return WEFT_OK;
    for (int attempt = 0; code != WEFT_OK && failure == WEFT_MOVE_LOST && attempt <= stage->parts.retries; attempt++)
        code = drive_home(stage, &failure, error);
    for (int k = 0; k < stage->parts.axes->count; k++)
        stage->at.deg[k] = NAN;
    return code;
}

static weft_code move(void *device, weft_angles view, weft_angles light, bool *moved, weft_error *error)
{
    weft_stage *seat = device, *stage = seat->body;
    weft_axis_positions to, from = stage->at;
    bool was_placed = stage->placed;
    WEFT_TRY(weft_axes_solve(seat->parts.axes, view, light, &to, error));
    if (stage->parts.lamp_count > 0)
        stage->lamp = nearest_lamp(&stage->parts, &to, light);
    WEFT_TRY(drive(stage, &to, error));
    WEFT_TRY(turn_by_hand(stage, &to, error));
    /* Homed on the way: the references are as good as before, but not the same. */
    stage->viewpoints += !was_placed || !stage->placed || !weft_axes_same_viewpoint(stage->parts.axes, &from, &to);
    stage->placed = true;
    *moved = seat->seen != stage->viewpoints;
    seat->seen = stage->viewpoints;
    settle(settle_time(stage, &from, &to));
    return WEFT_OK;
}

static weft_code held(void *device, bool *still, weft_error *error)
{
    weft_stage *stage = ((weft_stage *)device)->body;
    *still = true;
    if (stage->parts.controller)
        WEFT_TRY(weft_controller_held(stage->parts.controller, still, error));
    if (!*still)
        forget_places(stage);
    return WEFT_OK;
}

static void stop(void *device)
{
    weft_stage *stage = ((weft_stage *)device)->body;
    if (stage->parts.controller)
        weft_controller_stop(stage->parts.controller);
    forget_places(stage);
}

static weft_code power(void *device, bool on, weft_error *error)
{
    weft_stage *stage = ((weft_stage *)device)->body;
    const weft_lamp_switch *lamps = &stage->parts.lamps;
    if (!lamps->set)
        return WEFT_OK;
    WEFT_TRY(lamps->set(lamps->device, on ? stage->lamp : -1, stage->parts.level, error));
    settle(on ? stage->parts.warm_up_s : 0);
    return WEFT_OK;
}

weft_code weft_stage_create(const weft_stage_parts *parts, weft_stage **result, weft_error *error)
{
    weft_stage *stage = calloc(1, sizeof *stage);
    if (!stage)
        return weft_fail_memory(error, "stage", sizeof *stage);
    stage->parts = *parts;
    stage->body = stage;
    stage->seen = -1;
    for (int k = 0; k < WEFT_AXES_MAX; k++)
        stage->at.deg[k] = NAN;
    *result = stage;
    return WEFT_OK;
}

weft_code weft_stage_create_beside(weft_stage *stage, const weft_axes *axes, weft_stage **beside, weft_error *error)
{
    weft_stage_parts parts = stage->parts;
    parts.axes = axes;
    WEFT_TRY(weft_stage_create(&parts, beside, error));
    (*beside)->body = stage;
    return WEFT_OK;
}

void weft_stage_free(weft_stage *stage)
{
    free(stage);
}

weft_rig_stage weft_stage_for_rig(weft_stage *stage)
{
    return (weft_rig_stage){.device = stage,
                            .home = home,
                            .move = move,
                            .held = held,
                            .stop = stop,
                            .reach = reach,
                            .turns = turns,
                            .order = order,
                            .place = place,
                            .view_of = view_of};
}

weft_rig_light weft_stage_light(weft_stage *stage)
{
    return (weft_rig_light){stage, power};
}

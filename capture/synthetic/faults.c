#include "capture/synthetic/plan.h"

const char *weft_synthetic_fault_name(weft_synthetic_fault fault)
{
    static const char *const name[] = {"good",      "shaken",       "other scene", "lens cap",
                                       "hand over", "underexposed", "half out"};
    return name[fault];
}

/* Half of the sheet leaves the frame: the camera is turned aside by half its field. */
static void turn_aside(weft_synthetic_shot *shot, weft_dice *d)
{
    double angle =
        0.5 * shot->lens.sensor_width_mm / shot->lens.image_distance_mm * (weft_dice_between(d, 0, 1) < 0.5 ? -1 : 1);
    double c = cos(angle), s = sin(angle);
    weft_pose old = shot->pose;
    const double *t = &old.translation.x;
    for (int k = 0; k < 3; k++) {
        shot->pose.rotation[0][k] = c * old.rotation[0][k] + s * old.rotation[2][k];
        shot->pose.rotation[2][k] = c * old.rotation[2][k] - s * old.rotation[0][k];
    }
    shot->pose.translation.x = c * t[0] + s * t[2];
    shot->pose.translation.z = c * t[2] - s * t[0];
}

weft_synthetic_fault weft_synthetic_fault_of(const weft_synthetic_request *request, int photograph)
{
    for (int i = 0; i < request->rubbish_count; i++) {
        if ((int)((i + 0.6) * request->photograph_count / request->rubbish_count) == photograph)
            return (weft_synthetic_fault)(1 + i % (WEFT_SYNTHETIC_FAULT_COUNT - 1));
    }
    return WEFT_SYNTHETIC_GOOD;
}

/* A hand in from one side: the shadow of its fingertips ends `short_of` before the middle of the opening. */
static void reach_in(weft_dice *d, double part, double short_of, weft_synthetic_shot *shot)
{
    const double reach = 110;
    double turn = weft_dice_between(d, 0, 2 * WEFT_PI);
    weft_vec3 along = {cos(turn), sin(turn), 0}, aside = {-along.y, along.x, 0};
    weft_vec3 tip = weft_add(weft_scale(along, -short_of), weft_scale(aside, weft_dice_normal(d, 15)));
    weft_vec3 above = weft_add(weft_scale(tip, 1 - part), weft_scale(shot->lamp.at, part));
    shot->hand_along = along;
    shot->hand = weft_subtract(above, weft_scale(along, reach));
    shot->hand.z = fmax(shot->hand.z, 32);
}

/* How far the line of the arm stays from the camera's line of sight to a corner of the opening's surroundings. */
static double room_beside_hand(const weft_synthetic_request *request, const weft_synthetic_shot *shot)
{
    weft_synthetic_solid arm = {.a = weft_add(shot->hand, weft_scale(shot->hand_along, 110)),
                                .b = weft_add(shot->hand, weft_scale(shot->hand_along, -260))};
    weft_vec3 eye = weft_pose_camera_position(&shot->pose);
    double room = INFINITY, side = 1.4 * request->opening_mm;
    for (int i = 0; i < 4; i++) {
        weft_vec3 corner = {i & 1 ? side : -side, i & 2 ? side : -side, 0};
        room = fmin(room, weft_synthetic_solid_distance(&arm, corner, eye));
    }
    return room;
}

void weft_synthetic_place_hand(const weft_synthetic_request *request, weft_dice *d, weft_synthetic_shot *shot)
{
    const double half_hand = 55;
    if (shot->fault == WEFT_SYNTHETIC_HAND_OVER) {
        reach_in(d, 0.08, -0.8 * request->opening_mm, shot);
        return;
    }
    for (int try = 0; try < 60; try++) {
        reach_in(d, weft_dice_between(d, 0.08, 0.25), request->opening_mm * weft_dice_between(d, -0.2, 1.2), shot);
        if (room_beside_hand(request, shot) > half_hand)
            return;
    }
}

void weft_synthetic_spoil(weft_dice *d, weft_synthetic_shot *shot)
{
    if (shot->fault == WEFT_SYNTHETIC_UNDEREXPOSED) {
        shot->exposure.seconds /= 64;
        shot->exposure.gain /= 64;
    }
    if (shot->fault == WEFT_SYNTHETIC_HALF_OUT)
        turn_aside(shot, d);
}

/* The axes of a stage: which of camera, light and sample each turns, where it must stand for a pose, and how long it
 * takes to get there. Angles are degrees here, as in rig files and on controllers. All functions are pure.
 *
 * A rig is three bodies, each turned in theta (from the zenith) and phi (from x toward y) of the laboratory; the sample
 * turns in phi alone. What no axis turns stands at a fixed angle. With the sample turned by s, a camera at (theta, phi)
 * of the laboratory sees it from (theta, phi - s), and so for the light. (theta, phi) and (-theta, phi + 180) are one
 * direction: an axis of theta that reaches beyond the zenith may take up either. */
#ifndef WEFT_CAPTURE_AXES_AXES_H
#define WEFT_CAPTURE_AXES_AXES_H

#include "base/status.h"
#include "btf/direction/direction.h"

#include <stdbool.h>

enum { WEFT_AXES_MAX = 8, WEFT_AXIS_NAME_SIZE = 32 };

typedef enum weft_body { WEFT_BODY_CAMERA, WEFT_BODY_LIGHT, WEFT_BODY_SAMPLE, WEFT_BODY_COUNT } weft_body;
typedef enum weft_turn { WEFT_TURN_THETA, WEFT_TURN_PHI, WEFT_TURN_COUNT } weft_turn;

/* "camera", "light", "sample"; "theta", "phi"; both end with NULL. */
extern const char *const weft_body_name[], *const weft_turn_name[];

typedef struct weft_axis {
    char name[WEFT_AXIS_NAME_SIZE];
    weft_body moves;
    weft_turn angle;
    int channel;              /* of the controller */
    double low_deg, high_deg; /* where it may stand */
    double zero_deg;          /* where it stands when the angle is 0 */
    bool reversed;            /* the angle falls as the position grows */
    bool by_hand;             /* an operator turns it */
    double speed_deg_s, acceleration_deg_s2, settle_s;
    double backlash_deg; /* a position is taken up from below, from this far at least; 0: from either side */
    bool approach_down;  /* from above instead */
} weft_axis;

typedef struct weft_axes {
    int count;
    weft_axis axis[WEFT_AXES_MAX];
    double fixed_deg[WEFT_BODY_COUNT][WEFT_TURN_COUNT]; /* of what no axis turns */
    bool together;                                      /* all axes of a move start at once; else one after another */
    bool lamps; /* the light is one of many lamps: whatever direction it must have is another's business */
} weft_axes;

typedef struct weft_axis_positions {
    double deg[WEFT_AXES_MAX];
} weft_axis_positions;

/* The axis that turns a body, or -1. */
int weft_axes_find(const weft_axes *axes, weft_body body, weft_turn turn);

/* Whether every pose has no more than one way to be taken up. Errors: WEFT_BAD_INPUT, "PATH: ..." for two axes of one
 * angle or channel, a sample that turns in theta, or one that turns where camera and light do. */
weft_code weft_axes_check(const weft_axes *axes, const char *path, weft_error *error);

/* Where the axes stand so that the sample is seen from `view` and lit from `light`; of several places that of the least
 * turned angles. Errors: WEFT_BAD_INPUT naming the axis or the fixed angle that does not allow it. */
weft_code weft_axes_solve(const weft_axes *axes, weft_angles view, weft_angles light, weft_axis_positions *positions,
                          weft_error *error);

/* The angle that the axis of a body stands for where it is, unwrapped; the fixed angle where no axis turns it. Pure. */
double weft_axes_angle(const weft_axes *axes, const weft_axis_positions *positions, weft_body body, weft_turn turn);

/* Where light from a lamp of the laboratory falls from, on the sample as it is turned. */
weft_angles weft_axes_light_on_sample(const weft_axes *axes, const weft_axis_positions *positions, weft_angles lamp);

/* Where an axis goes before its target, to come to it from the side that its backlash asks for; the target itself where
 * it comes from there anyway. NAN stands for a place that is not known. */
double weft_axis_first_leg(const weft_axis *axis, double from_deg, double to_deg);

/* Seconds of one leg: from rest to rest, with the axis' acceleration and at most its speed. */
double weft_axis_leg_s(const weft_axis *axis, double distance_deg);

/* Seconds of a move: first legs, then last legs, then the longest time to settle of those that moved; 0 where none
 * does. */
double weft_axes_move_s(const weft_axes *axes, const weft_axis_positions *from, const weft_axis_positions *to);

/* Whether camera or sample stand elsewhere, so that the photograph has another pose. */
bool weft_axes_same_viewpoint(const weft_axes *axes, const weft_axis_positions *a, const weft_axis_positions *b);

#endif

/* Where a rig truly stands: the axes that turn camera and sample, as `weft calibrate` finds them
 * (docs/reference/poses-format.md).
 *
 * Three joints, from the camera to the sample: theta of the camera, its phi, and phi of the sample. A joint is a line
 * in the frame of the plate, as it lies while all turns are 0. With turns q the plate is seen from home . E0(q0) .
 * E1(q1) . E2(q2),    Ek(q) = the rotation about line k by q, with what the bearing adds to it (a product of
 * exponentials: Brockett 1984; Okamura & Park 1996). A turn is the angle that a position of the axis stands for: what
 * no axis turns has a turn all the same, and always the same. There is no frame but that of the plate, so that nothing
 * is told twice: the zero of an axis is in `home` and in the lines beyond it.
 *
 * All functions are pure. */
#ifndef WEFT_BTF_SESSION_RIG_POSES_H
#define WEFT_BTF_SESSION_RIG_POSES_H

#include "btf/session/camera.h"

#include <stdbool.h>

enum { WEFT_JOINTS = 3 };

typedef enum weft_joint_name { WEFT_CAMERA_THETA, WEFT_CAMERA_PHI, WEFT_SAMPLE_PHI } weft_joint_name;

/* "camera theta", "camera phi", "sample phi". */
extern const char *const weft_joint_text[WEFT_JOINTS];

/* Where the joints stand by their scales, degrees. */
typedef struct weft_turns {
    double deg[WEFT_JOINTS];
} weft_turns;

/* A joint. Turned by q it rotates about its line by q (1 + scale) + uneven[0] (cos q - 1) + uneven[1] sin q. Then its
 * line leans by the small rotation vector x e1 + y e2 across it, where x + i y = w e^(-i q) + w' e^(2 i q) with w =
 * wobble[0] + i wobble[1], w' = wobble[2] + i wobble[3], less what that is at q = 0. (A lean that stands still, or
 * turns with the joint, is only another line: these are the lowest harmonics that are not.) */
typedef struct weft_joint {
    weft_vec3 direction; /* unit; turns are right-handed about it */
    weft_vec3 point;     /* of the line, nearest to the origin, mm */
    double scale;
    double uneven[2]; /* rad */
    double wobble[4]; /* rad */
} weft_joint;

/* Rotation and translation of a pose as six numbers: of the rotation vector, rad, and mm. */
typedef struct weft_motion {
    double rotation[3], translation[3];
} weft_motion;

/* The pose of a rotation vector (Rodrigues 1840) and a translation, and back. */
weft_pose weft_pose_of_motion(const weft_motion *motion);
weft_motion weft_motion_of_pose(const weft_pose *pose);

/* What maps as `inner` and then as `outer` does. */
weft_pose weft_pose_after(const weft_pose *outer, const weft_pose *inner);

typedef struct weft_rig_poses {
    weft_camera camera; /* the lens that the poses go with */
    weft_pose home;     /* all turns 0 */
    weft_joint joint[WEFT_JOINTS];
} weft_rig_poses;

/* A rig as it should be: all lines through the origin, the camera at `distance_mm` (weft_pose_of_view). */
weft_rig_poses weft_rig_poses_nominal(const weft_camera *camera, double distance_mm);

/* The turns of a rig in which view phi is taken up by the camera. Phi is from -180 to 180. */
weft_turns weft_turns_of_view(weft_angles view);

/* The pose of the camera. */
weft_pose weft_rig_poses_at(const weft_rig_poses *poses, const weft_turns *turns);

/* The direction that a pose sees the origin of the plate from. */
weft_angles weft_pose_view(const weft_pose *pose);

/* Whether the middle of the plate is in front of the camera, and the camera above the plate. */
bool weft_pose_is_above(const weft_pose *pose);

/* Two unit vectors across a unit vector: e1, e2 and the vector are right-handed. */
void weft_across(weft_vec3 direction, weft_vec3 *e1, weft_vec3 *e2);

#endif

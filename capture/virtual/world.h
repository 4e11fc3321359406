/* What the virtual rig truly is, behind its calibration: a function of settings, seed and the count of viewpoints
 * alone. The virtual camera photographs it and the ground truth records it.
 *
 * Rig frame: that of the nominal poses. Plate frame: that of the sample, mounted a little askew in the rig. */
#ifndef WEFT_CAPTURE_VIRTUAL_WORLD_H
#define WEFT_CAPTURE_VIRTUAL_WORLD_H

#include "capture/virtual/virtual_settings.h"

/* A point of the plate in the frame of a camera, and back. Pure. */
weft_vec3 weft_pose_apply(const weft_pose *pose, weft_vec3 point);
weft_vec3 weft_pose_apply_inverse(const weft_pose *pose, weft_vec3 point);

typedef struct weft_virtual_world {
    weft_virtual_settings settings;
    uint64_t seed;        /* of what all cameras share: plate, sample and lamps */
    int index;            /* of this camera among those of the rig */
    uint64_t camera_seed; /* of its own errors; that of the first is `seed` */
    weft_camera camera;   /* the true one */
    weft_pose mounting;   /* rig point = rotation . plate point + translation */
} weft_virtual_world;

/* As camera `index` of the rig finds it. Pure. */
weft_virtual_world weft_virtual_world_of_camera(const weft_virtual_settings *settings, uint64_t seed, int index);

/* Plate frame to true camera frame during a viewpoint: the nominal pose, with the error of the camera arm drawn for
 * this viewpoint, after the mounting of the plate. Pure. */
weft_pose weft_virtual_world_pose(const weft_virtual_world *world, weft_angles view, int viewpoint);

/* Where the light stands in the plate frame, mm, with the error of its arm drawn for this move; of lamps that stand
 * still, with that of the lamp. Pure. */
weft_vec3 weft_virtual_world_light(const weft_virtual_world *world, weft_angles driven, int viewpoint);

/* Whether the body of this camera stands between the light and the sample. It covers nine tenths of the angle that the
 * settings keep free. Pure. */
bool weft_virtual_world_shadowed(const weft_virtual_world *world, const weft_pose *pose, weft_vec3 light);

/* ---- The goniometer of the virtual rig: a ring on its foot, an arm on the ring, a camera on the arm. Each part is a frame
 * that is carried by the part before it, and each is off a little. (What calibrates a rig knows lines in the frame of
 * the plate instead: btf/session/rig_poses.h.) */

/* Rig frame to camera frame, when the scales are driven to `view`. Without errors it is weft_pose_of_view. Pure. */
weft_pose weft_virtual_goniometer_pose(const weft_virtual_settings *settings, uint64_t seed, weft_angles view);

/* ---- Several virtual cameras: evenly spaced on a ring about the zenith, which carries all of them. It tilts and turns as a
 * whole, by less than the space between two: so each camera takes the views of one sector of phi. All functions are
 * pure; with one camera there is no ring. */

/* Which camera takes a view. */
int weft_virtual_ring_camera(const weft_virtual_world *world, weft_angles view);

/* From where camera `other` sees while that of `world` stands at `view`. */
weft_angles weft_virtual_ring_view(const weft_virtual_world *world, weft_angles view, int other);

/* Whether one of the other cameras stands between the light (plate frame) and the sample, while that of `world` stands
 * at `view`. At the zenith there is room for one only. */
bool weft_virtual_ring_shadows(const weft_virtual_world *world, weft_angles view, weft_vec3 light);

#endif

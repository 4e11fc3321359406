/* What the virtual rig truly is, behind its calibration: a function of settings, seed and the count of viewpoints
 * alone. The virtual camera photographs it and the ground truth records it.
 *
 * Rig frame: that of the nominal poses. Plate frame: that of the sample, mounted a little askew in the rig. */
#ifndef WEFT_CAPTURE_VIRTUAL_WORLD_H
#define WEFT_CAPTURE_VIRTUAL_WORLD_H

#include "capture/virtual/virtual_settings.h"

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

/* The same for the first camera. Pure. */
weft_virtual_world weft_virtual_world_of(const weft_virtual_settings *settings, uint64_t seed);

/* Plate frame to true camera frame during a viewpoint: the nominal pose, with the error of the camera arm drawn for
 * this viewpoint, after the mounting of the plate. Pure. */
weft_pose weft_virtual_world_pose(const weft_virtual_world *world, weft_angles view, int viewpoint);

/* Where the light stands in the plate frame, mm, with the error of its arm drawn for this move; of lamps that stand
 * still, with that of the lamp. Pure. */
weft_vec3 weft_virtual_world_light(const weft_virtual_world *world, weft_angles driven, int viewpoint);

/* Whether the body of this camera stands between the light and the sample. It covers nine tenths of the angle that the
 * settings keep free. Pure. */
bool weft_virtual_world_shadowed(const weft_virtual_world *world, const weft_pose *pose, weft_vec3 light);

#endif

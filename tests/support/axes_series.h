/* Series of shots of the target by the virtual goniometer (capture/virtual/goniometer.h), as weft calibrate takes them:
 * parts that carry each other, with errors of its own, its true lens, and scatter from shot to shot. */
#ifndef WEFT_TESTS_SUPPORT_AXES_SERIES_H
#define WEFT_TESTS_SUPPORT_AXES_SERIES_H

#include "capture/virtual/world.h"
#include "registration/axes/calibration.h"

/* Shots of assets/plans/calibration.csv, and the most that a series has. */
enum { AXES_SERIES_SHOTS = 20, AXES_SERIES_MOST = 160 };

typedef struct axes_series {
    weft_virtual_world world;
    int count;
    weft_axes_shot shot[AXES_SERIES_MOST];
    weft_rig_poses nominal;
} axes_series;

weft_angles axes_degrees(double theta_deg, double phi_deg);

/* A rig that is off by half a degree and a millimetre, and repeats as the virtual one does. */
weft_virtual_settings axes_off_settings(void);

/* Points of the target in the shot of a viewpoint, with noise of 0.01 pixels. */
void axes_see(const weft_virtual_world *world, weft_angles view, int viewpoint, weft_axes_shot *shot);

/* The views of assets/plans/calibration.csv, in order. Pure. */
weft_angles axes_series_view(int index);

/* Those views so many times over. */
axes_series axes_series_take(const weft_virtual_settings *settings, uint64_t seed, int rounds);

/* The rig as it stands, without what differs from shot to shot. */
weft_virtual_world axes_at_rest(const weft_virtual_world *world);

/* What brings the plate from where one pose sees it to where another does: a turn about the line of the axis. */
weft_pose axes_true_turn(const weft_virtual_world *rest, weft_angles from, weft_angles to);

/* Direction of the line of a turn, and the angle between two directions. */
weft_vec3 axes_direction(const weft_pose *turn);
double axes_angle_deg(weft_vec3 a, weft_vec3 b);

#endif

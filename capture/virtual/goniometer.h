/* The goniometer of the virtual rig: a ring on its foot, an arm on the ring, a camera on the arm. Each part is a frame
 * that is carried by the part before it, and each is off a little. (What calibrates a rig knows lines in the frame of
 * the plate instead: btf/session/rig_poses.h.) */
#ifndef WEFT_CAPTURE_VIRTUAL_GONIOMETER_H
#define WEFT_CAPTURE_VIRTUAL_GONIOMETER_H

#include "capture/virtual/virtual_settings.h"

/* Rig frame to camera frame, when the scales are driven to `view`. Without errors it is weft_pose_of_view. Pure. */
weft_pose weft_virtual_goniometer_pose(const weft_virtual_settings *settings, uint64_t seed, weft_angles view);

#endif

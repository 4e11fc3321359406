/* Frames of the sensor, taken before the first shot: without light, and of an even field. Registration finds the faults
 * of the sensor in them (registration/radiometry/sensor_defects.h). */
#ifndef WEFT_CAPTURE_SENSOR_FRAMES_H
#define WEFT_CAPTURE_SENSOR_FRAMES_H

#include "base/progress.h"
#include "capture/rig.h"

#include <signal.h>

/* Frames of the session that are not taken yet. Pure. */
int weft_sensor_frames_missing(const weft_session *session);

/* Takes them, and writes each to the disk and to the journal. Dark ones are exposed as briefly and as long as the rig
 * exposes: what lies between follows from the two. The flat ones are exposed so that the 99.5th percentile of the
 * brightest channel lies just below 0.8 of full scale. Returns between frames where `stop` (may be NULL) is not 0. In
 * the end, also after a failure, the camera sees the sample again, and the lamp is off. Errors: those of the rig, once
 * an exposure has failed `retries` + 1 times; WEFT_SYSTEM. */
weft_code weft_sensor_frames_take(weft_rig *rig, weft_session *session, const volatile sig_atomic_t *stop,
                                  const weft_progress *progress, weft_error *error);

#endif

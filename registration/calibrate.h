/* What the photographs of a session tell of the rig beside its calibration: the bend of the plate and the vignetting of
 * the lens. Both are the same for the whole session, so they are found once, before the poses, from some of its
 * viewpoints. */
#ifndef WEFT_REGISTRATION_CALIBRATE_H
#define WEFT_REGISTRATION_CALIBRATE_H

#include "registration/outcome/outcome.h"
#include "registration/radiometry/sensor_defects.h"

/* Finds both, writes them into registration->found and makes `sight` see by them. Photographs that cannot be used are
 * named in registration->fault. Where no viewpoint shows the target, nothing is found and nothing is changed. Errors:
 * WEFT_SYSTEM. Uses OpenMP. Memory: 256 MB of photographs at most, or those of one viewpoint. */
weft_code weft_calibrate(const weft_sensor_defects *faults, weft_registration *registration, weft_sight *sight,
                         weft_error *error);

#endif

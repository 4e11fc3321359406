/* What a calibration of axes tells, in words. */
#ifndef WEFT_REGISTRATION_AXES_MESSAGES_H
#define WEFT_REGISTRATION_AXES_MESSAGES_H

#include "registration/axes/calibration.h"

/* A joint that stands in too few places. Errors: WEFT_SYSTEM. */
weft_code weft_axes_say_places(weft_lines *lines, int joint, int places, weft_error *error);

/* A term that is held; `with` is a fit in which it is free. Errors: WEFT_SYSTEM. */
weft_code weft_axes_say_held(weft_lines *lines, const weft_axes_fit *with, const weft_camera *camera, int index,
                             weft_error *error);

/* What was found, from report->file to report->told. Errors: WEFT_SYSTEM. */
weft_code weft_axes_say_found(weft_axes_report *report, const weft_rig_poses *nominal, weft_error *error);

#endif

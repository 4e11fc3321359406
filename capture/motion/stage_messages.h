/* What a controller answers, in words. */
#ifndef WEFT_CAPTURE_MOTION_STAGE_MESSAGES_H
#define WEFT_CAPTURE_MOTION_STAGE_MESSAGES_H

#include "capture/axes/axes.h"
#include "capture/firmware/protocol.h"

/* A position of the protocol, thousandths of a degree, in degrees. */
double weft_stage_degrees(int32_t position);

/* Fails with WEFT_SYSTEM, naming the axis of `axes` that is at fault and where it stands. */
weft_code weft_stage_fail_fault(const weft_axes *axes, const weft_stage_reply *reply, weft_error *error);

/* Fails with WEFT_SYSTEM: asked to do `what`, it did not. */
weft_code weft_stage_fail_result(const weft_stage_reply *reply, const char *what, weft_error *error);

#endif

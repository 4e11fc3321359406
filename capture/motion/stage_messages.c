#include "capture/motion/stage_messages.h"

double weft_stage_degrees(int32_t position)
{
    return position * 1e-3;
}

static const char *name_of(const weft_axes *axes, int channel)
{
    for (int k = 0; k < axes->count; k++) {
        if (axes->axis[k].channel == channel && !axes->axis[k].by_hand)
            return axes->axis[k].name;
    }
    return "that nobody named";
}

weft_code weft_stage_fail_fault(const weft_axes *axes, const weft_stage_reply *reply, weft_error *error)
{
    const char *axis = name_of(axes, reply->fault_axis);
    double at = reply->fault_axis < WEFT_PROTOCOL_AXES ? weft_stage_degrees(reply->position[reply->fault_axis]) : 0;
    if (reply->fault == WEFT_FAULT_STALLED)
        return weft_fail(error, WEFT_SYSTEM, "stage: axis '%s' stalled at %.3f degrees", axis, at);
    if (reply->fault == WEFT_FAULT_LIMIT)
        return weft_fail(error, WEFT_SYSTEM, "stage: axis '%s' hit its limit switch at %.3f degrees", axis, at);
    return weft_fail(error, WEFT_SYSTEM, "stage: axis '%s' does not find its reference", axis);
}

weft_code weft_stage_fail_result(const weft_stage_reply *reply, const char *what, weft_error *error)
{
    static const char *const words[] = {[WEFT_RESULT_DONE] = "did it",
                                        [WEFT_RESULT_BAD_CRC] = "got a broken question",
                                        [WEFT_RESULT_BAD_VERSION] = "speaks another version of the protocol",
                                        [WEFT_RESULT_BAD_COMMAND] = "cannot do that",
                                        [WEFT_RESULT_BEYOND_LIMIT] = "says that this is beyond its limits",
                                        [WEFT_RESULT_NOT_HOMED] = "is not homed",
                                        [WEFT_RESULT_BUSY] = "is still moving"};
    bool known = (unsigned)reply->result < sizeof words / sizeof *words;
    return weft_fail(error, WEFT_SYSTEM, "stage: asked to %s, the controller %s", what,
                     known ? words[reply->result] : "answers nonsense");
}

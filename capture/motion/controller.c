#include "capture/motion/controller.h"

#include "base/clock.h"

#include <math.h>
#include <stdlib.h>

static double degrees(int32_t position)
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

static weft_code fail_fault(const weft_axes *axes, const weft_stage_reply *reply, weft_error *error)
{
    const char *axis = name_of(axes, reply->fault_axis);
    double at = reply->fault_axis < WEFT_PROTOCOL_AXES ? degrees(reply->position[reply->fault_axis]) : 0;
    if (reply->fault == WEFT_FAULT_STALLED)
        return weft_fail(error, WEFT_SYSTEM, "stage: axis '%s' stalled at %.3f degrees", axis, at);
    if (reply->fault == WEFT_FAULT_LIMIT)
        return weft_fail(error, WEFT_SYSTEM, "stage: axis '%s' hit its limit switch at %.3f degrees", axis, at);
    return weft_fail(error, WEFT_SYSTEM, "stage: axis '%s' does not find its reference", axis);
}

static weft_code fail_result(const weft_stage_reply *reply, const char *what, weft_error *error)
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

/* Axes that move stop when the host has been silent for so long. */
enum { SILENCE_MS = 2000 };

/* A move may take this many times what it should, and so much more. */
static const double patience = 3, patience_s = 10;
static const double homing_patience_s = 600;

struct weft_controller {
    weft_controller_settings settings;
    const weft_axes *axes;
    weft_usb_link link;
    bool greeted;
    uint32_t boot;           /* of the controller as it was greeted last */
    uint32_t reference_boot; /* and as it was homed */
    uint16_t disturbances;
    unsigned mask;               /* of the last move */
    weft_axis_positions wanted;  /* by it */
    weft_axis_positions reached; /* before it */
};

static weft_code fail_lost(weft_move_failure *failure)
{
    *failure = WEFT_MOVE_LOST;
    return WEFT_SYSTEM;
}

static bool stop_asked(const weft_controller *c)
{
    return c->settings.stop && *c->settings.stop;
}

static int32_t thousandths(double deg)
{
    return (int32_t)lround(deg * 1e3);
}

/* ---- Asking ---- */

/* Once, on an open link. */
static weft_link_outcome ask(weft_controller *c, weft_stage_request request, weft_stage_reply *reply)
{
    return weft_usb_link_ask(&c->link, &request, reply);
}

static weft_code fail_outcome(weft_link_outcome outcome, weft_error *error)
{
    return weft_fail(error, WEFT_SYSTEM,
                     outcome == WEFT_LINK_GONE ? "stage: the controller was unplugged"
                                               : "stage: the controller does not answer");
}

/* Soft limits are the narrower of what the rig file says and what is built in. */
static weft_code send_limits(weft_controller *c, weft_error *error)
{
    for (int k = 0; k < c->axes->count; k++) {
        const weft_axis *axis = &c->axes->axis[k];
        weft_stage_reply reply;
        weft_stage_request request = {.command = WEFT_COMMAND_LIMITS,
                                      .number = (uint8_t)axis->channel,
                                      .value = {thousandths(axis->low_deg), thousandths(axis->high_deg)}};
        if (axis->by_hand)
            continue;
        weft_link_outcome outcome = ask(c, request, &reply);
        if (outcome != WEFT_LINK_ANSWERED)
            return fail_outcome(outcome, error);
        if (reply.result != WEFT_RESULT_DONE)
            return weft_fail(error, WEFT_SYSTEM, "stage: the controller does not allow axis '%s' from %g to %g degrees",
                             axis->name, axis->low_deg, axis->high_deg);
    }
    return WEFT_OK;
}

static weft_code greet(weft_controller *c, weft_error *error)
{
    weft_stage_reply reply;
    weft_link_outcome outcome = ask(c, (weft_stage_request){.command = WEFT_COMMAND_HELLO, .word = SILENCE_MS}, &reply);
    if (outcome != WEFT_LINK_ANSWERED)
        return fail_outcome(outcome, error);
    if (reply.result != WEFT_RESULT_DONE)
        return fail_result(&reply, "say hello", error);
    /* Another start: its references are gone, and with them whatever was known of where the axes stand. */
    bool restarted = !c->greeted || reply.boot != c->boot;
    c->greeted = true;
    c->boot = reply.boot;
    return restarted ? send_limits(c, error) : WEFT_OK;
}

/* Opens the controller, waiting for one that was there before. */
static weft_code reach(weft_controller *c, weft_error *error)
{
    if (c->link.handle)
        return WEFT_OK;
    bool again = c->greeted;
    WEFT_TRY(weft_usb_link_open(&c->link, again ? c->settings.replug_s : 0, error));
    return greet(c, error);
}

/* Asks whatever happens to the cable meanwhile. Only what may be done twice is asked so: a controller that was
 * unplugged does not say what it heard before. Errors: WEFT_SYSTEM where it stays away or silent. */
static weft_code ask_surely(weft_controller *c, weft_stage_request request, weft_stage_reply *reply, weft_error *error)
{
    weft_link_outcome outcome = WEFT_LINK_GONE;
    for (int attempt = 0; outcome == WEFT_LINK_GONE && attempt <= c->settings.retries; attempt++) {
        weft_code code = reach(c, error);
        /* Pulled out again while it was being greeted. */
        if (code != WEFT_OK && c->link.handle == NULL && attempt < c->settings.retries && c->greeted && !stop_asked(c))
            continue;
        WEFT_TRY(code);
        outcome = ask(c, request, reply);
    }
    return outcome == WEFT_LINK_ANSWERED ? WEFT_OK : fail_outcome(outcome, error);
}

/* ---- Waiting for axes ---- */

void weft_controller_stop(weft_controller *c)
{
    weft_stage_reply reply;
    if (!c->link.handle)
        return;
    ask(c, (weft_stage_request){.command = WEFT_COMMAND_STOP}, &reply);
}

static void pause_for(double seconds)
{
    const struct timespec pause = {(time_t)seconds, (long)((seconds - floor(seconds)) * 1e9)};
    if (seconds > 0)
        nanosleep(&pause, NULL);
}

static weft_code fail_restarted(weft_move_failure *failure, weft_error *error)
{
    weft_error_set(error, WEFT_SYSTEM, "stage: the controller started anew and lost its references");
    return fail_lost(failure);
}

/* Until no axis moves. A controller that has started anew meanwhile has lost its references. */
static weft_code wait_for_rest(weft_controller *c, double limit_s, weft_stage_reply *reply, weft_move_failure *failure,
                               weft_error *error)
{
    double end_s = weft_now_s() + limit_s;
    *failure = WEFT_MOVE_OVER;
    for (;;) {
        if (stop_asked(c)) {
            weft_controller_stop(c);
            return weft_fail(error, WEFT_SYSTEM, "stopped while the stage moved");
        }
        WEFT_TRY(ask_surely(c, (weft_stage_request){.command = WEFT_COMMAND_STATUS}, reply, error));
        if (c->boot != c->reference_boot)
            return fail_restarted(failure, error);
        if (reply->state == WEFT_STATE_FAULT) {
            fail_fault(c->axes, reply, error);
            return fail_lost(failure);
        }
        if (reply->state != WEFT_STATE_MOVING && reply->state != WEFT_STATE_HOMING)
            return WEFT_OK;
        if (weft_now_s() > end_s)
            break;
        pause_for(c->settings.poll_s);
    }
    weft_controller_stop(c);
    return weft_fail(error, WEFT_SYSTEM, "stage: the axes still move after %.0f s", limit_s);
}

/* ---- Homing ---- */

static uint8_t channels_of(const weft_controller *c, unsigned mask)
{
    unsigned channels = 0;
    for (int k = 0; k < c->axes->count; k++)
        channels |= (mask >> k & 1u) << c->axes->axis[k].channel;
    return (uint8_t)channels;
}

weft_code weft_controller_home(weft_controller *c, unsigned mask, weft_move_failure *failure, weft_error *error)
{
    weft_stage_reply reply;
    *failure = WEFT_MOVE_OVER;
    c->mask = 0;
    WEFT_TRY(reach(c, error));
    c->reference_boot = c->boot;
    uint8_t channels = channels_of(c, mask);
    WEFT_TRY(ask_surely(c, (weft_stage_request){.command = WEFT_COMMAND_HOME, .mask = channels}, &reply, error));
    if (reply.result != WEFT_RESULT_DONE)
        return fail_result(&reply, "home its axes", error);
    WEFT_TRY(wait_for_rest(c, homing_patience_s, &reply, failure, error));
    if ((reply.homed & channels) != channels || reply.state != WEFT_STATE_IDLE) {
        weft_error_set(error, WEFT_SYSTEM, "stage: homing was interrupted");
        return fail_lost(failure);
    }
    for (int k = 0; k < c->axes->count; k++)
        c->reached.deg[k] = degrees(reply.position[c->axes->axis[k].channel]);
    c->disturbances = reply.disturbances;
    return WEFT_OK;
}

/* ---- Moving ---- */

static weft_stage_request request_of_move(const weft_controller *c, unsigned mask, const weft_axis_positions *to)
{
    weft_stage_request request = {.command = WEFT_COMMAND_MOVE, .mask = channels_of(c, mask)};
    for (int k = 0; k < c->axes->count; k++) {
        if (mask >> k & 1)
            request.value[c->axes->axis[k].channel] = thousandths(to->deg[k]);
    }
    return request;
}

/* The host keeps the limits, too, whatever the controller would do. */
static weft_code check_limits(const weft_controller *c, unsigned mask, const weft_axis_positions *to, weft_error *error)
{
    const double rounding_deg = 5e-4;
    for (int k = 0; k < c->axes->count; k++) {
        const weft_axis *axis = &c->axes->axis[k];
        bool inside = to->deg[k] >= axis->low_deg - rounding_deg && to->deg[k] <= axis->high_deg + rounding_deg;
        if ((mask >> k & 1) && !inside)
            return weft_fail(error, WEFT_SYSTEM, "stage: axis '%s' may not go to %g degrees", axis->name, to->deg[k]);
    }
    return WEFT_OK;
}

static double time_for(const weft_controller *c, unsigned mask, const weft_axis_positions *to)
{
    double seconds = 0;
    for (int k = 0; k < c->axes->count; k++) {
        if (mask >> k & 1)
            seconds += weft_axis_leg_s(&c->axes->axis[k], to->deg[k] - c->reached.deg[k]);
    }
    return patience * seconds + patience_s;
}

static bool stands_at(const weft_controller *c, const weft_stage_reply *reply, unsigned mask,
                      const weft_axis_positions *to)
{
    for (int k = 0; k < c->axes->count; k++) {
        double at = degrees(reply->position[c->axes->axis[k].channel]);
        if ((mask >> k & 1) && !(fabs(at - to->deg[k]) <= c->settings.tolerance_deg))
            return false;
    }
    return true;
}

/* A refusal that a new homing may mend. */
static weft_code fail_move(const weft_stage_reply *reply, weft_move_failure *failure, weft_error *error)
{
    fail_result(reply, "move its axes", error);
    bool mends = reply->result == WEFT_RESULT_NOT_HOMED || reply->result == WEFT_RESULT_BUSY;
    *failure = mends ? WEFT_MOVE_LOST : WEFT_MOVE_OVER;
    return WEFT_SYSTEM;
}

weft_code weft_controller_move(weft_controller *c, unsigned mask, const weft_axis_positions *to,
                               weft_move_failure *failure, weft_error *error)
{
    weft_stage_reply reply;
    double limit_s = time_for(c, mask, to);
    *failure = WEFT_MOVE_OVER;
    WEFT_TRY(check_limits(c, mask, to, error));
    if (c->boot != c->reference_boot)
        return fail_restarted(failure, error);
    /* Again where the axes stopped on the way, as they do when the cable is pulled: they know where they are. */
    for (int attempt = 0; attempt <= c->settings.retries; attempt++) {
        if (stop_asked(c))
            return weft_fail(error, WEFT_SYSTEM, "stopped before the stage moved");
        WEFT_TRY(ask_surely(c, request_of_move(c, mask, to), &reply, error));
        /* A cable that was pulled while it was asked to: it may have heard, and move already. */
        bool begun = reply.result == WEFT_RESULT_DONE || reply.result == WEFT_RESULT_BUSY;
        if (!begun)
            return fail_move(&reply, failure, error);
        WEFT_TRY(wait_for_rest(c, limit_s, &reply, failure, error));
        if (reply.state == WEFT_STATE_IDLE && stands_at(c, &reply, mask, to)) {
            c->mask |= mask;
            for (int k = 0; k < c->axes->count; k++)
                c->wanted.deg[k] = c->reached.deg[k] = mask >> k & 1 ? to->deg[k] : c->reached.deg[k];
            c->disturbances = reply.disturbances;
            return WEFT_OK;
        }
    }
    weft_error_set(error, WEFT_SYSTEM, "stage: the axes do not stop where they should");
    return fail_lost(failure);
}

weft_code weft_controller_held(weft_controller *c, bool *still, weft_error *error)
{
    weft_stage_reply reply;
    WEFT_TRY(ask_surely(c, (weft_stage_request){.command = WEFT_COMMAND_STATUS}, &reply, error));
    *still = c->boot == c->reference_boot && reply.state == WEFT_STATE_IDLE && reply.disturbances == c->disturbances &&
             stands_at(c, &reply, c->mask, &c->wanted);
    c->disturbances = reply.disturbances;
    return WEFT_OK;
}

/* ---- Lamps and shutter ---- */

static weft_code set_lamp(void *device, int lamp, double level, weft_error *error)
{
    weft_controller *c = device;
    weft_stage_reply reply;
    uint8_t number = lamp < 0 ? WEFT_PROTOCOL_NO_LAMP : (uint8_t)lamp;
    uint16_t word = lamp < 0 ? 0 : (uint16_t)lround(level * WEFT_PROTOCOL_FULL_LEVEL);
    WEFT_TRY(ask_surely(c, (weft_stage_request){.command = WEFT_COMMAND_LIGHT, .number = number, .word = word}, &reply,
                        error));
    if (reply.result != WEFT_RESULT_DONE)
        return fail_result(&reply, "switch a lamp", error);
    return reply.lamp == number && reply.level == word
               ? WEFT_OK
               : weft_fail(error, WEFT_SYSTEM, "stage: lamp %d does not switch", lamp);
}

static void abandon_lamps(void *device)
{
    weft_controller *c = device;
    c->link.handle = NULL;
    c->greeted = false;
    c->link.stop = c->settings.stop = NULL;
}

weft_code weft_controller_pulse(weft_controller *c, double seconds, weft_error *error)
{
    weft_stage_reply reply;
    WEFT_TRY(reach(c, error));
    weft_stage_request request = {.command = WEFT_COMMAND_SHUTTER, .word = (uint16_t)lround(seconds * 1e3)};
    weft_link_outcome outcome = ask(c, request, &reply);
    if (outcome != WEFT_LINK_ANSWERED)
        return fail_outcome(outcome, error);
    return reply.result == WEFT_RESULT_DONE ? WEFT_OK : fail_result(&reply, "release the shutter", error);
}

/* ---- The controller ---- */

weft_code weft_controller_create(const weft_controller_settings *settings, const weft_axes *axes,
                                 weft_controller **controller, weft_error *error)
{
    weft_controller *c = calloc(1, sizeof *c);
    if (!c)
        return weft_fail_memory(error, "controller", sizeof *c);
    c->settings = *settings;
    c->axes = axes;
    c->link = (weft_usb_link){.address = settings->address,
                              .timeout_s = settings->timeout_s,
                              .retries = settings->retries,
                              .stop = settings->stop};
    *controller = c;
    return WEFT_OK;
}

void weft_controller_free(weft_controller *c)
{
    weft_stage_reply reply;
    if (!c)
        return;
    weft_controller_stop(c);
    if (c->link.handle)
        ask(c, (weft_stage_request){.command = WEFT_COMMAND_LIGHT, .number = WEFT_PROTOCOL_NO_LAMP}, &reply);
    weft_usb_link_close(&c->link);
    free(c);
}

weft_lamp_switch weft_controller_lamps(weft_controller *controller)
{
    return (weft_lamp_switch){controller, set_lamp, abandon_lamps};
}

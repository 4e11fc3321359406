#include "capture/firmware/firmware.h"

#include <string.h>

/* An axis has arrived within ARRIVED, and has been pushed beyond PUSHED; it stalls that turns less than PROGRESS within
 * PATIENCE_MS. Its speed is at most BRAKE times the way left a second, and at least SLOWEST. */
enum { ARRIVED = 2, PUSHED = 8, PROGRESS = 5, PATIENCE_MS = 300, HOMING_MS = 120000, SLOWEST = 100, BRAKE = 10 };

/* ---- Axes ---- */

static int32_t position_of(const weft_firmware *f, int axis)
{
    return f->hardware.encoder(f->hardware.context, axis) + f->axis[axis].offset;
}

static int32_t distance(int32_t a, int32_t b)
{
    return a > b ? a - b : b - a;
}

static void drive(weft_firmware *f, int axis, int32_t speed)
{
    f->hardware.drive(f->hardware.context, axis, speed);
}

static void rest_all(weft_firmware *f, weft_stage_state state)
{
    for (int axis = 0; axis < f->hardware.axis_count; axis++) {
        drive(f, axis, 0);
        f->axis[axis].moving = f->axis[axis].displaced = false;
        f->axis[axis].rest = position_of(f, axis);
    }
    f->to_home = 0;
    f->state = state;
}

/* An axis that stalls or hits its switch may have lost count, and may have pushed the others. */
static void fail(weft_firmware *f, int axis, weft_stage_fault fault)
{
    rest_all(f, WEFT_STATE_FAULT);
    f->fault = fault;
    f->fault_axis = (uint8_t)axis;
    for (int k = 0; k < f->hardware.axis_count; k++)
        f->axis[k].homed = false;
}

static void watch_from(weft_firmware *f, int axis, uint32_t now_ms)
{
    f->axis[axis].watched = position_of(f, axis);
    f->axis[axis].watched_ms = now_ms;
}

/* Whether the axis turns, as it is driven to. */
static bool progresses(weft_firmware *f, int axis, uint32_t now_ms)
{
    if (distance(position_of(f, axis), f->axis[axis].watched) >= PROGRESS)
        watch_from(f, axis, now_ms);
    return now_ms - f->axis[axis].watched_ms < PATIENCE_MS;
}

/* ---- Moving ---- */

static int32_t speed_toward(int32_t way, int32_t fastest)
{
    int64_t speed = (int64_t)(way < 0 ? -way : way) * BRAKE;
    speed = speed < SLOWEST ? SLOWEST : speed > fastest ? fastest : speed;
    return (int32_t)(way < 0 ? -speed : speed);
}

static void move_axis(weft_firmware *f, int axis, uint32_t now_ms)
{
    int32_t way = f->axis[axis].target - position_of(f, axis);
    if (way >= -ARRIVED && way <= ARRIVED) {
        drive(f, axis, 0);
        f->axis[axis].moving = false;
        return;
    }
    if (f->hardware.at_limit(f->hardware.context, axis))
        fail(f, axis, WEFT_FAULT_LIMIT);
    else if (!progresses(f, axis, now_ms))
        fail(f, axis, WEFT_FAULT_STALLED);
    else
        drive(f, axis, speed_toward(way, f->hardware.speed[axis]));
}

static void move_all(weft_firmware *f, uint32_t now_ms)
{
    bool moving = false;
    for (int axis = 0; axis < f->hardware.axis_count && f->state == WEFT_STATE_MOVING; axis++) {
        if (f->axis[axis].moving)
            move_axis(f, axis, now_ms);
        moving = moving || f->axis[axis].moving;
    }
    if (f->state == WEFT_STATE_MOVING && !moving)
        rest_all(f, WEFT_STATE_IDLE);
}

/* ---- Homing ---- */

static int next_to_home(const weft_firmware *f)
{
    int axis = 0;
    while (axis < f->hardware.axis_count && !(f->to_home >> axis & 1))
        axis++;
    return axis < f->hardware.axis_count ? axis : -1;
}

static void begin_homing(weft_firmware *f, uint32_t now_ms)
{
    int axis = next_to_home(f);
    if (axis < 0) {
        rest_all(f, WEFT_STATE_IDLE);
        return;
    }
    f->homing_ms = now_ms;
    bool closed = f->hardware.at_reference(f->hardware.context, axis);
    f->axis[axis].phase = closed ? WEFT_HOMING_BACK : WEFT_HOMING_SEEK;
    watch_from(f, axis, now_ms);
}

static void set_reference(weft_firmware *f, int axis)
{
    drive(f, axis, 0);
    f->axis[axis].offset = f->hardware.reference[axis] - f->hardware.encoder(f->hardware.context, axis);
    f->axis[axis].homed = true;
    f->to_home = (uint8_t)(f->to_home & ~(1u << axis));
}

static int32_t homing_speed(const weft_firmware *f, int axis)
{
    weft_homing_phase phase = f->axis[axis].phase;
    if (phase == WEFT_HOMING_TOUCH)
        return -f->hardware.touch_speed[axis];
    return phase == WEFT_HOMING_BACK ? f->hardware.speed[axis] : -f->hardware.speed[axis];
}

static void home_axis(weft_firmware *f, uint32_t now_ms)
{
    int axis = next_to_home(f);
    if (axis < 0) {
        rest_all(f, WEFT_STATE_IDLE);
        return;
    }
    weft_homing_phase phase = f->axis[axis].phase;
    bool closed = f->hardware.at_reference(f->hardware.context, axis);
    if (closed && phase == WEFT_HOMING_TOUCH) {
        set_reference(f, axis);
        begin_homing(f, now_ms);
        return;
    }
    if (closed && phase == WEFT_HOMING_SEEK)
        f->axis[axis].phase = WEFT_HOMING_BACK;
    if (!closed && phase == WEFT_HOMING_BACK)
        f->axis[axis].phase = WEFT_HOMING_TOUCH;
    if (!progresses(f, axis, now_ms))
        fail(f, axis, WEFT_FAULT_STALLED);
    else if (now_ms - f->homing_ms > HOMING_MS)
        fail(f, axis, WEFT_FAULT_NO_REFERENCE);
    else
        drive(f, axis, homing_speed(f, axis));
}

/* ---- At rest ---- */

/* One push is counted once, however long it lasts. */
static void watch_rest(weft_firmware *f)
{
    for (int axis = 0; axis < f->hardware.axis_count; axis++) {
        bool displaced = distance(position_of(f, axis), f->axis[axis].rest) > PUSHED;
        f->disturbances = (uint16_t)(f->disturbances + (displaced && !f->axis[axis].displaced));
        f->axis[axis].displaced = displaced;
    }
}

void weft_firmware_tick(weft_firmware *f, uint32_t now_ms)
{
    bool moves = f->state == WEFT_STATE_MOVING || f->state == WEFT_STATE_HOMING;
    if (f->shutter_closed && (int32_t)(now_ms - f->shutter_ms) >= 0) {
        f->shutter_closed = false;
        f->hardware.shutter(f->hardware.context, false);
    }
    if (moves && f->silence_ms > 0 && now_ms - f->heard_ms > f->silence_ms)
        rest_all(f, WEFT_STATE_STOPPED);
    else if (f->state == WEFT_STATE_MOVING)
        move_all(f, now_ms);
    else if (f->state == WEFT_STATE_HOMING)
        home_axis(f, now_ms);
    else
        watch_rest(f);
}

/* ---- Requests ---- */

static bool mask_fits(const weft_firmware *f, uint8_t mask)
{
    return mask != 0 && mask >> f->hardware.axis_count == 0;
}

static weft_stage_result set_limits(weft_firmware *f, const weft_stage_request *request)
{
    int axis = request->number;
    if (axis >= f->hardware.axis_count || request->value[0] > request->value[1])
        return WEFT_RESULT_BAD_COMMAND;
    int32_t low = f->hardware.low[axis], high = f->hardware.high[axis];
    if (request->value[0] < low || request->value[1] > high)
        return WEFT_RESULT_BEYOND_LIMIT;
    f->axis[axis].low = request->value[0];
    f->axis[axis].high = request->value[1];
    return WEFT_RESULT_DONE;
}

static weft_stage_result home(weft_firmware *f, const weft_stage_request *request, uint32_t now_ms)
{
    if (!mask_fits(f, request->mask))
        return WEFT_RESULT_BAD_COMMAND;
    rest_all(f, WEFT_STATE_HOMING);
    f->fault = WEFT_FAULT_NONE;
    f->to_home = request->mask;
    for (int axis = 0; axis < f->hardware.axis_count; axis++)
        f->axis[axis].homed = f->axis[axis].homed && !(request->mask >> axis & 1);
    begin_homing(f, now_ms);
    return WEFT_RESULT_DONE;
}

/* All of a move or nothing. */
static weft_stage_result check_move(const weft_firmware *f, const weft_stage_request *request)
{
    if (!mask_fits(f, request->mask))
        return WEFT_RESULT_BAD_COMMAND;
    if (f->state == WEFT_STATE_HOMING || f->state == WEFT_STATE_MOVING)
        return WEFT_RESULT_BUSY;
    for (int axis = 0; axis < f->hardware.axis_count; axis++) {
        if (!(request->mask >> axis & 1))
            continue;
        if (!f->axis[axis].homed)
            return WEFT_RESULT_NOT_HOMED;
        if (request->value[axis] < f->axis[axis].low || request->value[axis] > f->axis[axis].high)
            return WEFT_RESULT_BEYOND_LIMIT;
    }
    return WEFT_RESULT_DONE;
}

static weft_stage_result move(weft_firmware *f, const weft_stage_request *request, uint32_t now_ms)
{
    weft_stage_result result = check_move(f, request);
    if (result != WEFT_RESULT_DONE)
        return result;
    for (int axis = 0; axis < f->hardware.axis_count; axis++) {
        f->axis[axis].moving = request->mask >> axis & 1;
        f->axis[axis].target = request->value[axis];
        watch_from(f, axis, now_ms);
    }
    f->state = WEFT_STATE_MOVING;
    return WEFT_RESULT_DONE;
}

static weft_stage_result stop(weft_firmware *f)
{
    if (f->state == WEFT_STATE_HOMING || f->state == WEFT_STATE_MOVING)
        rest_all(f, WEFT_STATE_STOPPED);
    return WEFT_RESULT_DONE;
}

static weft_stage_result set_light(weft_firmware *f, const weft_stage_request *request)
{
    if (request->number >= f->hardware.lamp_count && request->number != WEFT_PROTOCOL_NO_LAMP)
        return WEFT_RESULT_BAD_COMMAND;
    f->lamp = request->number;
    f->level = request->number == WEFT_PROTOCOL_NO_LAMP ? 0 : request->word;
    f->hardware.light(f->hardware.context, f->lamp, f->level);
    return WEFT_RESULT_DONE;
}

static weft_stage_result pulse(weft_firmware *f, const weft_stage_request *request, uint32_t now_ms)
{
    if (f->shutter_closed)
        return WEFT_RESULT_BUSY;
    f->hardware.shutter(f->hardware.context, true);
    f->shutter_closed = true;
    f->shutter_ms = now_ms + request->word;
    f->pulses++;
    return WEFT_RESULT_DONE;
}

static weft_stage_result carry_out(weft_firmware *f, const weft_stage_request *request, uint32_t now_ms)
{
    switch (request->command) {
    case WEFT_COMMAND_HELLO:
        f->silence_ms = request->word;
        return WEFT_RESULT_DONE;
    case WEFT_COMMAND_STATUS:
        return WEFT_RESULT_DONE;
    case WEFT_COMMAND_LIMITS:
        return set_limits(f, request);
    case WEFT_COMMAND_HOME:
        return home(f, request, now_ms);
    case WEFT_COMMAND_MOVE:
        return move(f, request, now_ms);
    case WEFT_COMMAND_STOP:
        return stop(f);
    case WEFT_COMMAND_LIGHT:
        return set_light(f, request);
    case WEFT_COMMAND_SHUTTER:
        return pulse(f, request, now_ms);
    }
    return WEFT_RESULT_BAD_COMMAND;
}

static void answer(const weft_firmware *f, const weft_stage_request *request, weft_stage_result result,
                   uint8_t report[WEFT_REPORT_SIZE])
{
    weft_stage_reply reply = {.command = request->command,
                              .sequence = request->sequence,
                              .result = result,
                              .state = f->state,
                              .fault = f->fault,
                              .fault_axis = f->fault_axis,
                              .axis_count = (uint8_t)f->hardware.axis_count,
                              .boot = f->boot,
                              .disturbances = f->disturbances,
                              .pulses = f->pulses,
                              .level = f->level,
                              .lamp = f->lamp};
    for (int axis = 0; axis < f->hardware.axis_count; axis++) {
        reply.position[axis] = position_of(f, axis);
        reply.homed = (uint8_t)(reply.homed | f->axis[axis].homed << axis);
    }
    weft_stage_reply_pack(&reply, report);
}

/* A request that comes again was heard, but its answer was not. A greeting always begins anew. */
static bool is_repeated(const weft_firmware *f, const weft_stage_request *request)
{
    return f->heard && request->sequence == f->last_sequence && request->command != WEFT_COMMAND_HELLO;
}

void weft_firmware_receive(weft_firmware *f, const uint8_t report[WEFT_REPORT_SIZE], uint32_t now_ms,
                           uint8_t reply[WEFT_REPORT_SIZE])
{
    weft_stage_request request;
    weft_stage_result result = weft_stage_request_unpack(report, &request);
    if (result == WEFT_RESULT_DONE) {
        f->heard_ms = now_ms;
        result = is_repeated(f, &request) ? f->last_result : carry_out(f, &request, now_ms);
        f->heard = true;
        f->last_sequence = request.sequence;
        f->last_result = result;
    }
    answer(f, &request, result, reply);
}

void weft_firmware_boot(weft_firmware *f, const weft_firmware_hardware *hardware, uint32_t boot)
{
    memset(f, 0, sizeof *f);
    f->hardware = *hardware;
    f->boot = boot;
    f->lamp = WEFT_PROTOCOL_NO_LAMP;
    for (int axis = 0; axis < hardware->axis_count; axis++) {
        f->axis[axis].low = hardware->low[axis];
        f->axis[axis].high = hardware->high[axis];
    }
    rest_all(f, WEFT_STATE_IDLE);
    hardware->light(hardware->context, WEFT_PROTOCOL_NO_LAMP, 0);
    hardware->shutter(hardware->context, false);
}

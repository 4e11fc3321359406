#include "capture/firmware/protocol.h"

#include <string.h>

/* Places in a report. */
enum { VERSION, COMMAND, SEQUENCE, CRC = 60 };
enum { REQUEST_MASK = 4, REQUEST_NUMBER = 5, REQUEST_WORD = 6, VALUES = 8 };
enum {
    REPLY_RESULT = 4,
    REPLY_STATE = 5,
    REPLY_FAULT = 6,
    REPLY_FAULT_AXIS = 7,
    REPLY_BOOT = 40,
    REPLY_AXIS_COUNT = 44,
    REPLY_HOMED = 45,
    REPLY_DISTURBANCES = 46,
    REPLY_PULSES = 48,
    REPLY_LEVEL = 50,
    REPLY_LAMP = 52
};
enum { REPLY_BIT = 0x80 };

static void put(uint8_t *at, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        at[i] = (uint8_t)(value >> 8 * i);
}

static uint32_t get(const uint8_t *at, int bytes)
{
    uint32_t value = 0;
    for (int i = 0; i < bytes; i++)
        value |= (uint32_t)at[i] << 8 * i;
    return value;
}

static void put_positions(uint8_t *report, const int32_t *position)
{
    for (int axis = 0; axis < WEFT_PROTOCOL_AXES; axis++)
        put(report + VALUES + 4 * axis, (uint32_t)position[axis], 4);
}

static void get_positions(const uint8_t *report, int32_t *position)
{
    for (int axis = 0; axis < WEFT_PROTOCOL_AXES; axis++)
        position[axis] = (int32_t)get(report + VALUES + 4 * axis, 4);
}

/* Reflected, polynomial 0x04c11db7; bit by bit, for small controllers. */
static uint32_t crc_of(const uint8_t *report)
{
    uint32_t crc = 0xffffffffu;
    for (int i = 0; i < CRC; i++) {
        crc ^= report[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

static void begin(uint8_t *report, uint8_t command, uint16_t sequence)
{
    memset(report, 0, WEFT_REPORT_SIZE);
    report[VERSION] = WEFT_PROTOCOL_VERSION;
    report[COMMAND] = command;
    put(report + SEQUENCE, sequence, 2);
}

static void end(uint8_t *report)
{
    put(report + CRC, crc_of(report), 4);
}

static weft_stage_result check(const uint8_t *report)
{
    if (get(report + CRC, 4) != crc_of(report))
        return WEFT_RESULT_BAD_CRC;
    return report[VERSION] == WEFT_PROTOCOL_VERSION ? WEFT_RESULT_DONE : WEFT_RESULT_BAD_VERSION;
}

void weft_stage_request_pack(const weft_stage_request *request, uint8_t report[WEFT_REPORT_SIZE])
{
    begin(report, (uint8_t)request->command, request->sequence);
    report[REQUEST_MASK] = request->mask;
    report[REQUEST_NUMBER] = request->number;
    put(report + REQUEST_WORD, request->word, 2);
    put_positions(report, request->value);
    end(report);
}

weft_stage_result weft_stage_request_unpack(const uint8_t report[WEFT_REPORT_SIZE], weft_stage_request *request)
{
    *request = (weft_stage_request){.command = (weft_stage_command)report[COMMAND],
                                    .sequence = (uint16_t)get(report + SEQUENCE, 2),
                                    .mask = report[REQUEST_MASK],
                                    .number = report[REQUEST_NUMBER],
                                    .word = (uint16_t)get(report + REQUEST_WORD, 2)};
    get_positions(report, request->value);
    return check(report);
}

void weft_stage_reply_pack(const weft_stage_reply *reply, uint8_t report[WEFT_REPORT_SIZE])
{
    begin(report, (uint8_t)(reply->command | REPLY_BIT), reply->sequence);
    report[REPLY_RESULT] = (uint8_t)reply->result;
    report[REPLY_STATE] = (uint8_t)reply->state;
    report[REPLY_FAULT] = (uint8_t)reply->fault;
    report[REPLY_FAULT_AXIS] = reply->fault_axis;
    put_positions(report, reply->position);
    put(report + REPLY_BOOT, reply->boot, 4);
    report[REPLY_AXIS_COUNT] = reply->axis_count;
    report[REPLY_HOMED] = reply->homed;
    put(report + REPLY_DISTURBANCES, reply->disturbances, 2);
    put(report + REPLY_PULSES, reply->pulses, 2);
    put(report + REPLY_LEVEL, reply->level, 2);
    report[REPLY_LAMP] = reply->lamp;
    end(report);
}

weft_stage_result weft_stage_reply_unpack(const uint8_t report[WEFT_REPORT_SIZE], weft_stage_reply *reply)
{
    *reply = (weft_stage_reply){.command = (weft_stage_command)(report[COMMAND] & ~REPLY_BIT),
                                .sequence = (uint16_t)get(report + SEQUENCE, 2),
                                .result = (weft_stage_result)report[REPLY_RESULT],
                                .state = (weft_stage_state)report[REPLY_STATE],
                                .fault = (weft_stage_fault)report[REPLY_FAULT],
                                .fault_axis = report[REPLY_FAULT_AXIS],
                                .axis_count = report[REPLY_AXIS_COUNT],
                                .homed = report[REPLY_HOMED],
                                .boot = get(report + REPLY_BOOT, 4),
                                .disturbances = (uint16_t)get(report + REPLY_DISTURBANCES, 2),
                                .pulses = (uint16_t)get(report + REPLY_PULSES, 2),
                                .level = (uint16_t)get(report + REPLY_LEVEL, 2),
                                .lamp = report[REPLY_LAMP]};
    get_positions(report, reply->position);
    /* A request is no reply, however good its checksum. */
    return report[COMMAND] & REPLY_BIT ? check(report) : WEFT_RESULT_BAD_CRC;
}

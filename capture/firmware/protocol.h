/* What a computer and the controller of a stage say to each other: reports of 64 bytes over USB HID
 * (docs/reference/stage-protocol.md). Plain C without any library: the firmware and its host share this header.
 *
 * The host asks, the controller answers; it never speaks unasked. Numbers are little-endian. Every report ends with the
 * CRC-32 (IEEE 802.3, as zlib computes it) of the 60 bytes before. A request that is sent again with its sequence
 * number is answered again and carried out once. */
#ifndef WEFT_CAPTURE_FIRMWARE_PROTOCOL_H
#define WEFT_CAPTURE_FIRMWARE_PROTOCOL_H

#include <stdbool.h>
#include <stdint.h>

enum {
    WEFT_REPORT_SIZE = 64,
    WEFT_PROTOCOL_VERSION = 1,
    WEFT_PROTOCOL_AXES = 8,
    WEFT_PROTOCOL_NO_LAMP = 255,
    WEFT_PROTOCOL_FULL_LEVEL = 65535
};

typedef enum weft_stage_command {
    WEFT_COMMAND_HELLO = 1, /* forgets the last sequence number; `word`: milliseconds of silence after which axes that
                               move stop, 0 = never */
    WEFT_COMMAND_STATUS,
    WEFT_COMMAND_LIMITS, /* axis `number`: soft limits value[0] to value[1] */
    WEFT_COMMAND_HOME,   /* the axes of `mask`, one after another */
    WEFT_COMMAND_MOVE,   /* the axes of `mask` to their values, together */
    WEFT_COMMAND_STOP,   /* all axes, at once */
    WEFT_COMMAND_LIGHT,  /* lamp `number` alone at level `word`; WEFT_PROTOCOL_NO_LAMP: all off */
    WEFT_COMMAND_SHUTTER /* a pulse of `word` milliseconds */
} weft_stage_command;

typedef enum weft_stage_result {
    WEFT_RESULT_DONE, /* or begun */
    WEFT_RESULT_BAD_CRC,
    WEFT_RESULT_BAD_VERSION,
    WEFT_RESULT_BAD_COMMAND, /* unknown, or with an axis or lamp that there is not */
    WEFT_RESULT_BEYOND_LIMIT,
    WEFT_RESULT_NOT_HOMED,
    WEFT_RESULT_BUSY /* axes move */
} weft_stage_result;

typedef enum weft_stage_state {
    WEFT_STATE_IDLE,
    WEFT_STATE_HOMING,
    WEFT_STATE_MOVING,
    WEFT_STATE_STOPPED, /* before the axes arrived; they know where they are */
    WEFT_STATE_FAULT    /* the axes must be homed again */
} weft_stage_state;

typedef enum weft_stage_fault {
    WEFT_FAULT_NONE,
    WEFT_FAULT_STALLED,     /* driven, but does not turn */
    WEFT_FAULT_LIMIT,       /* a limit switch was hit */
    WEFT_FAULT_NO_REFERENCE /* homing did not find the switch */
} weft_stage_fault;

/* Positions are thousandths of a degree. */
typedef struct weft_stage_request {
    weft_stage_command command;
    uint16_t sequence;
    uint8_t mask, number;
    uint16_t word;
    int32_t value[WEFT_PROTOCOL_AXES];
} weft_stage_request;

typedef struct weft_stage_reply {
    weft_stage_command command;
    uint16_t sequence;
    weft_stage_result result;
    weft_stage_state state;
    weft_stage_fault fault;
    uint8_t fault_axis, axis_count, homed; /* homed: a mask */
    int32_t position[WEFT_PROTOCOL_AXES];
    uint32_t boot;         /* another number after every start of the controller */
    uint16_t disturbances; /* times that an axis at rest was found elsewhere */
    uint16_t pulses;       /* of the shutter, since the start */
    uint16_t level;
    uint8_t lamp;
} weft_stage_reply;

void weft_stage_request_pack(const weft_stage_request *request, uint8_t report[WEFT_REPORT_SIZE]);
void weft_stage_reply_pack(const weft_stage_reply *reply, uint8_t report[WEFT_REPORT_SIZE]);

/* WEFT_RESULT_DONE, _BAD_CRC or _BAD_VERSION. After _BAD_VERSION the sequence number is still good, nothing else. */
weft_stage_result weft_stage_request_unpack(const uint8_t report[WEFT_REPORT_SIZE], weft_stage_request *request);
weft_stage_result weft_stage_reply_unpack(const uint8_t report[WEFT_REPORT_SIZE], weft_stage_reply *reply);

#endif

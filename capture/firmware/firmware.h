/* The controller of a stage, without its hardware: portable C for a small processor, to be built with the functions
 * that read encoders and drive motors. Allocates nothing, waits for nothing, uses no floating point.
 *
 * The main loop calls weft_firmware_tick every millisecond or so, and weft_firmware_receive for each report from USB.
 * Times are milliseconds of a clock that may wrap. Positions are thousandths of a degree. */
#ifndef WEFT_CAPTURE_FIRMWARE_FIRMWARE_H
#define WEFT_CAPTURE_FIRMWARE_FIRMWARE_H

#include "capture/firmware/protocol.h"

/* What a board must provide. */
typedef struct weft_firmware_hardware {
    void *context;
    int axis_count, lamp_count;
    int32_t low[WEFT_PROTOCOL_AXES], high[WEFT_PROTOCOL_AXES]; /* where an axis may stand */
    int32_t reference[WEFT_PROTOCOL_AXES];       /* where its reference switch closes, coming from above */
    int32_t speed[WEFT_PROTOCOL_AXES];           /* thousandths of a degree a second */
    int32_t touch_speed[WEFT_PROTOCOL_AXES];     /* onto the reference switch, which says where it is */
    int32_t (*encoder)(void *context, int axis); /* counts from where the axis stood at power-on */
    void (*drive)(void *context, int axis, int32_t speed);
    bool (*at_reference)(void *context, int axis);
    bool (*at_limit)(void *context, int axis);
    void (*light)(void *context, int lamp, uint16_t level); /* lamp WEFT_PROTOCOL_NO_LAMP: all off */
    void (*shutter)(void *context, bool closed);            /* the contact of its cable */
} weft_firmware_hardware;

/* Down to the switch, back off it, and slowly down onto it: so always from the same side at the same speed. */
typedef enum weft_homing_phase { WEFT_HOMING_SEEK, WEFT_HOMING_BACK, WEFT_HOMING_TOUCH } weft_homing_phase;

typedef struct weft_firmware_axis {
    int32_t offset; /* position = encoder + offset */
    int32_t target, low, high, rest;
    bool homed, moving, displaced;
    weft_homing_phase phase;
    int32_t watched;     /* position when progress was last seen */
    uint32_t watched_ms; /* and the time */
} weft_firmware_axis;

typedef struct weft_firmware {
    weft_firmware_hardware hardware;
    weft_firmware_axis axis[WEFT_PROTOCOL_AXES];
    weft_stage_state state;
    weft_stage_fault fault;
    uint8_t fault_axis;
    uint8_t to_home; /* mask of what is left */
    uint32_t boot;
    uint16_t disturbances, pulses, level;
    uint8_t lamp;
    bool heard, shutter_closed;
    uint16_t last_sequence;
    weft_stage_result last_result;
    uint32_t heard_ms, silence_ms, shutter_ms, homing_ms; /* silence_ms 0: no watchdog */
} weft_firmware;

/* After power-on: nothing is homed, all is at rest. `boot` must differ from start to start. */
void weft_firmware_boot(weft_firmware *firmware, const weft_firmware_hardware *hardware, uint32_t boot);

/* Carries out a request and fills in the reply. */
void weft_firmware_receive(weft_firmware *firmware, const uint8_t request[WEFT_REPORT_SIZE], uint32_t now_ms,
                           uint8_t reply[WEFT_REPORT_SIZE]);

void weft_firmware_tick(weft_firmware *firmware, uint32_t now_ms);

#endif

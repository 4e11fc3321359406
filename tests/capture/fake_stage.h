/* A stage that is not there: motors, gears with backlash, switches and lamps in a time of their own, driven by the real
 * firmware; and what can go wrong with it. Time passes with the reports that it gets. */
#ifndef WEFT_TESTS_CAPTURE_FAKE_STAGE_H
#define WEFT_TESTS_CAPTURE_FAKE_STAGE_H

#include "capture/firmware/firmware.h"

#include <pthread.h>

enum { FAKE_AXES = 4, FAKE_LAMPS = 3, FAKE_MS_PER_REPORT = 300 };

/* How far the gears lag behind the motors when they last turned up, degrees. */
extern const double fake_backlash_deg;

typedef enum fake_fault {
    FAKE_NOTHING,
    FAKE_LATE,      /* the answer comes with the next one */
    FAKE_LOST,      /* it does not come */
    FAKE_DOUBLED,   /* it comes twice */
    FAKE_BROKEN,    /* a bit of it is flipped */
    FAKE_STALE,     /* the one before comes instead */
    FAKE_DEAF,      /* a bit of the question is flipped */
    FAKE_STALLED,   /* an axis does not turn */
    FAKE_LIMIT,     /* a limit switch closes */
    FAKE_UNPLUGGED, /* and plugged in again; the motors have their own power */
    FAKE_RESTARTED, /* unplugged, with all its power */
    FAKE_FAULTS
} fake_fault;

/* Answers that leave the device, at most a late one and a double. */
typedef struct fake_answers {
    int count;
    uint8_t report[3][WEFT_REPORT_SIZE];
} fake_answers;

typedef struct fake_stage {
    pthread_mutex_t mutex;
    pthread_cond_t changed; /* lamps, or whether the device is to be pulled */
    weft_firmware firmware;
    weft_firmware_hardware hardware;
    uint32_t now_ms, boot;
    double motor[FAKE_AXES], gear[FAKE_AXES]; /* degrees; where the gear is, the camera is */
    double speed[FAKE_AXES], power_on[FAKE_AXES];
    bool blocked[FAKE_AXES], limit[FAKE_AXES]; /* until the axes are homed */
    uint16_t level;
    int lamp, pulses;
    bool contact;
    fake_fault armed;
    int reports_to_fault;
    int injected[FAKE_FAULTS];
    uint64_t random;
    bool has_late;
    uint8_t late[WEFT_REPORT_SIZE], last[WEFT_REPORT_SIZE];
    bool unplug_wanted; /* the device is to be pulled now */
    fake_fault unplug_kind;
} fake_stage;

void fake_stage_start(fake_stage *stage);

/* A fault that strikes `reports` reports from now. */
void fake_stage_arm(fake_stage *stage, fake_fault fault, int reports);

/* Milliseconds pass, the firmware running. */
void fake_stage_pass(fake_stage *stage, int ms);

/* The firmware starts again: it knows nothing. */
void fake_stage_restart(fake_stage *stage);

/* What the device answers to a question, faults included. */
void fake_stage_ask(fake_stage *stage, const uint8_t question[WEFT_REPORT_SIZE], fake_answers *answers);

/* Waits until no lamp burns, however long that takes. */
void fake_stage_wait_until_dark(fake_stage *stage);

/* Degrees at which the gear of an axis really stands. */
double fake_stage_truth(fake_stage *stage, int axis);

/* Somebody leans on an axis. */
void fake_stage_push(fake_stage *stage, int axis, double deg);

#endif

#include "tests/capture/fake_stage.h"

#include <math.h>
#include <string.h>

const double fake_backlash_deg = 0.2;

/* Where the reference switches close; motors are found elsewhere. */
static const double reference_deg[FAKE_AXES] = {-3, -4, -2.5, -3.5};

/* ---- Hardware ---- */

static int32_t encoder(void *context, int axis)
{
    fake_stage *stage = context;
    return (int32_t)lround((stage->motor[axis] - stage->power_on[axis]) * 1e3);
}

static void drive(void *context, int axis, int32_t speed)
{
    ((fake_stage *)context)->speed[axis] = speed * 1e-3;
}

static bool at_reference(void *context, int axis)
{
    return ((fake_stage *)context)->gear[axis] <= reference_deg[axis];
}

static bool at_limit(void *context, int axis)
{
    return ((fake_stage *)context)->limit[axis];
}

static void light(void *context, int lamp, uint16_t level)
{
    fake_stage *stage = context;
    stage->lamp = lamp == WEFT_PROTOCOL_NO_LAMP ? -1 : lamp;
    stage->level = level;
    pthread_cond_broadcast(&stage->changed);
}

static void shutter(void *context, bool closed)
{
    fake_stage *stage = context;
    stage->pulses += closed && !stage->contact;
    stage->contact = closed;
}

/* A gear follows its motor once the play between their teeth is used up. */
static void turn(fake_stage *stage, double seconds)
{
    for (int axis = 0; axis < FAKE_AXES; axis++) {
        if (!stage->blocked[axis])
            stage->motor[axis] += stage->speed[axis] * seconds;
        stage->gear[axis] = fmin(fmax(stage->gear[axis], stage->motor[axis] - fake_backlash_deg), stage->motor[axis]);
    }
}

static void pass(fake_stage *stage, int ms)
{
    for (int i = 0; i < ms; i++) {
        turn(stage, 1e-3);
        weft_firmware_tick(&stage->firmware, ++stage->now_ms);
    }
}

/* ---- Starting ---- */

static void restart(fake_stage *stage)
{
    for (int axis = 0; axis < FAKE_AXES; axis++) {
        stage->speed[axis] = 0;
        stage->power_on[axis] = stage->motor[axis];
        stage->blocked[axis] = stage->limit[axis] = false;
    }
    weft_firmware_boot(&stage->firmware, &stage->hardware, ++stage->boot);
}

void fake_stage_start(fake_stage *stage)
{
    *stage = (fake_stage){.random = 99, .boot = 1000, .now_ms = 0xffffff00u /* soon wraps */};
    pthread_mutex_init(&stage->mutex, NULL);
    pthread_cond_init(&stage->changed, NULL);
    stage->hardware = (weft_firmware_hardware){.context = stage,
                                               .axis_count = FAKE_AXES,
                                               .lamp_count = FAKE_LAMPS,
                                               .encoder = encoder,
                                               .drive = drive,
                                               .at_reference = at_reference,
                                               .at_limit = at_limit,
                                               .light = light,
                                               .shutter = shutter};
    for (int axis = 0; axis < FAKE_AXES; axis++) {
        stage->motor[axis] = stage->gear[axis] = 20 + 30 * axis;
        stage->hardware.low[axis] = -2000;
        stage->hardware.high[axis] = axis % 2 ? 365000 : 90000;
        stage->hardware.reference[axis] = (int32_t)lround(reference_deg[axis] * 1e3);
        stage->hardware.speed[axis] = 1000000;
        stage->hardware.touch_speed[axis] = 4000;
    }
    restart(stage);
}

void fake_stage_restart(fake_stage *stage)
{
    pthread_mutex_lock(&stage->mutex);
    restart(stage);
    pthread_mutex_unlock(&stage->mutex);
}

void fake_stage_pass(fake_stage *stage, int ms)
{
    pthread_mutex_lock(&stage->mutex);
    pass(stage, ms);
    pthread_mutex_unlock(&stage->mutex);
}

/* ---- Faults ---- */

static unsigned random_below(fake_stage *stage, unsigned limit)
{
    stage->random = stage->random * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(stage->random >> 33) % limit;
}

static void flip(fake_stage *stage, uint8_t *report)
{
    unsigned bit = random_below(stage, 8 * WEFT_REPORT_SIZE);
    report[bit / 8] ^= (uint8_t)(1u << bit % 8);
}

void fake_stage_arm(fake_stage *stage, fake_fault fault, int reports)
{
    pthread_mutex_lock(&stage->mutex);
    stage->armed = fault;
    stage->reports_to_fault = reports;
    pthread_mutex_unlock(&stage->mutex);
}

static fake_fault due(fake_stage *stage)
{
    if (stage->armed == FAKE_NOTHING || stage->reports_to_fault-- > 0)
        return FAKE_NOTHING;
    fake_fault fault = stage->armed;
    stage->armed = FAKE_NOTHING;
    stage->injected[fault]++;
    return fault;
}

static void strike(fake_stage *stage, fake_fault fault)
{
    int axis = (int)random_below(stage, FAKE_AXES);
    if (fault == FAKE_STALLED)
        stage->blocked[axis] = true;
    if (fault == FAKE_LIMIT)
        stage->limit[axis] = true;
    if (fault == FAKE_UNPLUGGED || fault == FAKE_RESTARTED) {
        stage->unplug_wanted = true;
        stage->unplug_kind = fault;
        pthread_cond_broadcast(&stage->changed);
    }
}

static void add(fake_answers *answers, const uint8_t *report)
{
    memcpy(answers->report[answers->count++], report, WEFT_REPORT_SIZE);
}

static void deliver(fake_stage *stage, fake_fault fault, uint8_t *reply, fake_answers *answers)
{
    uint8_t before[WEFT_REPORT_SIZE];
    memcpy(before, stage->last, sizeof before);
    memcpy(stage->last, reply, sizeof before);
    if (stage->has_late)
        add(answers, stage->late);
    stage->has_late = fault == FAKE_LATE;
    if (fault == FAKE_LATE)
        memcpy(stage->late, reply, sizeof stage->late);
    if (fault == FAKE_BROKEN)
        flip(stage, reply);
    if (fault == FAKE_STALE)
        memcpy(reply, before, sizeof before);
    bool comes = fault != FAKE_LATE && fault != FAKE_LOST && fault != FAKE_UNPLUGGED && fault != FAKE_RESTARTED;
    if (comes)
        add(answers, reply);
    if (fault == FAKE_DOUBLED)
        add(answers, reply);
}

void fake_stage_ask(fake_stage *stage, const uint8_t question[WEFT_REPORT_SIZE], fake_answers *answers)
{
    uint8_t heard[WEFT_REPORT_SIZE], reply[WEFT_REPORT_SIZE];
    memcpy(heard, question, sizeof heard);
    answers->count = 0;
    pthread_mutex_lock(&stage->mutex);
    fake_fault fault = due(stage);
    strike(stage, fault);
    if (fault == FAKE_DEAF)
        flip(stage, heard);
    if (heard[1] == WEFT_COMMAND_HOME)
        for (int axis = 0; axis < FAKE_AXES; axis++)
            stage->blocked[axis] = stage->limit[axis] = false;
    pass(stage, FAKE_MS_PER_REPORT);
    weft_firmware_receive(&stage->firmware, heard, stage->now_ms, reply);
    deliver(stage, fault, reply, answers);
    pthread_mutex_unlock(&stage->mutex);
}

/* ---- Truth ---- */

void fake_stage_wait_until_dark(fake_stage *stage)
{
    pthread_mutex_lock(&stage->mutex);
    while (stage->level != 0)
        pthread_cond_wait(&stage->changed, &stage->mutex);
    pthread_mutex_unlock(&stage->mutex);
}

double fake_stage_truth(fake_stage *stage, int axis)
{
    pthread_mutex_lock(&stage->mutex);
    double deg = stage->gear[axis];
    pthread_mutex_unlock(&stage->mutex);
    return deg;
}

void fake_stage_push(fake_stage *stage, int axis, double deg)
{
    pthread_mutex_lock(&stage->mutex);
    stage->motor[axis] += deg;
    pass(stage, 5);
    pthread_mutex_unlock(&stage->mutex);
}

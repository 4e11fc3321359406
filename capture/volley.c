#include "capture/volley.h"

#include <pthread.h>

/* ---- All at once ---- */

/* What one camera does while the lamp burns. */
typedef weft_code camera_job(weft_exposing *exposing, weft_error *error);

typedef struct errand {
    weft_exposing *exposing;
    camera_job *job;
    pthread_t thread;
    bool has_thread;
} errand;

static void *run(void *context)
{
    errand *e = context;
    e->exposing->code = e->job(e->exposing, &e->exposing->error);
    return NULL;
}

/* Those that are wanted, each in a thread of its own but for the first. */
static void run_all(weft_exposing *exposing, int count, camera_job *job)
{
    errand errands[WEFT_CAMERAS_MAX];
    int wanted = 0;
    for (int i = 0; i < count; i++) {
        if (exposing[i].wanted)
            errands[wanted++] = (errand){.exposing = &exposing[i], .job = job};
    }
    for (int i = 1; i < wanted; i++)
        errands[i].has_thread = pthread_create(&errands[i].thread, NULL, run, &errands[i]) == 0;
    for (int i = 0; i < wanted; i++) {
        if (!errands[i].has_thread)
            run(&errands[i]);
    }
    for (int i = 1; i < wanted; i++) {
        if (errands[i].has_thread)
            pthread_join(errands[i].thread, NULL);
    }
}

/* Under the lamp, which all share. */
static weft_code run_lit(weft_exposing *exposing, int count, camera_job *job, bool *held, weft_error *error)
{
    weft_rig *rig = exposing[0].shooting->rig;
    weft_rig_stage *stage = &rig->stage;
    *held = true;
    WEFT_TRY(rig->light.power(rig->light.device, true, error));
    run_all(exposing, count, job);
    WEFT_TRY(rig->light.power(rig->light.device, false, error));
    return stage->held ? stage->held(stage->device, held, error) : WEFT_OK;
}

static bool all_failed(const weft_exposing *exposing, int count)
{
    int failed = 0;
    for (int i = 0; i < count; i++)
        failed += exposing[i].code != WEFT_OK;
    return failed == count;
}

/* Whether there is nothing to go on with: then nothing moves on and nothing burns on. */
static bool is_lost(const weft_exposing *exposing, int count)
{
    if (!all_failed(exposing, count))
        return false;
    weft_shooting_halt(exposing[0].shooting, exposing[0].code);
    return true;
}

/* ---- The first photographs ---- */

static weft_code meter_and_expose(weft_exposing *e, weft_error *error)
{
    return weft_shooting_meter_and_expose(e->shooting, e->shot, e->samples, &e->read_back_s, error);
}

static weft_code take_once(weft_exposing *exposing, int count, bool *held, weft_error *error)
{
    for (int i = 0; i < count; i++) {
        exposing[i].code = WEFT_OK;
        exposing[i].wanted = true;
        WEFT_TRY(weft_shooting_drive(exposing[i].shooting, exposing[i].shot, error));
    }
    return run_lit(exposing, count, meter_and_expose, held, error);
}

weft_code weft_volley_fail_disturbed(const weft_exposing *exposing, int times, weft_error *error)
{
    return weft_shooting_halt(exposing->shooting,
                              weft_fail(error, WEFT_SYSTEM, "the stage did not keep its pose during shot %d, %d times",
                                        exposing->shot, times));
}

static weft_code take_in_pose(weft_exposing *exposing, int count, weft_error *error)
{
    int retries = exposing[0].shooting->retries;
    for (int attempt = 0; attempt <= retries; attempt++) {
        bool held = true;
        WEFT_TRY(weft_shooting_halt(exposing[0].shooting, take_once(exposing, count, &held, error)));
        if (held || all_failed(exposing, count))
            return WEFT_OK;
        for (int i = 0; i < count; i++)
            exposing[i].shooting->disturbed++;
    }
    return weft_volley_fail_disturbed(&exposing[0], retries + 1, error);
}

weft_code weft_volley_take(weft_exposing *exposing, int count, weft_error *error)
{
    WEFT_TRY(take_in_pose(exposing, count, error));
    if (is_lost(exposing, count))
        return WEFT_OK;
    for (int i = 0; i < count; i++) {
        weft_exposing *e = &exposing[i];
        e->record = (weft_shot_record){.viewpoint = e->shooting->viewpoint, .exposure_s = e->read_back_s};
    }
    return WEFT_OK;
}

/* ---- Brackets ---- */

static double last_exposure(const weft_exposing *e)
{
    int count = e->record.bracket_count;
    return count > 0 ? e->record.bracket[count - 1].exposure_s : e->record.exposure_s;
}

static weft_code expose_behind(weft_exposing *e, weft_error *error)
{
    const weft_camera *camera = &e->shooting->session->camera;
    size_t size = (size_t)camera->width * (size_t)camera->height * 3;
    uint16_t *behind = e->samples + ((size_t)e->record.bracket_count + 1) * size;
    return weft_shooting_expose(e->shooting, e->shot, e->exposure_s, behind, &e->read_back_s, error);
}

/* Returns how many cameras need another photograph. */
static int choose_exposures(weft_exposing *exposing, int count, int most)
{
    int needed = 0;
    for (int i = 0; i < count; i++) {
        weft_exposing *e = &exposing[i];
        const weft_shooting *s = e->shooting;
        bool may = e->code == WEFT_OK && e->record.bracket_count < most;
        e->exposure_s = may ? weft_exposure_of_bracket(&s->meter, s->session, e->samples, &e->record, s->limits) : 0;
        e->wanted = e->exposure_s > 0;
        needed += e->wanted;
    }
    return needed;
}

weft_code weft_volley_bracket(weft_exposing *exposing, int count, int most, int *taken, bool *held, weft_error *error)
{
    *taken = 0;
    *held = true;
    if (choose_exposures(exposing, count, most) == 0)
        return WEFT_OK;
    WEFT_TRY(weft_shooting_halt(exposing[0].shooting, run_lit(exposing, count, expose_behind, held, error)));
    if (is_lost(exposing, count))
        return WEFT_OK;
    for (int i = 0; i < count; i++) {
        weft_exposing *e = &exposing[i];
        e->wanted = e->wanted && e->code == WEFT_OK && *held && e->read_back_s != last_exposure(e);
        if (e->wanted)
            e->record.bracket[e->record.bracket_count++].exposure_s = e->read_back_s;
        *taken += e->wanted;
    }
    return WEFT_OK;
}

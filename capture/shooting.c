#include "capture/shooting.h"

#include <pthread.h>

/* At most MAX_METERED exposures of a shot, each retried; frames are numbered FRAMES_PER_SHOT x shot + exposure. */
enum { MAX_METERED = 8, FRAMES_PER_SHOT = 256 };

/* Returns `code`. Whatever has failed, nothing moves on and nothing burns on. */
static weft_code halt(weft_shooting *shooting, weft_code code)
{
    weft_rig *rig = shooting->rig;
    if (code == WEFT_OK)
        return code;
    if (rig->stage.stop)
        rig->stage.stop(rig->stage.device);
    rig->light.power(rig->light.device, false, NULL);
    return code;
}

weft_code weft_shooting_begin(weft_rig *rig, const weft_session *session, int next_viewpoint, weft_shooting *shooting,
                              weft_error *error)
{
    const weft_rig_settings *settings = &rig->settings;
    *shooting = (weft_shooting){.rig = rig,
                                .session = session,
                                .limits = {settings->shortest_exposure_s, settings->longest_exposure_s},
                                .retries = (int)settings->retries,
                                .viewpoint = -1,
                                .next_viewpoint = next_viewpoint};
    return halt(shooting, rig->stage.home(rig->stage.device, next_viewpoint, error));
}

void weft_shooting_end(weft_shooting *shooting)
{
    weft_meter_free(&shooting->meter);
}

/* Takes up the pose of a shot; the meter is that of its view. */
static weft_code drive(weft_shooting *shooting, int number, weft_error *error)
{
    const weft_shot *shot = &shooting->session->shot[number];
    weft_rig_stage *stage = &shooting->rig->stage;
    bool moved = false;
    WEFT_TRY(stage->move(stage->device, shot->view, shot->light_driven, &moved, error));
    if (!moved)
        return WEFT_OK;
    shooting->viewpoint = shooting->next_viewpoint++;
    weft_meter_free(&shooting->meter);
    return weft_meter_make(shooting->session, shot->view, &shooting->meter, error);
}

/* The exposure of the last shot, corrected by the change of the light's cosine. */
static double predict_exposure(weft_shooting *shooting, const weft_shot *shot)
{
    const double first_guess_s = 1.0 / 60, lowest_cosine = 0.02;
    weft_real cosine = fmax(cos(shot->light_driven.theta_rad), lowest_cosine);
    double exposure_s =
        shooting->exposure_s > 0 ? shooting->exposure_s * shooting->light_cosine / cosine : first_guess_s / cosine;
    shooting->light_cosine = cosine;
    /* Up to the nearest third stop. */
    return weft_exposure_in_thirds(exposure_s * exp2(1 / 6.0), shooting->limits);
}

/* One exposure, repeated where the camera does not deliver it. */
static weft_code expose(weft_shooting *shooting, int shot, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    weft_rig_camera *camera = &shooting->rig->camera;
    weft_code code = WEFT_SYSTEM;
    for (int attempt = 0; attempt <= shooting->retries; attempt++) {
        uint64_t frame = (uint64_t)shot * FRAMES_PER_SHOT + (uint64_t)shooting->frames++;
        shooting->last_frame = frame;
        shooting->exposures++;
        code = camera->expose(camera->device, frame, exposure_s, samples, read_back_s, error);
        if (code == WEFT_OK)
            return WEFT_OK;
        shooting->timeouts++;
    }
    return code;
}

/* Exposes under the light that burns, until the exposure is right. */
static weft_code meter(weft_shooting *shooting, int shot, uint16_t *samples, double *read_back_s, weft_error *error)
{
    double exposure_s = predict_exposure(shooting, &shooting->session->shot[shot]), before_s = 0;
    shooting->frames = 0;
    for (int metered = 0; metered < MAX_METERED; metered++) {
        WEFT_TRY(expose(shooting, shot, exposure_s, samples, read_back_s, error));
        double taken_s = weft_exposure_taken(exposure_s, *read_back_s);
        double level = weft_meter_read(&shooting->meter, shooting->session, samples);
        exposure_s = weft_exposure_after(taken_s, level, shooting->limits);
        shooting->exposure_s = taken_s;
        if (exposure_s == taken_s || taken_s == before_s)
            break;
        before_s = taken_s;
    }
    return WEFT_OK;
}

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
    halt(exposing[0].shooting, exposing[0].code);
    return true;
}

/* ---- The first photographs ---- */

static weft_code meter_and_expose(weft_exposing *e, weft_error *error)
{
    return meter(e->shooting, e->shot, e->samples, &e->read_back_s, error);
}

static weft_code take_once(weft_exposing *exposing, int count, bool *held, weft_error *error)
{
    for (int i = 0; i < count; i++) {
        exposing[i].code = WEFT_OK;
        exposing[i].wanted = true;
        WEFT_TRY(drive(exposing[i].shooting, exposing[i].shot, error));
    }
    return run_lit(exposing, count, meter_and_expose, held, error);
}

weft_code weft_shot_fail_disturbed(const weft_exposing *exposing, int times, weft_error *error)
{
    return halt(exposing->shooting,
                weft_fail(error, WEFT_SYSTEM, "the stage did not keep its pose during shot %d, %d times",
                          exposing->shot, times));
}

static weft_code take_in_pose(weft_exposing *exposing, int count, weft_error *error)
{
    int retries = exposing[0].shooting->retries;
    for (int attempt = 0; attempt <= retries; attempt++) {
        bool held = true;
        WEFT_TRY(halt(exposing[0].shooting, take_once(exposing, count, &held, error)));
        if (held || all_failed(exposing, count))
            return WEFT_OK;
        for (int i = 0; i < count; i++)
            exposing[i].shooting->disturbed++;
    }
    return weft_shot_fail_disturbed(&exposing[0], retries + 1, error);
}

weft_code weft_shot_take(weft_exposing *exposing, int count, weft_error *error)
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
    return expose(e->shooting, e->shot, e->exposure_s, behind, &e->read_back_s, error);
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

weft_code weft_shot_bracket(weft_exposing *exposing, int count, int most, int *taken, bool *held, weft_error *error)
{
    *taken = 0;
    *held = true;
    if (choose_exposures(exposing, count, most) == 0)
        return WEFT_OK;
    WEFT_TRY(halt(exposing[0].shooting, run_lit(exposing, count, expose_behind, held, error)));
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

weft_code weft_shooting_take(weft_shooting *shooting, int shot, uint16_t *samples, weft_shot_record *record,
                             weft_error *error)
{
    weft_exposing alone = {.shooting = shooting, .shot = shot, .samples = samples};
    WEFT_TRY(weft_shot_take(&alone, 1, error));
    if (alone.code != WEFT_OK && error)
        *error = alone.error;
    *record = alone.record;
    return alone.code;
}

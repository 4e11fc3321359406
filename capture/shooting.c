#include "capture/shooting.h"

#include "capture/volley.h"

/* At most MAX_METERED exposures of a shot, each retried; frames are numbered FRAMES_PER_SHOT x shot + exposure. */
enum { MAX_METERED = 8, FRAMES_PER_SHOT = 256 };

weft_code weft_shooting_halt(weft_shooting *shooting, weft_code code)
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
    return weft_shooting_halt(shooting, rig->stage.home(rig->stage.device, next_viewpoint, error));
}

void weft_shooting_end(weft_shooting *shooting)
{
    weft_meter_free(&shooting->meter);
}

weft_code weft_shooting_drive(weft_shooting *shooting, int number, weft_error *error)
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

weft_code weft_shooting_expose(weft_shooting *shooting, int shot, double exposure_s, uint16_t *samples,
                               double *read_back_s, weft_error *error)
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

weft_code weft_shooting_meter_and_expose(weft_shooting *shooting, int shot, uint16_t *samples, double *read_back_s,
                                         weft_error *error)
{
    double exposure_s = predict_exposure(shooting, &shooting->session->shot[shot]), before_s = 0;
    shooting->frames = 0;
    for (int metered = 0; metered < MAX_METERED; metered++) {
        WEFT_TRY(weft_shooting_expose(shooting, shot, exposure_s, samples, read_back_s, error));
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

weft_code weft_shooting_take(weft_shooting *shooting, int shot, uint16_t *samples, weft_shot_record *record,
                             weft_error *error)
{
    weft_exposing alone = {.shooting = shooting, .shot = shot, .samples = samples};
    WEFT_TRY(weft_volley_take(&alone, 1, error));
    if (alone.code != WEFT_OK && error)
        *error = alone.error;
    *record = alone.record;
    return alone.code;
}

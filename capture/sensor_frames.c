#include "capture/shooting.h"

#include "capture/exposure.h"
#include "capture/photograph_writer.h"

#include <limits.h>
#include <stdlib.h>

/* Far from the numbers of all exposures of shots. */
static const uint64_t first_number = (uint64_t)1 << 40;

enum { NUMBERS_PER_FRAME = 512, MAX_METERED = 8 };

int weft_sensor_frames_missing(const weft_session *session)
{
    int missing = 0;
    for (int i = 0; i < weft_session_frame_count(session); i++)
        missing += !session->frame[i].taken;
    return missing;
}

typedef struct taking {
    weft_rig *rig;
    weft_session *session;
    weft_curtain scene; /* that the camera sees */
    double flat_s;      /* 0: not metered yet */
    uint16_t *samples;
} taking;

static weft_code show(taking *t, weft_curtain scene, weft_error *error)
{
    if (t->scene == scene)
        return WEFT_OK;
    WEFT_TRY(t->rig->curtain.show(t->rig->curtain.device, scene, error));
    t->scene = scene;
    return WEFT_OK;
}

/* Attempt `attempt` of frame `frame`, again where the camera does not deliver it. */
static weft_code expose(taking *t, int frame, int attempt, double exposure_s, double *read_back_s, weft_error *error)
{
    weft_rig_camera *camera = &t->rig->camera;
    uint64_t number = first_number + (uint64_t)frame * NUMBERS_PER_FRAME + (uint64_t)attempt;
    int retries = (int)t->rig->settings.retries;
    weft_code code = camera->expose(camera->device, number, exposure_s, t->samples, read_back_s, error);
    for (int i = 0; code != WEFT_OK && i < retries; i++)
        code = camera->expose(camera->device, ++number, exposure_s, t->samples, read_back_s, error);
    return code;
}

/* ---- The even field ---- */

/* A meter that looks at all there is. */
static weft_code make_meter(const weft_session *session, weft_meter *meter, weft_error *error)
{
    int pixels = session->camera.width * session->camera.height;
    *meter = (weft_meter){.opening_count = pixels, .opening = malloc((size_t)pixels * sizeof(int))};
    if (!meter->opening)
        return weft_fail_memory(error, "light meter", (size_t)pixels * sizeof(int));
    for (int i = 0; i < pixels; i++)
        meter->opening[i] = i;
    return WEFT_OK;
}

static weft_code meter_field(taking *t, int frame, const weft_meter *meter, weft_error *error)
{
    const weft_rig_settings *settings = &t->rig->settings;
    const weft_exposure_limits limits = {settings->shortest_exposure_s, settings->longest_exposure_s};
    double next_s = weft_exposure_in_thirds(1.0 / 60, limits), before_s = 0, read_back_s;
    for (int metered = 0; metered < MAX_METERED; metered++) {
        t->flat_s = next_s;
        WEFT_TRY(expose(t, frame, 32 * (metered + 1), t->flat_s, &read_back_s, error));
        double taken_s = weft_exposure_taken(t->flat_s, read_back_s);
        next_s = weft_exposure_after(taken_s, weft_meter_read(meter, t->session, t->samples), limits);
        if (next_s == taken_s || taken_s == before_s)
            break;
        before_s = taken_s;
    }
    return WEFT_OK;
}

static weft_code choose_flat_exposure(taking *t, int frame, weft_error *error)
{
    weft_meter meter;
    if (t->flat_s > 0)
        return WEFT_OK;
    weft_code code = make_meter(t->session, &meter, error);
    if (code == WEFT_OK)
        code = meter_field(t, frame, &meter, error);
    weft_meter_free(&meter);
    return code;
}

/* ---- Frames ---- */

static weft_code prepare(taking *t, int frame, double *exposure_s, weft_error *error)
{
    weft_frame_kind kind = weft_session_frame_kind(t->session, frame);
    WEFT_TRY(show(t, kind == WEFT_FRAME_FLAT ? WEFT_CURTAIN_EVEN : WEFT_CURTAIN_DARK, error));
    if (kind == WEFT_FRAME_FLAT)
        WEFT_TRY(choose_flat_exposure(t, frame, error));
    *exposure_s = kind == WEFT_FRAME_FLAT         ? t->flat_s
                  : kind == WEFT_FRAME_DARK_BRIEF ? t->rig->settings.shortest_exposure_s
                                                  : t->rig->settings.longest_exposure_s;
    return WEFT_OK;
}

static weft_code take_frame(taking *t, int frame, weft_error *error)
{
    weft_frame_record record = {0};
    char path[PATH_MAX];
    double exposure_s = 0;
    WEFT_TRY(prepare(t, frame, &exposure_s, error));
    WEFT_TRY(expose(t, frame, 0, exposure_s, &record.exposure_s, error));
    weft_session_frame_path(t->session, frame, path, sizeof path);
    WEFT_TRY(weft_photograph_store(t->session, path, t->samples, &record.bytes, &record.crc32, error));
    return weft_session_append_frame(t->session, frame, &record, error);
}

static weft_code take_all(taking *t, const volatile sig_atomic_t *stop, const weft_progress *progress,
                          weft_error *error)
{
    int count = weft_session_frame_count(t->session);
    for (int i = 0; i < count && !(stop && *stop); i++) {
        if (!t->session->frame[i].taken)
            WEFT_TRY(take_frame(t, i, error));
        weft_progress_report(progress, "looking at the sensor", i + 1, count);
    }
    return weft_session_sync(t->session, error);
}

weft_code weft_sensor_frames_take(weft_rig *rig, weft_session *session, const volatile sig_atomic_t *stop,
                                  const weft_progress *progress, weft_error *error)
{
    size_t bytes = (size_t)session->camera.width * (size_t)session->camera.height * 3 * sizeof(uint16_t);
    weft_error last = {0};
    if (weft_sensor_frames_missing(session) == 0)
        return WEFT_OK;
    taking t = {.rig = rig, .session = session, .scene = WEFT_CURTAIN_OPEN, .samples = malloc(bytes)};
    if (!t.samples)
        return weft_fail_memory(error, "photograph", bytes);
    weft_code code = rig->light.power(rig->light.device, false, error);
    if (code == WEFT_OK)
        code = take_all(&t, stop, progress, error);
    weft_code back = show(&t, WEFT_CURTAIN_OPEN, &last);
    free(t.samples);
    if (code == WEFT_OK && back != WEFT_OK && error)
        *error = last;
    return code != WEFT_OK ? code : back;
}

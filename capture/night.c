#include "capture/night.h"

#include "base/clock.h"
#include "capture/kept_file.h"
#include "capture/night_pages.h"
#include "capture/sensor_frames.h"
#include "capture/volley.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Failures in a row after which one of several cameras is left out: each has been retried, and may have waited long. */
enum { MOST_FAILURES = 3 };

typedef struct run {
    const weft_night *night;
    int camera_count;
    weft_camera_at_work *camera; /* [camera_count] */
    double start_s;
    int viewpoints_told; /* of all cameras, when their common page was written last */
} run;

/* The first of two failures counts. */
static weft_code first_of(weft_code code, weft_code later, const weft_error *last, weft_error *error)
{
    if (code == WEFT_OK && later != WEFT_OK && error)
        *error = *last;
    return code != WEFT_OK ? code : later;
}

/* ---- One photograph ---- */

/* The file that the camera made lies beside the photograph that was made of it, under the same name and its own ending.
 * `bracket` is -1 for the first photograph of a shot. */
static weft_code keep_original(const weft_camera_at_work *c, int shot, int bracket, weft_error *error)
{
    const weft_rig_camera *camera = &c->rig->camera;
    char path[PATH_MAX], kept[PATH_MAX + 16];
    if (!camera->original)
        return WEFT_OK;
    const char *original = camera->original(camera->device);
    if (bracket < 0)
        weft_session_photograph_path(c->session, shot, path, sizeof path);
    else
        weft_session_bracket_path(c->session, shot, bracket, path, sizeof path);
    const char *ending = strrchr(original, '.');
    snprintf(kept, sizeof kept, "%.*s.original%s", (int)(strrchr(path, '.') - path), path, ending ? ending : "");
    return weft_keep_file(original, kept, error);
}

/* A page that cannot be written costs no photograph. */
static weft_code hand_over(run *r, weft_camera_at_work *c, const weft_exposing *e, weft_error *error)
{
    weft_status_counts counts = weft_night_counts(c, r->start_s);
    double white = weft_meter_white(&c->shooting.meter, c->session, e->samples);
    counts.taken++;
    counts.taken_now++;
    weft_error told = {0};
    weft_code noted = weft_status_page_note(c->status, e->shot, &e->record, white, e->samples, &counts, &told);
    WEFT_TRY(weft_photograph_writer_submit(c->writer, e->shot, &e->record, error));
    r->night->summary->bracketed += e->record.bracket_count;
    c->taken++;
    c->failures = 0;
    return first_of(WEFT_OK, noted, &told, error);
}

/* ---- One volley ---- */

/* Its cameras that are not left out. */
static int aim(run *r, const weft_volley_shots *volley, weft_camera_at_work **aimed, weft_exposing *exposing)
{
    int count = 0;
    for (int i = 0; i < r->camera_count; i++) {
        weft_camera_at_work *c = &r->camera[i];
        if (volley->shot[i] < 0 || c->left_out)
            continue;
        exposing[count] = (weft_exposing){
            .shooting = &c->shooting, .shot = volley->shot[i], .samples = weft_photograph_writer_buffer(c->writer)};
        aimed[count++] = c;
    }
    return count;
}

static weft_code keep_originals(weft_camera_at_work *const *aimed, const weft_exposing *exposing, int count, bool first,
                                weft_error *error)
{
    for (int i = 0; i < count; i++) {
        const weft_exposing *e = &exposing[i];
        if (e->code == WEFT_OK && e->wanted)
            WEFT_TRY(keep_original(aimed[i], e->shot, first ? -1 : e->record.bracket_count - 1, error));
    }
    return WEFT_OK;
}

static weft_code expose_brackets(const run *r, weft_camera_at_work *const *aimed, weft_exposing *exposing, int count,
                                 bool *held, weft_error *error)
{
    int taken = 1;
    for (*held = true; taken > 0 && *held;) {
        WEFT_TRY(weft_volley_bracket(exposing, count, r->night->brackets, &taken, held, error));
        if (taken > 0)
            WEFT_TRY(keep_originals(aimed, exposing, count, false, error));
    }
    return WEFT_OK;
}

static weft_code expose_volley(const run *r, weft_camera_at_work *const *aimed, weft_exposing *exposing, int count,
                               weft_error *error)
{
    int retries = exposing[0].shooting->retries;
    for (int attempt = 0; attempt <= retries; attempt++) {
        bool held = true;
        WEFT_TRY(weft_volley_take(exposing, count, error));
        WEFT_TRY(keep_originals(aimed, exposing, count, true, error));
        WEFT_TRY(expose_brackets(r, aimed, exposing, count, &held, error));
        if (held)
            return WEFT_OK;
        for (int i = 0; i < count; i++)
            exposing[i].shooting->disturbed++;
    }
    return weft_volley_fail_disturbed(&exposing[0], retries + 1, error);
}

/* One camera of several may fail a few times; where there is one, the night is over. */
static void note_failure(const run *r, weft_camera_at_work *c, const weft_exposing *e)
{
    c->failures++;
    c->code = e->code;
    c->failure = e->error;
    c->left_out = r->camera_count == 1 || c->failures >= MOST_FAILURES;
}

static int count_viewpoints(const run *r)
{
    int viewpoints = 0;
    for (int i = 0; i < r->camera_count; i++)
        viewpoints += r->camera[i].shooting.viewpoint + 1;
    return viewpoints;
}

/* On the page of all cameras, when one of them has moved on. */
static weft_code tell(run *r, weft_error *error)
{
    int viewpoints = count_viewpoints(r);
    if (viewpoints == r->viewpoints_told)
        return WEFT_OK;
    r->viewpoints_told = viewpoints;
    return weft_night_overview_write(r->night, r->camera, r->camera_count, r->start_s, NULL, error);
}

static weft_code take_volley(run *r, const weft_volley_shots *volley, weft_error *error)
{
    weft_camera_at_work *aimed[WEFT_CAMERAS_MAX];
    weft_exposing exposing[WEFT_CAMERAS_MAX];
    int count = aim(r, volley, aimed, exposing);
    if (count > 0)
        WEFT_TRY(expose_volley(r, aimed, exposing, count, error));
    for (int i = 0; i < count; i++) {
        if (exposing[i].code != WEFT_OK)
            note_failure(r, aimed[i], &exposing[i]);
        else
            WEFT_TRY(hand_over(r, aimed[i], &exposing[i], error));
    }
    return tell(r, error);
}

/* ---- All volleys ---- */

static int taken_by_all(const run *r)
{
    int taken = 0;
    for (int i = 0; i < r->camera_count; i++)
        taken += r->camera[i].taken;
    return taken;
}

static bool is_over(const run *r)
{
    bool over = true;
    for (int i = 0; i < r->camera_count; i++)
        over = over && r->camera[i].left_out;
    return over || (r->night->stop && *r->night->stop);
}

/* That of the first camera which failed, the more so if it was left out. */
static weft_code failure_of_cameras(const run *r, weft_error *error)
{
    const weft_camera_at_work *worst = NULL;
    for (int i = 0; i < r->camera_count; i++) {
        const weft_camera_at_work *c = &r->camera[i];
        if (c->code != WEFT_OK && (!worst || (c->left_out && !worst->left_out)))
            worst = c;
    }
    if (!worst)
        return WEFT_OK;
    if (r->camera_count == 1) {
        if (error)
            *error = worst->failure;
        return worst->code;
    }
    return weft_fail(error, worst->code, "camera '%s': %s; run again to take what it lacks", worst->rig->camera_name,
                     worst->failure.message);
}

static weft_code take_volleys(run *r, weft_error *error)
{
    const weft_night *night = r->night;
    long total = night->summary->found;
    for (int i = 0; i < r->camera_count; i++)
        total += r->camera[i].session->shot_count - r->camera[i].found;
    for (int i = 0; i < night->order->count && !is_over(r); i++) {
        WEFT_TRY(take_volley(r, &night->order->volley[i], error));
        weft_progress_report(night->progress, "taking photographs", night->summary->found + taken_by_all(r), total);
    }
    return failure_of_cameras(r, error);
}

/* ---- Before and after ---- */

static weft_code begin_camera(const weft_night *night, weft_rig *rig, weft_held_session *held, weft_camera_at_work *c,
                              weft_error *error)
{
    *c = (weft_camera_at_work){.rig = rig, .session = &held->session, .damaged = held->damaged};
    for (int shot = 0; shot < c->session->shot_count; shot++)
        c->found += c->session->record[shot].taken;
    WEFT_TRY(weft_shooting_begin(rig, c->session, held->next_viewpoint, &c->shooting, error));
    WEFT_TRY(weft_night_page_begin(night, c, error));
    weft_code seen = weft_sensor_frames_take(rig, c->session, night->stop, night->progress, &c->failure);
    if (seen != WEFT_OK) {
        c->code = seen;
        c->left_out = true;
        return WEFT_OK;
    }
    return weft_photograph_writer_start(c->session, night->brackets, &c->writer, error);
}

static weft_code begin_all(run *r, weft_error *error)
{
    weft_rig *rig = r->night->rig;
    for (int i = 0; i < r->night->camera_count; i++, rig = rig->next) {
        r->camera_count++;
        WEFT_TRY(begin_camera(r->night, rig, &r->night->held[i], &r->camera[i], error));
    }
    r->start_s = weft_now_s();
    return WEFT_OK;
}

/* What waits to be written is written, whatever has happened. */
static weft_code finish_writing(run *r, weft_code code, weft_error *error)
{
    for (int i = 0; i < r->camera_count; i++) {
        weft_camera_at_work *c = &r->camera[i];
        weft_error last = {0};
        weft_code written = c->writer ? weft_photograph_writer_finish(c->writer, &last) : WEFT_OK;
        if (written != WEFT_OK) {
            c->code = written;
            c->failure = last;
        }
        code = first_of(code, written, &last, error);
    }
    return code;
}

static weft_code end_camera(run *r, weft_camera_at_work *c, const char *why, weft_error *error)
{
    weft_capture_summary *summary = r->night->summary;
    const weft_status_counts counts = weft_night_counts(c, r->start_s);
    summary->taken += c->taken;
    summary->exposures += c->shooting.exposures;
    summary->timeouts += c->shooting.timeouts;
    summary->disturbed += c->shooting.disturbed;
    return weft_status_page_end(c->status, &counts, why, error);
}

static weft_code end_all(run *r, weft_code code, weft_error *error)
{
    const char *failure = code != WEFT_OK ? error->message : NULL;
    weft_error last = {0}, one = {0};
    weft_code told = WEFT_OK;
    bool is_complete = true;
    for (int i = 0; i < r->camera_count; i++) {
        weft_camera_at_work *c = &r->camera[i];
        const char *why = weft_night_why_early(c, failure);
        is_complete = is_complete && !why;
        told = first_of(told, end_camera(r, c, why, &one), &one, &last);
    }
    const char *why = failure || is_complete ? failure : weft_night_stopped;
    told = first_of(told, weft_night_overview_write(r->night, r->camera, r->camera_count, r->start_s, why, &one), &one,
                    &last);
    for (int i = 0; i < r->camera_count; i++)
        weft_shooting_end(&r->camera[i].shooting);
    return first_of(code, told, &last, error);
}

weft_code weft_night_take(const weft_night *night, weft_error *error)
{
    weft_error own = {0};
    run r = {.night = night, .start_s = weft_now_s()};
    r.camera = calloc((size_t)night->camera_count, sizeof *r.camera);
    if (!r.camera)
        return weft_fail_memory(error, "cameras", (size_t)night->camera_count * sizeof *r.camera);
    weft_code code = begin_all(&r, &own);
    if (code == WEFT_OK)
        code = take_volleys(&r, &own);
    code = finish_writing(&r, code, &own);
    night->summary->seconds = weft_now_s() - r.start_s;
    code = end_all(&r, code, &own);
    free(r.camera);
    if (code != WEFT_OK && error)
        *error = own;
    return code;
}

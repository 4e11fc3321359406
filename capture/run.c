#include "capture/capture.h"

#include "base/atomic_file.h"
#include "base/clock.h"
#include "capture/photograph_writer.h"
#include "capture/shooting.h"
#include "capture/shot_order.h"
#include "capture/status/status_page.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Failures in a row after which one of several cameras is left out: each has been retried, and may have waited long. */
enum { MOST_FAILURES = 3 };

static const char stopped[] = "it was stopped; run again to go on";

/* A camera: its session, what it has taken so far, and what became of it. */
typedef struct working_camera {
    weft_rig *rig;
    weft_session *session;
    int found, taken, damaged;
    weft_shooting shooting;
    weft_photograph_writer *writer; /* NULL: it does not get that far */
    weft_status_page *status;
    int failures;       /* in a row */
    bool left_out;      /* for the rest of the run */
    weft_code code;     /* of its last failure */
    weft_error failure; /* why */
} working_camera;

/* All shots that are missing, taken and written. */
typedef struct run {
    weft_capture *capture;
    const volatile sig_atomic_t *stop;
    const weft_progress *progress;
    int camera_count;
    working_camera *camera; /* [camera_count] */
    double start_s;
    int viewpoints_shown; /* of all cameras, when their common page was written last */
} run;

/* The first of two failures counts. */
static weft_code first_of(weft_code code, weft_code later, const weft_error *last, weft_error *error)
{
    if (code == WEFT_OK && later != WEFT_OK && error)
        *error = *last;
    return code != WEFT_OK ? code : later;
}

/* ---- Status pages ---- */

/* A camera of several has its page in a folder of its name. */
static weft_code begin_page(const run *r, working_camera *c, weft_error *error)
{
    const char *name = c->rig->camera_name;
    char folder[PATH_MAX];
    if (!r->capture->status || !name)
        return weft_status_page_begin(r->capture->status, c->session, NULL, &c->status, error);
    WEFT_TRY(weft_make_folder(r->capture->status, error));
    snprintf(folder, sizeof folder, "%s/%s", r->capture->status, name);
    return weft_status_page_begin(folder, c->session, name, &c->status, error);
}

static weft_status_counts counts_of(const run *r, const working_camera *c)
{
    return (weft_status_counts){.taken = c->found + c->taken,
                                .total = c->session->shot_count,
                                .taken_now = c->taken,
                                .seconds = weft_now_s() - r->start_s,
                                .damaged = c->damaged,
                                .timeouts = c->shooting.timeouts,
                                .disturbed = c->shooting.disturbed};
}

/* Why a camera ended early: its own failure, else `failure` of the run, else that it was stopped. NULL: it has all that
 * it was to take. */
static const char *why_early(const working_camera *c, const char *failure)
{
    if (c->code != WEFT_OK)
        return c->failure.message;
    if (c->found + c->taken == c->session->shot_count)
        return NULL;
    return failure ? failure : stopped;
}

/* The page over those of several cameras. `why` tells why the run ended; NULL: it goes on, or took all. */
static weft_code write_overview(const run *r, const char *why, weft_error *error)
{
    weft_status_share share[WEFT_CAMERAS_MAX];
    if (!r->capture->status || !r->capture->rig->first)
        return WEFT_OK;
    for (int i = 0; i < r->camera_count; i++) {
        const working_camera *c = &r->camera[i];
        share[i] = (weft_status_share){.camera = c->rig->camera_name,
                                       .counts = counts_of(r, c),
                                       .failure = c->code != WEFT_OK ? c->failure.message : NULL,
                                       .left_out = c->left_out};
    }
    return weft_status_overview_write(r->capture->status, r->capture->rig->sample, share, r->camera_count, why, error);
}

/* ---- One photograph ---- */

/* The file that the camera made lies beside the photograph that was made of it, under the same name and its own ending.
 * `bracket` is -1 for the first photograph of a shot. */
static weft_code keep_original(const working_camera *c, int shot, int bracket, weft_error *error)
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
static weft_code hand_over(run *r, working_camera *c, const weft_exposing *e, weft_error *error)
{
    weft_status_counts counts = counts_of(r, c);
    double white = weft_meter_white(&c->shooting.meter, c->session, e->samples);
    counts.taken++;
    counts.taken_now++;
    weft_error page_error = {0};
    weft_code noted = weft_status_page_note(c->status, e->shot, &e->record, white, e->samples, &counts, &page_error);
    WEFT_TRY(weft_photograph_writer_submit(c->writer, e->shot, &e->record, error));
    r->capture->summary.bracketed += e->record.bracket_count;
    c->taken++;
    c->failures = 0;
    return first_of(WEFT_OK, noted, &page_error, error);
}

/* ---- One synchronised shot ---- */

/* Its cameras that are not left out. */
static int aim(run *r, const weft_synchronised_shot *shot, working_camera **aimed, weft_exposing *exposing)
{
    int count = 0;
    for (int i = 0; i < r->camera_count; i++) {
        working_camera *c = &r->camera[i];
        if (shot->of_camera[i] < 0 || c->left_out)
            continue;
        exposing[count] = (weft_exposing){
            .shooting = &c->shooting, .shot = shot->of_camera[i], .samples = weft_photograph_writer_buffer(c->writer)};
        aimed[count++] = c;
    }
    return count;
}

static weft_code keep_originals(working_camera *const *aimed, const weft_exposing *exposing, int count, bool first,
                                weft_error *error)
{
    for (int i = 0; i < count; i++) {
        const weft_exposing *e = &exposing[i];
        if (e->code == WEFT_OK && e->wanted)
            WEFT_TRY(keep_original(aimed[i], e->shot, first ? -1 : e->record.bracket_count - 1, error));
    }
    return WEFT_OK;
}

static weft_code expose_brackets(const run *r, working_camera *const *aimed, weft_exposing *exposing, int count,
                                 bool *held, weft_error *error)
{
    int taken = 1;
    for (*held = true; taken > 0 && *held;) {
        WEFT_TRY(weft_shot_bracket(exposing, count, r->capture->brackets, &taken, held, error));
        if (taken > 0)
            WEFT_TRY(keep_originals(aimed, exposing, count, false, error));
    }
    return WEFT_OK;
}

static weft_code expose_shot(const run *r, working_camera *const *aimed, weft_exposing *exposing, int count,
                             weft_error *error)
{
    int retries = exposing[0].shooting->retries;
    for (int attempt = 0; attempt <= retries; attempt++) {
        bool held = true;
        WEFT_TRY(weft_shot_take(exposing, count, error));
        WEFT_TRY(keep_originals(aimed, exposing, count, true, error));
        WEFT_TRY(expose_brackets(r, aimed, exposing, count, &held, error));
        if (held)
            return WEFT_OK;
        for (int i = 0; i < count; i++)
            exposing[i].shooting->disturbed++;
    }
    return weft_shot_fail_disturbed(&exposing[0], retries + 1, error);
}

/* One camera of several may fail a few times; where there is one, the run is over. */
static void note_failure(const run *r, working_camera *c, const weft_exposing *e)
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
static weft_code update_overview(run *r, weft_error *error)
{
    int viewpoints = count_viewpoints(r);
    if (viewpoints == r->viewpoints_shown)
        return WEFT_OK;
    r->viewpoints_shown = viewpoints;
    return write_overview(r, NULL, error);
}

static weft_code take_shot(run *r, const weft_synchronised_shot *shot, weft_error *error)
{
    working_camera *aimed[WEFT_CAMERAS_MAX];
    weft_exposing exposing[WEFT_CAMERAS_MAX];
    int count = aim(r, shot, aimed, exposing);
    if (count > 0)
        WEFT_TRY(expose_shot(r, aimed, exposing, count, error));
    for (int i = 0; i < count; i++) {
        if (exposing[i].code != WEFT_OK)
            note_failure(r, aimed[i], &exposing[i]);
        else
            WEFT_TRY(hand_over(r, aimed[i], &exposing[i], error));
    }
    return update_overview(r, error);
}

/* ---- All of them ---- */

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
    return over || (r->stop && *r->stop);
}

/* That of the first camera which failed, the more so if it was left out. */
static weft_code failure_of_cameras(const run *r, weft_error *error)
{
    const working_camera *worst = NULL;
    for (int i = 0; i < r->camera_count; i++) {
        const working_camera *c = &r->camera[i];
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
    return weft_fail(error, worst->code, "camera '%s': %s; run again to take its missing photographs",
                     worst->rig->camera_name, worst->failure.message);
}

static weft_code take_all(run *r, const weft_shot_order *order, weft_error *error)
{
    long total = r->capture->summary.found;
    for (int i = 0; i < r->camera_count; i++)
        total += r->camera[i].session->shot_count - r->camera[i].found;
    for (int i = 0; i < order->count && !is_over(r); i++) {
        WEFT_TRY(take_shot(r, &order->shot[i], error));
        weft_progress_report(r->progress, "taking photographs", r->capture->summary.found + taken_by_all(r), total);
    }
    return failure_of_cameras(r, error);
}

/* ---- Before and after ---- */

static weft_code begin_camera(const run *r, weft_rig *rig, weft_held_session *held, working_camera *c,
                              weft_error *error)
{
    *c = (working_camera){.rig = rig, .session = &held->session, .damaged = held->damaged};
    for (int shot = 0; shot < c->session->shot_count; shot++)
        c->found += c->session->record[shot].taken;
    WEFT_TRY(weft_shooting_begin(rig, c->session, held->next_viewpoint, &c->shooting, error));
    WEFT_TRY(begin_page(r, c, error));
    weft_code seen = weft_sensor_frames_take(rig, c->session, r->stop, r->progress, &c->failure);
    if (seen != WEFT_OK) {
        c->code = seen;
        c->left_out = true;
        return WEFT_OK;
    }
    return weft_photograph_writer_start(c->session, r->capture->brackets, &c->writer, error);
}

static weft_code begin_all(run *r, weft_error *error)
{
    weft_rig *rig = r->capture->rig;
    for (int i = 0; i < r->capture->camera_count; i++, rig = rig->next) {
        r->camera_count++;
        WEFT_TRY(begin_camera(r, rig, &r->capture->held[i], &r->camera[i], error));
    }
    r->start_s = weft_now_s();
    return WEFT_OK;
}

/* What waits to be written is written, whatever has happened. */
static weft_code finish_writing(run *r, weft_code code, weft_error *error)
{
    for (int i = 0; i < r->camera_count; i++) {
        working_camera *c = &r->camera[i];
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

static weft_code end_camera(run *r, working_camera *c, const char *why, weft_error *error)
{
    weft_capture_summary *summary = &r->capture->summary;
    const weft_status_counts counts = counts_of(r, c);
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
    weft_code reported = WEFT_OK;
    bool is_complete = true;
    for (int i = 0; i < r->camera_count; i++) {
        working_camera *c = &r->camera[i];
        const char *why = why_early(c, failure);
        is_complete = is_complete && !why;
        reported = first_of(reported, end_camera(r, c, why, &one), &one, &last);
    }
    const char *why = failure || is_complete ? failure : stopped;
    reported = first_of(reported, write_overview(r, why, &one), &one, &last);
    for (int i = 0; i < r->camera_count; i++)
        weft_shooting_end(&r->camera[i].shooting);
    return first_of(code, reported, &last, error);
}

static weft_code take_in_order(run *r, const weft_shot_order *order, weft_error *error)
{
    weft_error own = {0};
    size_t bytes = (size_t)r->capture->camera_count * sizeof *r->camera;
    r->start_s = weft_now_s();
    r->camera = calloc(1, bytes);
    if (!r->camera)
        return weft_fail_memory(error, "cameras", bytes);
    weft_code code = begin_all(r, &own);
    if (code == WEFT_OK)
        code = take_all(r, order, &own);
    code = finish_writing(r, code, &own);
    r->capture->summary.seconds = weft_now_s() - r->start_s;
    code = end_all(r, code, &own);
    free(r->camera);
    if (code != WEFT_OK && error)
        *error = own;
    return code;
}

static int count_all_missing(const weft_capture *capture)
{
    int missing = 0;
    for (int i = 0; i < capture->camera_count; i++)
        missing += weft_session_missing(&capture->held[i].session);
    return missing;
}

static int count_all_shots(const weft_capture *capture)
{
    int shots = 0;
    for (int i = 0; i < capture->camera_count; i++)
        shots += capture->held[i].session.shot_count;
    return shots;
}

static bool is_complete(const weft_capture *capture)
{
    bool complete = count_all_missing(capture) == 0;
    for (int i = 0; i < capture->camera_count; i++)
        complete = complete && weft_sensor_frames_missing(&capture->held[i].session) == 0;
    return complete;
}

static weft_code take_missing(weft_capture *capture, const volatile sig_atomic_t *stop, const weft_progress *progress,
                              weft_error *error)
{
    const weft_session *sessions[WEFT_CAMERAS_MAX];
    weft_shot_order order;
    for (int i = 0; i < capture->camera_count; i++)
        sessions[i] = &capture->held[i].session;
    WEFT_TRY(weft_shot_order_make(capture->rig, sessions, capture->camera_count, &order, error));
    run r = {.capture = capture, .stop = stop, .progress = progress};
    weft_code code = take_in_order(&r, &order, error);
    weft_shot_order_free(&order);
    return code;
}

weft_code weft_capture_take(weft_capture *capture, const volatile sig_atomic_t *stop, const weft_progress *progress,
                            weft_error *error)
{
    if (!is_complete(capture))
        WEFT_TRY(take_missing(capture, stop, progress, error));
    if (is_complete(capture))
        return WEFT_OK;
    int shots = count_all_shots(capture);
    return weft_fail(error, WEFT_SYSTEM, "stopped, %d of %d photographs; run again to go on",
                     shots - count_all_missing(capture), shots);
}

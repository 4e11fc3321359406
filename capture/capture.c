#include "capture/capture.h"

#include "base/clock.h"
#include "capture/kept_file.h"
#include "capture/photograph_writer.h"
#include "capture/planned_session.h"
#include "capture/sensor_frames.h"
#include "capture/shooting.h"
#include "capture/status_page.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>

/* ---- Before the first photograph ---- */

static int count_missing(const weft_session *session)
{
    int missing = 0;
    for (int i = 0; i < session->shot_count; i++)
        missing += !session->record[i].taken;
    return missing;
}

static weft_code check_space(const weft_session *session, int missing, int brackets, weft_error *error)
{
    struct statvfs disk;
    if (statvfs(session->folder, &disk) != 0)
        return weft_fail_errno(error, "look at the disk of", session->folder);
    double photographs = (double)missing * (1 + brackets) + weft_sensor_frames_missing(session);
    double needed = photographs * (double)weft_photograph_bytes(session);
    double available = (double)disk.f_bavail * (double)disk.f_frsize;
    if (needed > available)
        return weft_fail(error, WEFT_SYSTEM, "session '%s' needs %.2f GB for %d photographs, the disk has %.2f GB",
                         session->folder, needed * 1e-9, missing, available * 1e-9);
    return WEFT_OK;
}

weft_code weft_capture_begin(const weft_capture_request *request, weft_rig *rig, const weft_progress *progress,
                             weft_capture *capture, weft_error *error)
{
    weft_session planned;
    *capture =
        (weft_capture){.rig = rig, .brackets = request->brackets, .status = request->status, .held = {.lock = -1}};
    WEFT_TRY(weft_session_of_plan(request->folder, request->plan, rig, &planned, error));
    planned.colour = request->colour;
    weft_code code = weft_session_hold(&planned, progress, &capture->held, error);
    weft_session_free(&planned);
    WEFT_TRY(code);
    const weft_session *session = &capture->held.session;
    int missing = count_missing(session);
    capture->summary.damaged = capture->held.damaged;
    capture->summary.found = session->shot_count - missing;
    code = check_space(session, missing, request->brackets, error);
    if (code != WEFT_OK)
        weft_capture_end(capture);
    return code;
}

void weft_capture_end(weft_capture *capture)
{
    weft_held_session_release(&capture->held);
}

/* ---- Photographs ---- */

/* Photographs being taken. */
typedef struct run {
    weft_capture *capture;
    weft_shooting shooting;
    weft_photograph_writer *writer;
    weft_status_page *status;
    double start_s;
    const volatile sig_atomic_t *stop;
    const weft_progress *progress;
    int missing, *shot; /* [missing] their numbers in the order of taking */
} run;

/* The file that the camera made lies beside the photograph that was made of it, under the same name and its own ending.
 * `bracket` is -1 for the first photograph of a shot. */
static weft_code keep_original(run *r, int shot, int bracket, weft_error *error)
{
    const weft_rig_camera *camera = &r->capture->rig->camera;
    char path[PATH_MAX], kept[PATH_MAX + 16];
    if (!camera->original)
        return WEFT_OK;
    const char *original = camera->original(camera->device);
    if (bracket < 0)
        weft_session_photograph_path(&r->capture->held.session, shot, path, sizeof path);
    else
        weft_session_bracket_path(&r->capture->held.session, shot, bracket, path, sizeof path);
    const char *ending = strrchr(original, '.');
    snprintf(kept, sizeof kept, "%.*s.original%s", (int)(strrchr(path, '.') - path), path, ending ? ending : "");
    return weft_keep_file(original, kept, error);
}

static weft_code take_brackets(run *r, int shot, uint16_t *samples, weft_shot_record *record, weft_error *error)
{
    bool taken = true;
    while (taken && record->bracket_count < r->capture->brackets) {
        WEFT_TRY(weft_shooting_bracket(&r->shooting, shot, samples, record, &taken, error));
        if (taken)
            WEFT_TRY(keep_original(r, shot, record->bracket_count - 1, error));
    }
    r->capture->summary.bracketed += record->bracket_count;
    return WEFT_OK;
}

static weft_status_counts counts_of(const run *r)
{
    const weft_capture_summary *summary = &r->capture->summary;
    return (weft_status_counts){.taken = summary->found + summary->taken,
                                .total = r->capture->held.session.shot_count,
                                .taken_now = summary->taken,
                                .seconds = weft_now_s() - r->start_s,
                                .damaged = summary->damaged,
                                .timeouts = r->shooting.timeouts,
                                .disturbed = r->shooting.disturbed};
}

static weft_code take_shots(run *r, weft_error *error)
{
    weft_capture_summary *summary = &r->capture->summary;
    int shot_count = r->capture->held.session.shot_count;
    for (int i = 0; i < r->missing && !(r->stop && *r->stop); i++) {
        int shot = r->shot[i];
        weft_shot_record record;
        uint16_t *samples = weft_photograph_writer_buffer(r->writer);
        WEFT_TRY(weft_shooting_take(&r->shooting, shot, samples, &record, error));
        WEFT_TRY(keep_original(r, shot, -1, error));
        WEFT_TRY(take_brackets(r, shot, samples, &record, error));
        weft_status_counts counts = counts_of(r);
        counts.taken++;
        counts.taken_now++;
        WEFT_TRY(weft_status_page_note(r->status, shot, &record, &r->shooting.meter, samples, &counts, error));
        WEFT_TRY(weft_photograph_writer_submit(r->writer, shot, &record, error));
        summary->taken++;
        weft_progress_report(r->progress, "taking photographs", summary->found + summary->taken, shot_count);
    }
    return WEFT_OK;
}

/* The first of two failures counts. */
static weft_code first_of(weft_code code, weft_code later, const weft_error *last, weft_error *error)
{
    if (code == WEFT_OK && later != WEFT_OK && error)
        *error = *last;
    return code != WEFT_OK ? code : later;
}

static weft_code take_and_write(run *r, weft_error *error)
{
    weft_error own = {0}, last = {0};
    weft_held_session *held = &r->capture->held;
    weft_code code = weft_sensor_frames_take(r->capture->rig, &held->session, r->stop, r->progress, &own);
    r->start_s = weft_now_s();
    if (code == WEFT_OK)
        code = weft_photograph_writer_start(&held->session, r->capture->brackets, &r->writer, &own);
    if (code == WEFT_OK) {
        code = take_shots(r, &own);
        code = first_of(code, weft_photograph_writer_finish(r->writer, &last), &last, &own);
    }
    if (code != WEFT_OK && error)
        *error = own;
    weft_capture_summary *summary = &r->capture->summary;
    summary->seconds = weft_now_s() - r->start_s;
    summary->exposures = r->shooting.exposures;
    summary->timeouts = r->shooting.timeouts;
    summary->disturbed = r->shooting.disturbed;
    const weft_status_counts counts = counts_of(r);
    weft_code told = weft_status_page_end(r->status, &counts, code == WEFT_OK ? NULL : own.message, &last);
    return first_of(code, told, &last, error);
}

static weft_code choose_order(run *r, weft_error *error)
{
    const weft_session *session = &r->capture->held.session;
    weft_rig_stage *stage = &r->capture->rig->stage;
    weft_stage_estimate estimate;
    r->shot = malloc((size_t)session->shot_count * sizeof *r->shot);
    if (!r->shot)
        return weft_fail_memory(error, "plan", (size_t)session->shot_count * sizeof *r->shot);
    for (int i = 0; i < session->shot_count; i++) {
        if (!session->record[i].taken)
            r->shot[r->missing++] = i;
    }
    return stage->order ? stage->order(stage->device, session->shot, r->missing, r->shot, &estimate, error) : WEFT_OK;
}

static weft_code take_missing(run *r, weft_error *error)
{
    weft_held_session *held = &r->capture->held;
    weft_code code = choose_order(r, error);
    if (code == WEFT_OK)
        code = weft_shooting_begin(r->capture->rig, &held->session, held->next_stay, &r->shooting, error);
    if (code == WEFT_OK)
        code = weft_status_page_begin(r->capture->status, &held->session, &r->status, error);
    if (code == WEFT_OK)
        code = take_and_write(r, error);
    weft_shooting_end(&r->shooting);
    free(r->shot);
    return code;
}

weft_code weft_capture_take(weft_capture *capture, const volatile sig_atomic_t *stop, const weft_progress *progress,
                            weft_error *error)
{
    const weft_session *session = &capture->held.session;
    run r = {.capture = capture, .stop = stop, .progress = progress};
    if (count_missing(session) > 0 || weft_sensor_frames_missing(session) > 0)
        WEFT_TRY(take_missing(&r, error));
    int missing = count_missing(session);
    if (missing > 0 || weft_sensor_frames_missing(session) > 0)
        return weft_fail(error, WEFT_SYSTEM, "stopped, %d of %d photographs; run again to go on",
                         session->shot_count - missing, session->shot_count);
    return WEFT_OK;
}

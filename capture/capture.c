#include "capture/capture.h"

#include "base/clock.h"
#include "capture/photograph_writer.h"
#include "capture/resume.h"
#include "capture/shooting.h"
#include "capture/virtual/ground_truth.h"
#include "capture/virtual/virtual_rig.h"

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

static weft_code check_space(const weft_session *session, int missing, weft_error *error)
{
    struct statvfs disk;
    if (statvfs(session->folder, &disk) != 0)
        return weft_fail_errno(error, "look at the disk of", session->folder);
    double needed = (double)missing * (double)weft_photograph_bytes(session);
    double available = (double)disk.f_bavail * (double)disk.f_frsize;
    if (needed > available)
        return weft_fail(error, WEFT_SYSTEM, "session '%s' needs %.2f GB for %d photographs, the disk has %.2f GB",
                         session->folder, needed * 1e-9, missing, available * 1e-9);
    return WEFT_OK;
}

/* ---- Photographs ---- */

/* A capture under way. */
typedef struct run {
    weft_session *session;
    weft_shooting shooting;
    weft_photograph_writer *writer;
    const volatile sig_atomic_t *stop;
    const weft_progress *progress;
    weft_capture_summary *summary;
    bool *missing; /* [shot_count]; the records of the session belong to the writer */
} run;

static weft_code take_shots(run *r, weft_error *error)
{
    int shot_count = r->session->shot_count;
    for (int shot = 0; shot < shot_count; shot++) {
        if (!r->missing[shot])
            continue;
        if (r->stop && *r->stop)
            break;
        weft_shot_record record;
        uint16_t *samples = weft_photograph_writer_buffer(r->writer);
        WEFT_TRY(weft_shooting_take(&r->shooting, shot, samples, &record, error));
        WEFT_TRY(weft_photograph_writer_submit(r->writer, shot, &record, error));
        r->summary->taken++;
        weft_progress_report(r->progress, "taking photographs", r->summary->found + r->summary->taken, shot_count);
    }
    return WEFT_OK;
}

static weft_code take_and_write(run *r, weft_error *error)
{
    WEFT_TRY(weft_photograph_writer_start(r->session, &r->writer, error));
    double start_s = weft_now_s();
    weft_code code = take_shots(r, error);
    weft_error last = {0};
    weft_code last_code = weft_photograph_writer_finish(r->writer, &last);
    if (code == WEFT_OK && last_code != WEFT_OK) {
        code = last_code;
        if (error)
            *error = last;
    }
    r->summary->seconds = weft_now_s() - start_s;
    r->summary->exposures = r->shooting.exposures;
    r->summary->timeouts = r->shooting.timeouts;
    return code;
}

static weft_code take_missing(run *r, weft_error *error)
{
    const weft_session *session = r->session;
    r->missing = malloc((size_t)session->shot_count * sizeof *r->missing);
    if (!r->missing)
        return weft_fail_memory(error, "plan", (size_t)session->shot_count);
    for (int i = 0; i < session->shot_count; i++)
        r->missing[i] = !session->record[i].taken;
    weft_code code = take_and_write(r, error);
    free(r->missing);
    return code;
}

static weft_code photograph(const weft_capture_request *request, const weft_capture_setup *setup,
                            weft_held_session *held, const volatile sig_atomic_t *stop, const weft_progress *progress,
                            weft_capture_summary *summary, weft_error *error)
{
    weft_session *session = &held->session;
    weft_rig rig;
    WEFT_TRY(weft_rig_virtual_open(&setup->world, &session->target, &setup->sample, held->next_stay, &rig, error));
    run r = {.session = session,
             .shooting = weft_shooting_begin(&rig, session, &request->settings, held->next_stay),
             .stop = stop,
             .progress = progress,
             .summary = summary};
    weft_code code = take_missing(&r, error);
    weft_shooting_end(&r.shooting);
    rig.close(rig.back_end);
    return code;
}

static weft_code complete(const weft_capture_request *request, const weft_capture_setup *setup, weft_held_session *held,
                          const volatile sig_atomic_t *stop, const weft_progress *progress,
                          weft_capture_summary *summary, weft_error *error)
{
    weft_session *session = &held->session;
    int missing = count_missing(session);
    summary->damaged = held->damaged;
    summary->found = session->shot_count - missing;
    weft_truth_request truth = {request->truth, request->truth_size, request->truth_images};
    WEFT_TRY(check_space(session, missing, error));
    WEFT_TRY(weft_truth_check_path(&truth, session, error));
    if (missing > 0)
        WEFT_TRY(photograph(request, setup, held, stop, progress, summary, error));
    missing = count_missing(session);
    if (missing > 0)
        return weft_fail(error, WEFT_SYSTEM, "stopped, %d of %d photographs; run again to go on",
                         session->shot_count - missing, session->shot_count);
    return weft_truth_write(&truth, session, &setup->world, &setup->sample, progress, error);
}

weft_code weft_capture_run(const weft_capture_request *request, const volatile sig_atomic_t *stop,
                           const weft_progress *progress, weft_capture_summary *summary, weft_error *error)
{
    weft_capture_setup setup;
    weft_held_session held;
    *summary = (weft_capture_summary){0};
    WEFT_TRY(weft_capture_setup_make(request, &setup, error));
    summary->shot_count = setup.session.shot_count;
    memcpy(summary->warning, setup.warning, sizeof summary->warning);
    weft_code code = weft_session_hold(&setup.session, progress, &held, error);
    if (code == WEFT_OK) {
        code = complete(request, &setup, &held, stop, progress, summary, error);
        weft_held_session_release(&held);
    }
    weft_capture_setup_free(&setup);
    return code;
}

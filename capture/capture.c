#include "capture/capture.h"

#include "capture/photograph_writer.h"
#include "capture/resume.h"
#include "capture/rig_virtual.h"
#include "capture/shooting.h"
#include "capture/truth.h"

#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>
#include <time.h>

static double now_s(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static weft_shooting begin_shooting(const weft_capture_request *request, weft_rig *rig, const weft_session *session,
                                    int next_stay)
{
    const weft_rig_settings *settings = &request->settings;
    weft_exposure_limits limits = {settings->shortest_exposure_s, settings->longest_exposure_s};
    return weft_shooting_begin(rig, session, limits, (int)settings->retries, next_stay);
}

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
    double start_s = now_s();
    weft_code code = take_shots(r, error);
    weft_error last = {0};
    weft_code last_code = weft_photograph_writer_finish(r->writer, &last);
    if (code == WEFT_OK && last_code != WEFT_OK) {
        code = last_code;
        if (error)
            *error = last;
    }
    r->summary->seconds = now_s() - start_s;
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
    WEFT_TRY(weft_rig_virtual_open(&setup->world, &session->target, &setup->cloth, held->next_stay, &rig, error));
    run r = {.session = session,
             .shooting = begin_shooting(request, &rig, session, held->next_stay),
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
    WEFT_TRY(check_space(session, missing, error));
    if (missing > 0)
        WEFT_TRY(photograph(request, setup, held, stop, progress, summary, error));
    missing = count_missing(session);
    if (missing > 0)
        return weft_fail(error, WEFT_SYSTEM, "stopped, %d of %d photographs; run again to go on",
                         session->shot_count - missing, session->shot_count);
    weft_truth_request truth = {request->truth, request->truth_size, request->truth_images};
    return weft_truth_write(&truth, session, &setup->world, &setup->cloth, progress, error);
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

/* ---- Rehearsal ---- */

static void count_plan(const weft_session *session, weft_capture_rehearsal *rehearsal)
{
    rehearsal->shot_count = session->shot_count;
    rehearsal->bytes = (uint64_t)session->shot_count * weft_photograph_bytes(session);
    for (int i = 0; i < session->shot_count; i++) {
        const weft_shot *shot = &session->shot[i], *before = i > 0 ? shot - 1 : NULL;
        bool same_view =
            before && shot->view.theta_rad == before->view.theta_rad && shot->view.phi_rad == before->view.phi_rad;
        bool aside =
            shot->light.theta_rad != shot->light_driven.theta_rad || shot->light.phi_rad != shot->light_driven.phi_rad;
        rehearsal->view_count += !same_view;
        rehearsal->driven_aside += aside;
    }
}

static weft_code time_photograph(const weft_capture_request *request, const weft_capture_setup *setup,
                                 weft_capture_rehearsal *rehearsal, weft_error *error)
{
    const weft_session *session = &setup->session;
    size_t bytes = (size_t)session->camera.width * (size_t)session->camera.height * 3 * sizeof(uint16_t);
    uint16_t *samples = malloc(bytes);
    if (!samples)
        return weft_fail_memory(error, "photograph", bytes);
    weft_rig rig;
    weft_code code = weft_rig_virtual_open(&setup->world, &session->target, &setup->cloth, 0, &rig, error);
    if (code == WEFT_OK) {
        weft_shooting shooting = begin_shooting(request, &rig, session, 0);
        weft_shot_record record;
        /* The first one prepares the view, which all its lights share. */
        code = weft_shooting_take(&shooting, 0, samples, &record, error);
        double start_s = now_s();
        if (code == WEFT_OK)
            code = weft_shooting_take(&shooting, 0, samples, &record, error);
        rehearsal->seconds_per_photograph = now_s() - start_s;
        weft_shooting_end(&shooting);
        rig.close(rig.back_end);
    }
    free(samples);
    return code;
}

weft_code weft_capture_rehearse(const weft_capture_request *request, weft_capture_rehearsal *rehearsal,
                                weft_error *error)
{
    weft_capture_setup setup;
    *rehearsal = (weft_capture_rehearsal){0};
    WEFT_TRY(weft_capture_setup_make(request, &setup, error));
    memcpy(rehearsal->warning, setup.warning, sizeof rehearsal->warning);
    count_plan(&setup.session, rehearsal);
    weft_code code = time_photograph(request, &setup, rehearsal, error);
    weft_capture_setup_free(&setup);
    return code;
}

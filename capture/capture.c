#include "capture/capture.h"

#include "capture/shooting.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>

/* ---- Before the first photograph ---- */

static double bytes_missing(const weft_session *session, int brackets)
{
    double photographs = (double)weft_session_missing(session) * (1 + brackets) + weft_sensor_frames_missing(session);
    return photographs * (double)weft_photograph_bytes(session);
}

static weft_code check_space(const weft_capture *capture, const char *folder, weft_error *error)
{
    struct statvfs disk;
    if (statvfs(folder, &disk) != 0)
        return weft_fail_errno(error, "look at the disk of", folder);
    double needed = 0, available = (double)disk.f_bavail * (double)disk.f_frsize;
    int missing = 0;
    for (int i = 0; i < capture->camera_count; i++) {
        needed += bytes_missing(&capture->held[i].session, capture->brackets);
        missing += weft_session_missing(&capture->held[i].session);
    }
    if (needed > available)
        return weft_fail(error, WEFT_SYSTEM, "session '%s' needs %.2f GB for %d photographs, the disk has %.2f GB",
                         folder, needed * 1e-9, missing, available * 1e-9);
    return WEFT_OK;
}

/* Plans the session of one camera, and creates or opens it. */
static weft_code hold(const weft_capture_request *request, const weft_rig *rig, const weft_progress *progress,
                      weft_held_session *held, weft_error *error)
{
    weft_session planned;
    WEFT_TRY(weft_session_of_plan(request->folder, request->plan, rig, &planned, error));
    if (!rig->colour)
        planned.colour = request->colour;
    weft_code code = weft_session_hold(&planned, progress, held, error);
    weft_session_free(&planned);
    return code;
}

/* A plan that one of the cameras cannot take leaves nothing behind. */
static weft_code prepare_folder(const weft_capture_request *request, const weft_rig *rig, weft_error *error)
{
    const weft_camera_list list = weft_camera_list_of(rig);
    for (const weft_rig *one = rig->first; one; one = one->next) {
        weft_session planned;
        WEFT_TRY(weft_session_of_plan(request->folder, request->plan, one, &planned, error));
        weft_session_free(&planned);
    }
    return list.count > 0 ? weft_camera_folder_prepare(request->folder, &list, error) : WEFT_OK;
}

static weft_code hold_all(const weft_capture_request *request, const weft_progress *progress, weft_capture *capture,
                          weft_error *error)
{
    for (const weft_rig *rig = capture->rig; rig; rig = rig->next) {
        weft_held_session *held = &capture->held[capture->camera_count];
        WEFT_TRY(hold(request, rig, progress, held, error));
        capture->camera_count++;
        capture->summary.damaged += held->damaged;
        capture->summary.found += held->session.shot_count - weft_session_missing(&held->session);
    }
    if (capture->rig->first)
        weft_camera_folder_sweep(request->folder);
    return check_space(capture, request->folder, error);
}

weft_code weft_capture_begin(const weft_capture_request *request, weft_rig *rig, const weft_progress *progress,
                             weft_capture *capture, weft_error *error)
{
    *capture = (weft_capture){.rig = rig, .brackets = request->brackets, .status = request->status};
    WEFT_TRY(prepare_folder(request, rig, error));
    weft_code code = hold_all(request, progress, capture, error);
    if (code != WEFT_OK)
        weft_capture_end(capture);
    return code;
}

void weft_capture_end(weft_capture *capture)
{
    for (int i = 0; i < capture->camera_count; i++)
        weft_held_session_release(&capture->held[i]);
    capture->camera_count = 0;
}

#include "capture/preflight/preflight.h"

#include "capture/preflight/measure.h"
#include "capture/shooting.h"

#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <time.h>

void weft_preflight_free(weft_preflight *result)
{
    weft_image_free(&result->sheet);
    *result = (weft_preflight){0};
}

bool weft_preflight_passed(const weft_preflight *result)
{
    bool passed = true;
    for (int kind = 0; kind < WEFT_CHECK_KINDS; kind++)
        passed = passed && (!result->check[kind].done || result->check[kind].passed);
    return passed;
}

/* ---- What needs no photograph ---- */

/* The folder of the session may not exist yet. */
static void check_disk(const char *folder, double needed_gb, weft_preflight *result)
{
    struct statvfs disk;
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s", folder);
    bool known = statvfs(path, &disk) == 0;
    while (!known && strcmp(path, ".") != 0 && strcmp(path, "/") != 0) {
        char *folder_of = dirname(path);
        memmove(path, folder_of, strlen(folder_of) + 1);
        known = statvfs(path, &disk) == 0;
    }
    if (!known)
        return;
    result->disk_needed = needed_gb;
    weft_preflight_note(result->check, WEFT_CHECK_DISK, (double)disk.f_bavail * (double)disk.f_frsize * 1e-9, needed_gb,
                        (weft_angles){0});
}

static void check_calibration(const char *lens, weft_preflight *result)
{
    const double day_s = 86400;
    struct stat status;
    if (!lens || stat(lens, &status) != 0)
        return;
    double days = difftime(time(NULL), status.st_mtime) / day_s;
    weft_preflight_note(result->check, WEFT_CHECK_CALIBRATION, days,
                        weft_preflight_limits_of[WEFT_CHECK_CALIBRATION].limit, (weft_angles){0});
}

/* ---- Photographs ---- */

enum { PHOTOGRAPHS = 4 };

typedef struct flight {
    weft_rig *rig;
    const weft_session *session;
    weft_sight sight;
    weft_shooting shooting;
    uint16_t *samples; /* [PHOTOGRAPHS][height][width][3] */
    const weft_progress *progress;
    weft_preflight *result;
} flight;

static size_t sample_count(const weft_session *session)
{
    return (size_t)session->camera.width * (size_t)session->camera.height * 3;
}

/* A quarter of the exposure, as far as the shutter goes; *share receives what the camera made of it. */
static weft_code expose_briefly(flight *f, double exposure_s, double *share, weft_error *error)
{
    weft_rig_camera *camera = &f->rig->camera;
    double brief_s = fmax(exposure_s / 4, f->rig->settings.shortest_exposure_s), read_back_s = 0;
    WEFT_TRY(camera->expose(camera->device, f->shooting.last_frame + 3, brief_s,
                            f->samples + 3 * sample_count(f->session), &read_back_s, error));
    *share = read_back_s / exposure_s;
    return WEFT_OK;
}

/* A second photograph just as the first was, a shorter one, and one without the lamp. */
static weft_code repeat(flight *f, double exposure_s, double *brief_share, weft_error *error)
{
    weft_rig_camera *camera = &f->rig->camera;
    weft_rig_light *light = &f->rig->light;
    size_t size = sample_count(f->session);
    double ignored;
    WEFT_TRY(light->power(light->device, true, error));
    WEFT_TRY(
        camera->expose(camera->device, f->shooting.last_frame + 1, exposure_s, f->samples + size, &ignored, error));
    WEFT_TRY(expose_briefly(f, exposure_s, brief_share, error));
    WEFT_TRY(light->power(light->device, false, error));
    return camera->expose(camera->device, f->shooting.last_frame + 2, exposure_s, f->samples + 2 * size, &ignored,
                          error);
}

/* The lamp is off. */
static weft_code look_at_sensor(flight *f, int shot, weft_error *error)
{
    weft_rig_camera *camera = &f->rig->camera;
    double ignored;
    WEFT_TRY(camera->expose(camera->device, f->shooting.last_frame + 4, f->rig->settings.longest_exposure_s, f->samples,
                            &ignored, error));
    return weft_preflight_measure_dark(f->session, f->session->shot[shot].view, f->samples, f->result->check, error);
}

static weft_code visit(flight *f, int shot, int number, weft_error *error)
{
    size_t size = sample_count(f->session);
    weft_shot_record record;
    double brief_share = 1;
    WEFT_TRY(weft_shooting_take(&f->shooting, shot, f->samples, &record, error));
    WEFT_TRY(repeat(f, record.exposure_s, &brief_share, error));
    const weft_preflight_photographs photographs = {f->samples, f->samples + size, f->samples + 2 * size,
                                                    f->samples + 3 * size, brief_share};
    weft_sheet_put(f->session, number, &photographs, &f->result->sheet);
    WEFT_TRY(weft_preflight_measure(f->session, &f->sight, shot, number == 0, &photographs, f->result->check, error));
    return number == 0 ? look_at_sensor(f, shot, error) : WEFT_OK;
}

static weft_code visit_all(flight *f, weft_error *error)
{
    int shot[WEFT_PREFLIGHT_POSES];
    f->result->pose_count = weft_preflight_poses(f->session, shot);
    WEFT_TRY(weft_sheet_create(f->session, f->result->pose_count, &f->result->sheet, error));
    WEFT_TRY(weft_shooting_begin(f->rig, f->session, 0, &f->shooting, error));
    weft_code code = WEFT_OK;
    for (int i = 0; i < f->result->pose_count && code == WEFT_OK; i++) {
        code = visit(f, shot[i], i, error);
        weft_progress_report(f->progress, "checking the rig", i + 1, f->result->pose_count);
    }
    weft_shooting_end(&f->shooting);
    return code;
}

static weft_code fly(flight *f, weft_error *error)
{
    const weft_session *session = f->session;
    size_t bytes = PHOTOGRAPHS * sample_count(session) * sizeof *f->samples;
    WEFT_TRY(weft_sight_create(&session->camera, &session->target, session->camera.fx / session->camera_distance_mm,
                               &f->sight, error));
    f->samples = malloc(bytes);
    weft_code code = f->samples ? visit_all(f, error) : weft_fail_memory(error, "photographs", bytes);
    free(f->samples);
    weft_sight_free(&f->sight);
    return code;
}

weft_code weft_preflight_run(const weft_capture_request *request, weft_rig *rig, const weft_progress *progress,
                             weft_preflight *result, weft_error *error)
{
    weft_capture_rehearsal rehearsal;
    *result = (weft_preflight){0};
    WEFT_TRY(weft_capture_rehearse(request, rig, &rehearsal, error));
    check_disk(request->folder, (double)rehearsal.bytes * 1e-9, result);
    check_calibration(rig->lens_path, result);
    flight f = {.rig = rig, .session = &rehearsal.session, .progress = progress, .result = result};
    weft_code code = fly(&f, error);
    weft_capture_rehearsal_free(&rehearsal);
    if (code != WEFT_OK)
        weft_preflight_free(result);
    return code;
}

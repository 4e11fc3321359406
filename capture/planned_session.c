#include "capture/capture.h"

#include "capture/plan.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_near(double a, double b)
{
    /* Files hold 12 digits at least. */
    return fabs(a - b) <= 1e-9 * fmax(fabs(a), fabs(b));
}

/* Calibration of the axes takes the lens as it is, but for focal lengths and principal point. */
static bool is_same_lens(const weft_camera *a, const weft_camera *b)
{
    const double p[] = {a->k1, a->k2, a->p1, a->p2, a->k3, a->vignetting[0], a->vignetting[1], a->vignetting[2]};
    const double q[] = {b->k1, b->k2, b->p1, b->p2, b->k3, b->vignetting[0], b->vignetting[1], b->vignetting[2]};
    bool same = true;
    for (size_t i = 0; i < sizeof p / sizeof *p; i++)
        same = same && is_near(p[i], q[i]);
    return same;
}

/* Poses go with the lens that they were found with. */
static weft_code check_poses(const weft_rig *rig, weft_error *error)
{
    const weft_camera *lens = &rig->calibration, *camera = rig->poses ? &rig->poses->camera : lens;
    if (camera->width != lens->width || camera->height != lens->height)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is for photographs of %d x %d pixels, the lens is for %d x %d",
                         rig->poses_path, camera->width, camera->height, lens->width, lens->height);
    return is_same_lens(camera, lens)
               ? WEFT_OK
               : weft_fail(error, WEFT_BAD_INPUT,
                           "'%s' has another lens distortion or vignetting than the rig; calibrate again",
                           rig->poses_path);
}

static weft_code describe(const char *folder, const weft_rig *rig, weft_session *session, weft_error *error)
{
    const weft_rig_settings *settings = &rig->settings;
    WEFT_TRY(check_poses(rig, error));
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s%s%s", folder, rig->camera_name ? "/" : "",
             rig->camera_name ? rig->camera_name : "");
    session->folder = strdup(path);
    session->camera_model = rig->camera_model ? strdup(rig->camera_model) : NULL;
    session->rig = strdup(rig->name);
    session->sample = strdup(rig->sample);
    session->rig_settings = strdup(rig->identity);
    session->camera = rig->poses ? rig->poses->camera : rig->calibration;
    session->camera_distance_mm = settings->camera_distance_mm;
    session->light_distance_mm = settings->light_distance_mm;
    session->bits = (int)settings->bits;
    session->black_level = (int)settings->black_level;
    session->noise = rig->noise;
    session->dark_frames = rig->dark_frames;
    session->flat_frames = rig->flat_frames;
    session->target = weft_target_for_opening(settings->opening_mm);
    if (rig->colour)
        session->colour = *rig->colour;
    if (!session->folder || !session->rig || !session->sample || !session->rig_settings ||
        (rig->camera_model && !session->camera_model))
        return weft_fail_memory(error, "session", 0);
    return WEFT_OK;
}

/* ---- Which camera takes which shot ---- */

static weft_code reach(const weft_rig *rig, weft_shot *shot, weft_error *error)
{
    return rig->stage.reach ? rig->stage.reach(rig->stage.device, shot, error) : WEFT_OK;
}

/* The first camera that can take it. */
static weft_code find_taker(const weft_rig *rig, const weft_shot *shot, const weft_rig **taker, weft_error *error)
{
    weft_code code = WEFT_BAD_INPUT;
    *taker = NULL;
    for (const weft_rig *one = rig->first ? rig->first : rig; one && !*taker; one = one->next) {
        weft_shot tried = *shot;
        code = reach(one, &tried, error);
        *taker = code == WEFT_OK ? one : NULL;
    }
    return code;
}

/* Light steps aside for every camera of the rig: all see it at once. */
static weft_code avoid_cameras(const weft_rig *taker, weft_shot *shot, weft_error *error)
{
    /* Aside of one may be into another, a few times over. */
    enum { MOST_ROUNDS = 4 };
    bool moved = true;
    shot->light_driven = shot->light;
    for (int round = 0; moved && round < MOST_ROUNDS; round++) {
        moved = false;
        for (const weft_rig *one = taker->first; one; one = one->next) {
            weft_angles view = shot->view, before = shot->light_driven;
            if (one != taker)
                WEFT_TRY(one->stage.view_of(one->stage.device, taker->stage.device, shot, &view, error));
            shot->light_driven =
                weft_light_beside_camera(before, view, weft_rad_of_deg(one->settings.camera_half_angle_deg));
            moved = moved || shot->light_driven.theta_rad != before.theta_rad ||
                    shot->light_driven.phi_rad != before.phi_rad;
        }
    }
    return WEFT_OK;
}

/* Keeps the shots that are for this camera. Poses that no camera can take up are reported before the run, not in it. */
static weft_code choose_shots(weft_plan *plan, const weft_rig *rig, weft_error *error)
{
    int kept = 0;
    for (int i = 0; i < plan->shot_count; i++) {
        weft_shot shot = plan->shot[i];
        const weft_rig *taker;
        WEFT_TRY(find_taker(rig, &shot, &taker, error));
        if (taker != rig)
            continue;
        if (rig->first)
            WEFT_TRY(avoid_cameras(rig, &shot, error));
        WEFT_TRY(reach(rig, &shot, error));
        plan->shot[kept++] = shot;
    }
    plan->shot_count = kept;
    return kept > 0 ? WEFT_OK
                    : weft_fail(error, WEFT_BAD_INPUT, "no shot of the plan is for the camera '%s'", rig->camera_name);
}

static weft_code place(const weft_rig *rig, size_t shot, weft_session *session, weft_error *error)
{
    const weft_turns *turns = &session->turns[shot];
    weft_pose pose = weft_rig_poses_at(rig->poses, turns);
    if (!weft_pose_is_above(&pose))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' puts the camera where it does not see the plate from above, with turns of %g %g %g "
                         "degrees",
                         rig->poses_path, turns->deg[0], turns->deg[1], turns->deg[2]);
    session->pose[shot] = weft_motion_of_pose(&pose);
    return WEFT_OK;
}

/* Where the axes stand, and where that puts the camera. */
static weft_code place_all(const weft_rig *rig, weft_session *session, weft_error *error)
{
    size_t count = (size_t)session->shot_count;
    if (!rig->stage.turns)
        return rig->poses ? weft_fail(error, WEFT_BAD_INPUT, "calibrated poses need a rig with axes") : WEFT_OK;
    session->turns = calloc(count, sizeof *session->turns);
    session->pose = rig->poses ? calloc(count, sizeof *session->pose) : NULL;
    if (!session->turns || (rig->poses && !session->pose))
        return weft_fail_memory(error, "plan", count * sizeof *session->pose);
    for (size_t i = 0; i < count; i++) {
        WEFT_TRY(rig->stage.turns(rig->stage.device, &session->shot[i], &session->turns[i], error));
        if (rig->poses)
            WEFT_TRY(place(rig, i, session, error));
    }
    return WEFT_OK;
}

/* Takes the shots of the plan. */
static weft_code adopt_plan(const char *name, const weft_rig *rig, weft_session *session, weft_error *error)
{
    weft_plan plan;
    WEFT_TRY(weft_plan_read(name, &plan, error));
    weft_plan_avoid_camera(&plan, weft_rad_of_deg(rig->settings.camera_half_angle_deg));
    session->shot = plan.shot;
    WEFT_TRY(choose_shots(&plan, rig, error));
    session->shot_count = plan.shot_count;
    WEFT_TRY(place_all(rig, session, error));
    session->record = calloc((size_t)plan.shot_count, sizeof *session->record);
    return session->record ? WEFT_OK : weft_fail_memory(error, "plan", (size_t)plan.shot_count * sizeof(weft_shot));
}

weft_code weft_session_of_plan(const char *folder, const char *plan, const weft_rig *rig, weft_session *session,
                               weft_error *error)
{
    *session = (weft_session){0};
    weft_code code = describe(folder, rig, session, error);
    if (code == WEFT_OK)
        code = adopt_plan(plan, rig, session, error);
    if (code != WEFT_OK)
        weft_session_free(session);
    return code;
}

uint64_t weft_photograph_bytes(const weft_session *session)
{
    const uint64_t header = 2048;
    uint64_t bits = (uint64_t)session->camera.width * (uint64_t)session->camera.height * 3 * (uint64_t)session->bits;
    return bits / 8 + header;
}

int weft_session_missing(const weft_session *session)
{
    int missing = 0;
    for (int i = 0; i < session->shot_count; i++)
        missing += !session->record[i].taken;
    return missing;
}

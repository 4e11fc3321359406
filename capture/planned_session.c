#include "capture/planned_session.h"

#include "capture/plan.h"

#include <math.h>
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
                           "'%s' is of a lens with another distortion or vignetting than the rig has: calibrate again",
                           rig->poses_path);
}

static weft_code describe(const char *folder, const weft_rig *rig, weft_session *session, weft_error *error)
{
    const weft_rig_settings *settings = &rig->settings;
    WEFT_TRY(check_poses(rig, error));
    session->folder = strdup(folder);
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
    if (!session->folder || !session->rig || !session->sample || !session->rig_settings)
        return weft_fail_memory(error, "session", 0);
    return WEFT_OK;
}

/* Poses that the stage cannot take up are told before the night, not in it. */
static weft_code reach_all(const weft_plan *plan, const weft_rig_stage *stage, weft_error *error)
{
    for (int i = 0; stage->reach && i < plan->shot_count; i++)
        WEFT_TRY(stage->reach(stage->device, &plan->shot[i], error));
    return WEFT_OK;
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
        return rig->poses ? weft_fail(error, WEFT_BAD_INPUT, "the rig has no axes that calibrated poses could be of")
                          : WEFT_OK;
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
    session->shot_count = plan.shot_count;
    session->shot = plan.shot;
    WEFT_TRY(reach_all(&plan, &rig->stage, error));
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

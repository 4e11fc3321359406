#include "registration/axes/calibration.h"

#include "registration/pose/pose_chain.h"
#include "registration/viewpoint_photographs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double least_correlation = 0.8;

typedef struct work {
    const weft_session *session;
    weft_sensor_defects faults;
    weft_survey survey;
    weft_sight sight;
    weft_fault *fault; /* [shot_count] */
} work;

static weft_code name_shot(const work *w, const weft_viewpoint *viewpoint, weft_axes_shot *shot, weft_error *error)
{
    char path[512];
    weft_session_photograph_path(w->session, viewpoint->shot[0], path, sizeof path);
    size_t folder = strlen(w->session->folder) + 1;
    shot->name = strdup(strlen(path) > folder ? path + folder : path);
    return shot->name ? WEFT_OK : weft_fail_memory(error, "a name", sizeof path);
}

/* Four points that stand for the map of the plane: where they are drawn, and where a photograph shows them. */
static void mark(const work *w, const weft_homography *homography, weft_axes_shot *shot)
{
    double half = 0.6 * weft_target_radius_mm(&w->session->target);
    for (int i = 0; i < WEFT_AXES_POINTS; i++) {
        double x = i % 2 ? half : -half, y = i / 2 ? half : -half;
        weft_pixel seen = weft_camera_distort(&w->session->camera, weft_homography_apply(homography, x, y));
        shot->point[i] = (weft_axes_point){{x, y}, {seen.x, seen.y}};
    }
}

static weft_code look(const work *w, const weft_viewpoint *viewpoint, const float *photograph, weft_axes_shot *shot,
                      weft_error *error)
{
    /* The target may be anywhere in the photograph: that is what the axes are calibrated for. */
    const weft_pose_limits limits = {2 * weft_target_radius_mm(&w->session->target), least_correlation};
    weft_pose predicted = weft_session_pose(w->session, w->survey.view[viewpoint->view]);
    weft_homography homography = weft_homography_of_pose(&w->session->camera, &predicted);
    weft_view_pose pose;
    WEFT_TRY(weft_pose_find(&w->sight, &w->session->target, photograph, &homography, (weft_point_spread){0, 0}, &limits,
                            &pose, error));
    if (pose.source == WEFT_POSE_DRAWING)
        mark(w, &pose.homography, shot);
    else
        snprintf(shot->left_out, sizeof shot->left_out, "%.120s (%d of %d markers found)", pose.remark,
                 pose.marker_count, WEFT_TARGET_MARKER_COUNT);
    return WEFT_OK;
}

static weft_code read_viewpoint(const work *w, const weft_viewpoint *viewpoint, weft_axes_shot *shot, weft_error *error)
{
    weft_viewpoint_photographs photographs;
    shot->turns = w->session->turns[viewpoint->shot[0]];
    WEFT_TRY(name_shot(w, viewpoint, shot, error));
    WEFT_TRY(weft_viewpoint_photographs_read(&w->faults, &w->sight, viewpoint, w->fault, &photographs, error));
    weft_code code = WEFT_OK;
    if (photographs.usable_count > 0)
        code = look(w, viewpoint, photographs.average, shot, error);
    else
        snprintf(shot->left_out, sizeof shot->left_out, "%.150s", w->fault[viewpoint->shot[0]].reason);
    weft_viewpoint_photographs_free(&photographs);
    return code;
}

static weft_code read_viewpoints(const work *w, const weft_progress *progress, weft_axes_sightings *sightings,
                                 weft_error *error)
{
    int viewpoints = w->survey.viewpoint_count, count = viewpoints < WEFT_AXES_MOST ? viewpoints : WEFT_AXES_MOST;
    sightings->shot = calloc((size_t)count, sizeof *sightings->shot);
    if (!sightings->shot)
        return weft_fail_memory(error, "shots", (size_t)count * sizeof *sightings->shot);
    for (sightings->count = 0; sightings->count < count; sightings->count++) {
        int viewpoint = (int)((long)sightings->count * viewpoints / count);
        weft_progress_report(progress, "finding the target", sightings->count, count);
        weft_axes_shot *shot = &sightings->shot[sightings->count];
        weft_code code = read_viewpoint(w, &w->survey.viewpoint[viewpoint], shot, error);
        if (code != WEFT_OK) {
            sightings->count++;
            return code;
        }
    }
    weft_progress_report(progress, "finding the target", count, count);
    return WEFT_OK;
}

static weft_code prepare(work *w, weft_error *error)
{
    const weft_session *session = w->session;
    if (!session->turns)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' does not record the turns of its axes: its rig has none, or an older Weft took it",
                         session->folder);
    w->fault = calloc((size_t)session->shot_count, sizeof *w->fault);
    if (!w->fault)
        return weft_fail_memory(error, "shots", (size_t)session->shot_count * sizeof *w->fault);
    WEFT_TRY(weft_survey_make(session, &w->survey, error));
    WEFT_TRY(weft_sensor_defects_find(session, &w->faults, error));
    WEFT_TRY(weft_sight_create(&session->camera, &session->target, session->camera.fx / session->camera_distance_mm,
                               &w->sight, error));
    weft_sensor_blind(&w->faults, &w->sight);
    return WEFT_OK;
}

weft_code weft_axes_sightings_read(const weft_session *session, const weft_progress *progress,
                                   weft_axes_sightings *sightings, weft_error *error)
{
    work w = {.session = session};
    *sightings = (weft_axes_sightings){0};
    weft_code code = prepare(&w, error);
    if (code == WEFT_OK)
        sightings->photographs = session->shot_count - w.survey.untaken;
    if (code == WEFT_OK)
        code = read_viewpoints(&w, progress, sightings, error);
    if (code != WEFT_OK)
        weft_axes_sightings_free(sightings);
    weft_sensor_defects_free(&w.faults);
    weft_sight_free(&w.sight);
    weft_survey_free(&w.survey);
    free(w.fault);
    return code;
}

void weft_axes_sightings_free(weft_axes_sightings *sightings)
{
    for (int i = 0; i < sightings->count; i++)
        free((char *)sightings->shot[i].name);
    free(sightings->shot);
    *sightings = (weft_axes_sightings){0};
}

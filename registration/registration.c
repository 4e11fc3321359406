#include "registration/registration.h"

#include "base/clock.h"
#include "btf/session/camera_list.h"
#include "registration/report/report.h"
#include "registration/steps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Everything at work. */
typedef struct work {
    const weft_sensor_defects *faults;
    weft_rectifier rectifier;
    weft_sight sight;
    const weft_progress *progress;
    weft_point_spread point_spread; /* of the last view that was refined: the lens is the same */
    float *shown;                   /* for the report; NULL where there is none */
    long done;                      /* photographs */
} work;

weft_registration_settings weft_registration_defaults(const weft_session *session)
{
    return (weft_registration_settings){64, 64, {session->target.opening_mm / 8, 0.8}, false, NULL};
}

static weft_code allocate(const weft_session *session, weft_registration *registration, weft_error *error)
{
    size_t shots = (size_t)session->shot_count, viewpoints = (size_t)registration->survey.viewpoint_count;
    registration->pose = calloc(viewpoints, sizeof *registration->pose);
    registration->used = calloc(viewpoints, sizeof *registration->used);
    registration->fault = calloc(shots, sizeof *registration->fault);
    registration->white = calloc(shots, sizeof *registration->white);
    registration->saturated = calloc(shots, sizeof *registration->saturated);
    if (registration->pose && registration->used && registration->fault && registration->white &&
        registration->saturated)
        return WEFT_OK;
    return weft_fail_memory(error, "a registration", shots * (sizeof(weft_fault) + sizeof(weft_white)));
}

static weft_code check_shots(const weft_session *session, weft_error *error)
{
    const double horizon_rad = weft_rad_of_deg(89.9);
    for (int shot = 0; shot < session->shot_count; shot++) {
        double light = session->shot[shot].light_driven.theta_rad, view = session->shot[shot].view.theta_rad;
        if (!(fabs(light) < horizon_rad) || !(fabs(view) < horizon_rad))
            return weft_fail(
                error, WEFT_BAD_INPUT,
                "shot %d of '%s' has its light %.1f and its view %.1f degrees from the normal; both must be "
                "above the plate",
                shot, session->folder, weft_deg_of_rad(light), weft_deg_of_rad(view));
        double exposure_s = session->record[shot].exposure_s;
        if (session->record[shot].taken && !(exposure_s > 0 && isfinite(exposure_s)))
            return weft_fail(error, WEFT_BAD_INPUT, "the journal of '%s' gives shot %d an exposure of %g s",
                             session->folder, shot, exposure_s);
    }
    return WEFT_OK;
}

static weft_code check_session(const weft_session *session, const weft_registration *registration, weft_error *error)
{
    int untaken = registration->survey.untaken;
    if (untaken > 0 && !registration->settings.allow_unfinished)
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "'%s' is not finished: %d of %d photographs are not taken yet; run the same weft capture again, "
            "or register what there is with --allow-unfinished",
            session->folder, untaken, session->shot_count);
    if (!(session->camera_distance_mm > 0) || !(session->light_distance_mm > 0) || !(session->target.opening_mm > 0))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': camera at %g mm, light at %g mm, opening of %g mm",
                         session->folder, session->camera_distance_mm, session->light_distance_mm,
                         session->target.opening_mm);
    return check_shots(session, error);
}

/* Where a view is known to be seen from; where it is not, the angles of the plan to the last bit. */
static weft_vec3 view_direction(const weft_session *session, weft_angles view)
{
    if (!session->pose)
        return weft_direction_of_angles(view);
    weft_pose pose = weft_session_pose(session, view);
    return weft_unit(weft_pose_camera_position(&pose));
}

/* The images of one camera: those from `first_image` and `first_view` on. */
static void describe_images(const weft_session *session, const weft_survey *survey, int first_image, int first_view,
                            weft_dataset_layout *layout)
{
    for (int shot = 0; shot < session->shot_count; shot++) {
        layout->light[first_image + shot] = weft_direction_of_angles(session->shot[shot].light_driven);
        layout->view_of_image[first_image + shot] = first_view + survey->view_of_shot[shot];
    }
    for (int view = 0; view < survey->view_count; view++)
        layout->view[first_view + view] = view_direction(session, survey->view[view]);
}

/* The cameras one after another. */
static weft_code describe_dataset(const weft_session *sessions, int count, const weft_registration *registrations,
                                  weft_dataset_layout *layout, weft_error *error)
{
    const weft_registration_settings *settings = &registrations[0].settings;
    *layout = (weft_dataset_layout){.width = settings->width,
                                    .height = settings->height,
                                    .values = WEFT_REFLECTANCE_COSINE,
                                    .distance = WEFT_FAR,
                                    .texel_pitch_mm = sessions[0].target.opening_mm / settings->width};
    for (int i = 0; i < count; i++) {
        layout->image_count += sessions[i].shot_count;
        layout->view_count += registrations[i].survey.view_count;
    }
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    for (int i = 0, image = 0, view = 0; i < count; i++) {
        describe_images(&sessions[i], &registrations[i].survey, image, view, layout);
        image += sessions[i].shot_count;
        view += registrations[i].survey.view_count;
    }
    return WEFT_OK;
}

static weft_code find_and_rectify(work *w, int viewpoint, const weft_viewpoint_photographs *photographs,
                                  weft_error *error)
{
    const weft_session *session = w->rectifier.session;
    weft_registration *registration = w->rectifier.registration;
    weft_view_pose *pose = &registration->pose[viewpoint];
    weft_pose predicted_pose =
        weft_session_pose(session, registration->survey.view[registration->survey.viewpoint[viewpoint].view]);
    weft_homography predicted = weft_homography_of_pose(&session->camera, &predicted_pose);
    WEFT_TRY(weft_pose_find(&w->sight, &session->target, photographs->average, &predicted, w->point_spread,
                            &registration->settings.limits, pose, error));
    if (pose->source == WEFT_POSE_FAILED)
        return WEFT_OK;
    if (pose->source == WEFT_POSE_DRAWING)
        w->point_spread = pose->point_spread;
    return weft_rectify_viewpoint(&w->rectifier, viewpoint, photographs, NULL, w->shown, error);
}

static weft_code register_viewpoint(work *w, int viewpoint, weft_error *error)
{
    weft_registration *registration = w->rectifier.registration;
    weft_view_pose *pose = &registration->pose[viewpoint];
    weft_viewpoint_photographs photographs;
    WEFT_TRY(weft_viewpoint_photographs_read(w->faults, &w->sight, &registration->survey.viewpoint[viewpoint],
                                             registration->fault, &photographs, error));
    weft_code code = WEFT_OK;
    if (photographs.usable_count > 0)
        code = find_and_rectify(w, viewpoint, &photographs, error);
    else
        snprintf(pose->remark, sizeof pose->remark, "none of its %d photographs can be used", photographs.count);
    if (code == WEFT_OK && registration->settings.report_folder) {
        const float *texel = registration->used[viewpoint] > 0 ? w->shown : NULL;
        code = weft_report_write_pictures(registration, &w->sight.camera, viewpoint, photographs.average, texel, error);
    }
    w->done += photographs.count;
    weft_viewpoint_photographs_free(&photographs);
    return code;
}

/* Rectifies the photographs of a viewpoint that had no white level of their own. */
static weft_code rectify_again(work *w, int viewpoint, const weft_white *estimated, weft_error *error)
{
    weft_registration *registration = w->rectifier.registration;
    bool unseen = w->shown && registration->used[viewpoint] == 0;
    weft_viewpoint_photographs photographs;
    WEFT_TRY(weft_viewpoint_photographs_read(w->faults, &w->sight, &registration->survey.viewpoint[viewpoint],
                                             registration->fault, &photographs, error));
    weft_code code =
        weft_rectify_viewpoint(&w->rectifier, viewpoint, &photographs, estimated, unseen ? w->shown : NULL, error);
    weft_viewpoint_photographs_free(&photographs);
    if (code != WEFT_OK || !unseen || registration->used[viewpoint] == 0)
        return code;
    return weft_report_write_pictures(registration, &w->sight.camera, viewpoint, NULL, w->shown, error);
}

/* Once more through the viewpoints with photographs whose white level was not measured. */
static weft_code rectify_estimated(work *w, weft_error *error)
{
    weft_registration *registration = w->rectifier.registration;
    weft_white *estimated;
    WEFT_TRY(weft_white_estimate(w->rectifier.session, registration, &estimated, error));
    weft_code code = WEFT_OK;
    for (int viewpoint = 0; code == WEFT_OK && viewpoint < registration->survey.viewpoint_count; viewpoint++) {
        if (weft_white_lacking(registration, viewpoint))
            code = rectify_again(w, viewpoint, estimated, error);
    }
    free(estimated);
    return code;
}

static void count_outcome(const weft_session *session, weft_registration *registration)
{
    for (int viewpoint = 0; viewpoint < registration->survey.viewpoint_count; viewpoint++) {
        registration->image_count += registration->used[viewpoint];
        registration->failed_viewpoints += registration->pose[viewpoint].source == WEFT_POSE_FAILED;
    }
    for (int shot = 0; shot < session->shot_count; shot++) {
        const weft_white *white = &registration->white[shot];
        registration->fault_count += registration->fault[shot].reason[0] != 0;
        registration->estimated_whites += white->patches == 0 && white->level[1] > 0;
    }
}

static weft_code check_outcome(const weft_session *session, const weft_registration *registration, weft_error *error)
{
    if (registration->image_count > 0)
        return WEFT_OK;
    const char *reason = registration->pose[0].remark;
    for (int shot = 0; shot < session->shot_count && !*reason; shot++)
        reason = registration->fault[shot].reason;
    return weft_fail(error, WEFT_BAD_INPUT,
                     "nothing in '%s' can be registered (%d photographs cannot be used, %d views "
                     "failed): %s",
                     session->folder, registration->fault_count, registration->failed_viewpoints, reason);
}

static weft_code run(work *w, weft_error *error)
{
    weft_registration *registration = w->rectifier.registration;
    const weft_session *session = w->rectifier.session;
    long total = session->shot_count - registration->survey.untaken;
    weft_progress_report(w->progress, "calibrating", 0, total);
    weft_sensor_blind(w->faults, &w->sight);
    WEFT_TRY(weft_calibrate(w->faults, registration, &w->sight, error));
    for (int viewpoint = 0; viewpoint < registration->survey.viewpoint_count; viewpoint++) {
        weft_progress_report(w->progress, "registering views", w->done, total);
        WEFT_TRY(register_viewpoint(w, viewpoint, error));
    }
    weft_progress_report(w->progress, "registering views", total, total);
    WEFT_TRY(rectify_estimated(w, error));
    count_outcome(session, registration);
    return check_outcome(session, registration, error);
}

static weft_code prepare_pictures(work *w, weft_error *error)
{
    const weft_registration *registration = w->rectifier.registration;
    size_t values = (size_t)registration->settings.width * (size_t)registration->settings.height * 3;
    if (!registration->settings.report_folder)
        return WEFT_OK;
    w->shown = malloc(values * sizeof *w->shown);
    if (!w->shown)
        return weft_fail_memory(error, "the report's pictures", values * sizeof(float));
    return weft_report_prepare(registration->settings.report_folder, error);
}

/* Pixels per mm of the frontal view. */
static double frontal_scale(const weft_session *session)
{
    return session->camera.fx / session->camera_distance_mm;
}

static weft_code look_and_run(work *w, const weft_session *session, weft_error *error)
{
    WEFT_TRY(weft_sight_create(&session->camera, &session->target, frontal_scale(session), &w->sight, error));
    weft_code code = prepare_pictures(w, error);
    if (code == WEFT_OK)
        code = run(w, error);
    free(w->shown);
    weft_sight_free(&w->sight);
    return code;
}

/* Puts the photographs of one camera into the dataset, and writes its report. */
static weft_code register_camera(const weft_session *session, const char *output, weft_dataset_writer *writer,
                                 int first_image, const weft_progress *progress, weft_registration *registration,
                                 weft_error *error)
{
    weft_sensor_defects faults;
    double began_s = weft_now_s();
    weft_code code = weft_sensor_defects_find(session, &faults, error);
    registration->found.sensor = faults.summary;
    if (code == WEFT_OK) {
        work w = {.faults = &faults, .progress = progress};
        w.rectifier = (weft_rectifier){&faults.seen, &faults, &w.sight, writer, first_image, registration};
        code = look_and_run(&w, session, error);
    }
    registration->seconds = weft_now_s() - began_s;
    if (code == WEFT_OK && registration->settings.report_folder)
        code = weft_report_write_page(&faults.seen, registration, output, error);
    weft_sensor_defects_free(&faults);
    return code;
}

static weft_code register_all(const weft_session *sessions, int count, const char *output, weft_dataset_writer *writer,
                              const weft_progress *progress, weft_registration *registrations, weft_error *error)
{
    for (int i = 0, image = 0; i < count; i++) {
        WEFT_TRY(register_camera(&sessions[i], output, writer, image, progress, &registrations[i], error));
        image += sessions[i].shot_count;
    }
    return WEFT_OK;
}

/* Writes dataset and reports from surveyed sessions. */
static weft_code produce(const weft_session *sessions, int count, const char *output, const weft_progress *progress,
                         weft_registration *registrations, weft_error *error)
{
    weft_dataset_layout layout = {0};
    weft_dataset_writer *writer = NULL;
    char *provenance = NULL;
    weft_code code = describe_dataset(sessions, count, registrations, &layout, error);
    if (code == WEFT_OK)
        code = weft_dataset_writer_create(output, &layout, &writer, error);
    if (code == WEFT_OK)
        code = register_all(sessions, count, output, writer, progress, registrations, error);
    if (code == WEFT_OK) {
        provenance = weft_registration_provenance(sessions, count, registrations);
        if (!provenance)
            code = weft_fail_memory(error, "provenance", 0);
    }
    if (code == WEFT_OK) {
        code = weft_dataset_writer_finish(writer, provenance, error);
        writer = NULL;
    }
    free(provenance);
    weft_dataset_writer_abandon(writer);
    weft_dataset_layout_free(&layout);
    return code;
}

static weft_code survey(const weft_session *session, weft_registration *registration, weft_error *error)
{
    WEFT_TRY(weft_survey_make(session, &registration->survey, error));
    WEFT_TRY(check_session(session, registration, error));
    return allocate(session, registration, error);
}

/* One sample lies before all cameras, and its texels are those of all. */
static weft_code check_cameras(const weft_session *sessions, int count, weft_error *error)
{
    for (int i = 1; i < count; i++) {
        if (sessions[i].target.opening_mm != sessions[0].target.opening_mm)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' has an opening of %g mm, '%s' one of %g mm",
                             sessions[i].folder, sessions[i].target.opening_mm, sessions[0].folder,
                             sessions[0].target.opening_mm);
    }
    return weft_camera_sessions_agree(sessions, count, error);
}

weft_code weft_register_cameras(const weft_session *sessions, int count, const char *output,
                                const weft_registration_settings *settings, const weft_progress *progress,
                                weft_registration *registrations, weft_error *error)
{
    weft_code code = check_cameras(sessions, count, error);
    for (int i = 0; i < count; i++) {
        registrations[i] = (weft_registration){.settings = settings[i]};
        if (code == WEFT_OK)
            code = survey(&sessions[i], &registrations[i], error);
    }
    if (code == WEFT_OK)
        code = produce(sessions, count, output, progress, registrations, error);
    for (int i = 0; code != WEFT_OK && i < count; i++)
        weft_registration_free(&registrations[i]);
    return code;
}

weft_code weft_register_session(const weft_session *session, const char *output,
                                const weft_registration_settings *settings, const weft_progress *progress,
                                weft_registration *registration, weft_error *error)
{
    return weft_register_cameras(session, 1, output, settings, progress, registration, error);
}

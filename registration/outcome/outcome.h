/* What a registration found: what the report, the screen and the dataset tell of it. */
#ifndef WEFT_REGISTRATION_OUTCOME_OUTCOME_H
#define WEFT_REGISTRATION_OUTCOME_OUTCOME_H

#include "btf/session/session.h"
#include "registration/pose/pose_chain.h"
#include "registration/radiometry/radiometry.h"
#include "registration/radiometry/sensor_defects.h"

/* ---- What a session holds: its distinct views, and its photographs by viewpoint ---- */

/* Photographs taken while the camera stood still. */
typedef struct weft_viewpoint {
    int view;      /* index into weft_survey.view */
    int viewpoint; /* of the session */
    int count;
    const int *shot; /* [count] in the order of the plan; owned by the survey */
} weft_viewpoint;

typedef struct weft_survey {
    int view_count;
    weft_angles *view; /* [view_count] in the order of the plan */
    int *view_of_shot; /* [shot_count] */
    int viewpoint_count;
    weft_viewpoint *viewpoint; /* [viewpoint_count] by view, then by viewpoint */
    int untaken;               /* planned shots that were not taken */
    int *order;                /* shots taken, by viewpoint: what weft_viewpoint.shot points into */
} weft_survey;

/* The caller frees with weft_survey_free. Errors: WEFT_BAD_INPUT for a session without a photograph; WEFT_SYSTEM. */
weft_code weft_survey_make(const weft_session *session, weft_survey *survey, weft_error *error);
void weft_survey_free(weft_survey *survey);

/* What users call a view: the folder of its photographs, "tv030_pv090". */
typedef struct weft_view_name {
    char text[24];
} weft_view_name;

/* Pure. */
weft_view_name weft_view_name_of(weft_angles view);

typedef struct weft_registration_settings {
    int width, height; /* texels of the opening */
    weft_pose_limits limits;
    bool allow_unfinished;     /* register a session whose plan is not complete */
    const char *report_folder; /* where the report goes; NULL: none */
} weft_registration_settings;

/* Why a photograph cannot be used; empty where it can. */
typedef struct weft_fault {
    char reason[200];
} weft_fault;

/* The bend of the plate, as the photographs show it. */
typedef struct weft_bend_found {
    weft_bend bend;
    double unit_mm, standard_error_mm; /* random error of its height at the distance unit_mm, worst of its terms */
    int viewpoints;                    /* it was found from; 0: it was not */
} weft_bend_found;

/* What registration finds of the rig that its calibration does not say. */
typedef struct weft_rig_found {
    weft_bend_found bend;
    weft_vignetting vignetting;
    weft_sensor_summary sensor;
} weft_rig_found;

/* Indices of shots and viewpoints are those of the session and the survey. */
typedef struct weft_registration {
    weft_registration_settings settings;
    weft_survey survey;
    weft_rig_found found;
    weft_view_pose *pose; /* [survey.viewpoint_count] */
    int *used;            /* [survey.viewpoint_count] photographs of the viewpoint that are in the dataset */
    weft_fault *fault;    /* [shot_count] */
    weft_white *white;    /* [shot_count]; level as used, patches 0 where it was estimated or there is none */
    float *saturated;     /* [shot_count] fraction of its texels that are masked as saturated */
    int image_count;      /* photographs in the dataset */
    int fault_count;      /* photographs that cannot be used */
    int failed_viewpoints;
    int estimated_whites; /* photographs whose white level is that of others */
    double seconds;
} weft_registration;

void weft_registration_free(weft_registration *registration);

/* Random error of a viewpoint's positions in texels of the dataset; errors of the calibration are not in it. Pure. */
double weft_registration_uncertainty_texels(const weft_session *session, const weft_registration *registration,
                                            int viewpoint);

/* ---- The lamp over the session, as the white patches saw it ----
 *
 * Each photograph is divided by its own white level, so no sample holds the change. It is reported, and kept in the
 * provenance. */

/* The mean white level (registration/radiometry/radiometry.h) of the photographs of a viewpoint on which it was
 * measured. */
typedef struct weft_viewpoint_white {
    int photographs; /* 0: none */
    double level[3];
} weft_viewpoint_white;

/* Pure. */
weft_viewpoint_white weft_viewpoint_white_of(const weft_registration *registration, int viewpoint);

typedef struct weft_lamp_drift {
    int viewpoints;         /* it was measured in */
    double mean;            /* of their levels, summed over the channels */
    double lowest, highest; /* the dimmest and the brightest against the mean: 0.01 is one per cent more light */
} weft_lamp_drift;

/* Pure. */
weft_lamp_drift weft_lamp_drift_of(const weft_registration *registration);

/* JSON text for the dataset: session, calibration, settings and the outcome of every viewpoint; of several cameras, an
 * array "cameras" of that. Owned by the caller (free). NULL where memory is short. */
char *weft_registration_provenance(const weft_session *sessions, int count, const weft_registration *registrations);

#endif

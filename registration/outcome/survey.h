/* What a session holds, as registration needs it: its distinct views, and its photographs by viewpoint. */
#ifndef WEFT_REGISTRATION_OUTCOME_SURVEY_H
#define WEFT_REGISTRATION_OUTCOME_SURVEY_H

#include "btf/session/session.h"

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

#endif

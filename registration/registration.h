/* Registration: a session of photographs becomes a dataset. */
#ifndef WEFT_REGISTRATION_REGISTRATION_H
#define WEFT_REGISTRATION_REGISTRATION_H

#include "base/progress.h"
#include "registration/photographs.h"
#include "registration/pose/pose_chain.h"
#include "registration/radiometry/radiometry.h"

typedef struct weft_registration_settings {
    int width, height; /* texels of the opening */
    weft_pose_limits limits;
    bool allow_unfinished;     /* register a session whose plan is not complete */
    const char *report_folder; /* where the report goes; NULL: none */
} weft_registration_settings;

/* 64 x 64 texels; a view within an eighth of the opening of the rig's promise, correlated with its drawing by 0.8. */
weft_registration_settings weft_registration_defaults(const weft_session *session);

/* What was found, for the report and the screen. Indices of shots and stays are those of the session and the survey. */
typedef struct weft_registration {
    weft_registration_settings settings;
    weft_survey survey;
    weft_view_pose *pose; /* [survey.stay_count] */
    int *used;            /* [survey.stay_count] photographs of the stay that are in the dataset */
    weft_fault *fault;    /* [shot_count] */
    weft_white *white;    /* [shot_count]; level as used, patches 0 where it was estimated or there is none */
    float *saturated;     /* [shot_count] fraction of its texels that are masked as saturated */
    int image_count;      /* photographs in the dataset */
    int fault_count;      /* photographs that cannot be used */
    int failed_stays;
    int estimated_whites; /* photographs whose white level is that of others */
    double seconds;
} weft_registration;

/* Registers `session` into the dataset `output`, and writes the report where one is asked for. On success the caller
 * frees `registration` with weft_registration_free. A view that cannot be found and a photograph that cannot be used
 * are masked WEFT_MASK_MISSING and named in `registration`; they are no errors. Errors: WEFT_BAD_INPUT for an
 * unfinished session (unless allowed), and where nothing at all can be used; WEFT_SYSTEM. Memory: about 600 MB at most
 * besides the dataset's writer. Uses OpenMP. */
weft_code weft_register_session(const weft_session *session, const char *output,
                                const weft_registration_settings *settings, const weft_progress *progress,
                                weft_registration *registration, weft_error *error);
void weft_registration_free(weft_registration *registration);

/* Random error of a stay's positions in texels of the dataset; errors of the calibration are not in it. Pure. */
double weft_registration_uncertainty_texels(const weft_session *session, const weft_registration *registration,
                                            int stay);

/* JSON text for the dataset: session, calibration, settings and the outcome of every stay. Owned by the caller (free).
 * NULL where memory is short. */
char *weft_registration_provenance(const weft_session *session, const weft_registration *registration);

#endif

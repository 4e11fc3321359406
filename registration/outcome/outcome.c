#include "registration/outcome/outcome.h"

#include <math.h>
#include <stdlib.h>

void weft_registration_free(weft_registration *registration)
{
    weft_survey_free(&registration->survey);
    free(registration->pose);
    free(registration->used);
    free(registration->fault);
    free(registration->white);
    free(registration->saturated);
    *registration = (weft_registration){0};
}

double weft_registration_uncertainty_texels(const weft_session *session, const weft_registration *registration,
                                            int viewpoint)
{
    return registration->pose[viewpoint].uncertainty_mm * registration->settings.width / session->target.opening_mm;
}

/* ---- The lamp over the session ---- */

weft_viewpoint_white weft_viewpoint_white_of(const weft_registration *registration, int viewpoint)
{
    const weft_viewpoint *one = &registration->survey.viewpoint[viewpoint];
    weft_viewpoint_white white = {0, {0, 0, 0}};
    for (int i = 0; i < one->count; i++) {
        const weft_white *measured = &registration->white[one->shot[i]];
        for (int c = 0; c < 3 && measured->patches > 0; c++)
            white.level[c] += measured->level[c];
        white.photographs += measured->patches > 0;
    }
    for (int c = 0; c < 3 && white.photographs > 0; c++)
        white.level[c] /= white.photographs;
    return white;
}

weft_lamp_drift weft_lamp_drift_of(const weft_registration *registration)
{
    weft_lamp_drift drift = {.lowest = INFINITY, .highest = -INFINITY};
    for (int viewpoint = 0; viewpoint < registration->survey.viewpoint_count; viewpoint++) {
        weft_viewpoint_white white = weft_viewpoint_white_of(registration, viewpoint);
        double level = white.level[0] + white.level[1] + white.level[2];
        if (white.photographs == 0)
            continue;
        drift.viewpoints++;
        drift.mean += level;
        drift.lowest = fmin(drift.lowest, level);
        drift.highest = fmax(drift.highest, level);
    }
    if (drift.viewpoints == 0)
        return (weft_lamp_drift){0};
    drift.mean /= drift.viewpoints;
    drift.lowest = drift.lowest / drift.mean - 1;
    drift.highest = drift.highest / drift.mean - 1;
    return drift;
}

#include "registration/steps.h"

#include "base/numeric/statistics.h"

#include <math.h>
#include <stdlib.h>

bool weft_white_lacking(const weft_registration *registration, int viewpoint)
{
    const weft_viewpoint *one = &registration->survey.viewpoint[viewpoint];
    if (registration->pose[viewpoint].source == WEFT_POSE_FAILED)
        return false;
    for (int i = 0; i < one->count; i++) {
        if (!registration->fault[one->shot[i]].reason[0] && registration->white[one->shot[i]].patches == 0)
            return true;
    }
    return false;
}

static bool same_light(weft_angles a, weft_angles b)
{
    return fabs(a.theta_rad - b.theta_rad) < 1e-7 && fabs(a.phi_rad - b.phi_rad) < 1e-7;
}

/* Median level of a channel over the photographs measured, all of them or those under the light of `shot`. */
static double median_level(const weft_session *session, const weft_registration *registration, int channel, int shot,
                           double *scratch, int *count)
{
    *count = 0;
    for (int other = 0; other < session->shot_count; other++) {
        if (registration->white[other].patches > 0 &&
            (shot < 0 || same_light(session->shot[other].light_driven, session->shot[shot].light_driven)))
            scratch[(*count)++] = registration->white[other].level[channel];
    }
    return weft_quantile(scratch, *count, 0.5);
}

static void estimate_all(const weft_session *session, const weft_registration *registration, const double overall[3],
                         weft_white *estimated, double *scratch)
{
    for (int shot = 0; shot < session->shot_count; shot++) {
        if (registration->white[shot].patches > 0)
            continue;
        for (int c = 0; c < 3; c++) {
            int count;
            double level = median_level(session, registration, c, shot, scratch, &count);
            estimated[shot].level[c] = count >= 3 ? level : overall[c];
        }
    }
}

weft_code weft_white_estimate(const weft_session *session, const weft_registration *registration,
                              weft_white **estimated, weft_error *error)
{
    size_t shots = (size_t)session->shot_count;
    bool lacking = false;
    for (int viewpoint = 0; viewpoint < registration->survey.viewpoint_count && !lacking; viewpoint++)
        lacking = weft_white_lacking(registration, viewpoint);
    *estimated = calloc(shots, sizeof **estimated);
    double *scratch = malloc(shots * sizeof *scratch);
    weft_code code = *estimated && scratch ? WEFT_OK : weft_fail_memory(error, "white levels", shots * 48);
    double overall[3];
    int count = 0;
    for (int c = 0; c < 3 && code == WEFT_OK && lacking; c++)
        overall[c] = median_level(session, registration, c, -1, scratch, &count);
    if (code == WEFT_OK && lacking && count == 0)
        code = weft_fail(error, WEFT_BAD_INPUT, "no white reference can be measured in any photograph of '%s'",
                         session->folder);
    if (code == WEFT_OK && lacking)
        estimate_all(session, registration, overall, *estimated, scratch);
    free(scratch);
    if (code != WEFT_OK) {
        free(*estimated);
        *estimated = NULL;
    }
    return code;
}

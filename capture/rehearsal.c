#include "capture/capture.h"

#include "base/clock.h"
#include "capture/planned_session.h"
#include "capture/shooting.h"

#include <stdlib.h>

static void count_plan(const weft_session *session, weft_capture_rehearsal *rehearsal)
{
    rehearsal->shot_count = session->shot_count;
    rehearsal->bytes = (uint64_t)session->shot_count * weft_photograph_bytes(session);
    for (int i = 0; i < session->shot_count; i++) {
        const weft_shot *shot = &session->shot[i], *before = i > 0 ? shot - 1 : NULL;
        bool same_view =
            before && shot->view.theta_rad == before->view.theta_rad && shot->view.phi_rad == before->view.phi_rad;
        bool aside =
            shot->light.theta_rad != shot->light_driven.theta_rad || shot->light.phi_rad != shot->light_driven.phi_rad;
        rehearsal->view_count += !same_view;
        rehearsal->driven_aside += aside;
    }
}

static weft_code time_photograph(weft_rig *rig, const weft_session *session, uint16_t *samples, double *seconds,
                                 weft_error *error)
{
    weft_shooting shooting;
    weft_shot_record record;
    weft_code code = weft_shooting_begin(rig, session, 0, &shooting, error);
    /* The first one prepares the view, which all its lights share. */
    if (code == WEFT_OK)
        code = weft_shooting_take(&shooting, 0, samples, &record, error);
    double start_s = weft_now_s();
    if (code == WEFT_OK)
        code = weft_shooting_take(&shooting, 0, samples, &record, error);
    *seconds = weft_now_s() - start_s;
    weft_shooting_end(&shooting);
    return code;
}

weft_code weft_capture_rehearse(const weft_capture_request *request, weft_rig *rig, weft_capture_rehearsal *rehearsal,
                                weft_error *error)
{
    weft_session session;
    *rehearsal = (weft_capture_rehearsal){0};
    WEFT_TRY(weft_session_of_plan(request->folder, request->plan, rig, &session, error));
    count_plan(&session, rehearsal);
    size_t bytes = (size_t)session.camera.width * (size_t)session.camera.height * 3 * sizeof(uint16_t);
    uint16_t *samples = malloc(bytes);
    weft_code code = samples ? time_photograph(rig, &session, samples, &rehearsal->seconds_per_photograph, error)
                             : weft_fail_memory(error, "photograph", bytes);
    free(samples);
    weft_session_free(&session);
    return code;
}

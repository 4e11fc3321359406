#include "capture/capture.h"

#include "base/clock.h"
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

static weft_code measure_photograph(weft_rig *rig, weft_capture_rehearsal *rehearsal, weft_error *error)
{
    const weft_session *session = &rehearsal->session;
    size_t bytes = (size_t)session->camera.width * (size_t)session->camera.height * 3 * sizeof(uint16_t);
    uint16_t *samples = malloc(bytes);
    weft_code code = samples ? time_photograph(rig, session, samples, &rehearsal->seconds_per_photograph, error)
                             : weft_fail_memory(error, "photograph", bytes);
    free(samples);
    return code;
}

static weft_code choose_order(weft_rig_stage *stage, weft_capture_rehearsal *rehearsal, weft_error *error)
{
    int count = rehearsal->shot_count;
    rehearsal->order = malloc((size_t)count * sizeof *rehearsal->order);
    if (!rehearsal->order)
        return weft_fail_memory(error, "plan", (size_t)count * sizeof *rehearsal->order);
    for (int i = 0; i < count; i++)
        rehearsal->order[i] = i;
    return stage->order
               ? stage->order(stage->device, rehearsal->session.shot, count, rehearsal->order, &rehearsal->stage, error)
               : WEFT_OK;
}

static weft_code rehearse(weft_rig *rig, int brackets, weft_capture_rehearsal *rehearsal, weft_error *error)
{
    count_plan(&rehearsal->session, rehearsal);
    rehearsal->bytes *= 1 + (uint64_t)brackets;
    rehearsal->bytes +=
        (uint64_t)weft_session_frame_count(&rehearsal->session) * weft_photograph_bytes(&rehearsal->session);
    WEFT_TRY(choose_order(&rig->stage, rehearsal, error));
    rehearsal->seconds_per_photograph = rig->seconds_per_photograph;
    return rig->seconds_per_photograph > 0 ? WEFT_OK : measure_photograph(rig, rehearsal, error);
}

weft_code weft_capture_rehearse(const weft_capture_request *request, weft_rig *rig, weft_capture_rehearsal *rehearsal,
                                weft_error *error)
{
    *rehearsal = (weft_capture_rehearsal){0};
    WEFT_TRY(weft_session_of_plan(request->folder, request->plan, rig, &rehearsal->session, error));
    weft_code code = rehearse(rig, request->brackets, rehearsal, error);
    if (code != WEFT_OK)
        weft_capture_rehearsal_free(rehearsal);
    return code;
}

void weft_capture_rehearsal_free(weft_capture_rehearsal *rehearsal)
{
    weft_session_free(&rehearsal->session);
    free(rehearsal->order);
    *rehearsal = (weft_capture_rehearsal){0};
}

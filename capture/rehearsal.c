#include "base/clock.h"
#include "capture/capture.h"

#include "capture/shooting.h"
#include "capture/virtual/virtual_rig.h"

#include <stdlib.h>
#include <string.h>

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

static weft_code time_photograph(const weft_capture_request *request, const weft_capture_setup *setup,
                                 weft_capture_rehearsal *rehearsal, weft_error *error)
{
    const weft_session *session = &setup->session;
    size_t bytes = (size_t)session->camera.width * (size_t)session->camera.height * 3 * sizeof(uint16_t);
    uint16_t *samples = malloc(bytes);
    if (!samples)
        return weft_fail_memory(error, "photograph", bytes);
    weft_rig rig;
    weft_code code = weft_rig_virtual_open(&setup->world, &session->target, &setup->sample, 0, &rig, error);
    if (code == WEFT_OK) {
        weft_shooting shooting = weft_shooting_begin(&rig, session, &request->settings, 0);
        weft_shot_record record;
        /* The first one prepares the view, which all its lights share. */
        code = weft_shooting_take(&shooting, 0, samples, &record, error);
        double start_s = weft_now_s();
        if (code == WEFT_OK)
            code = weft_shooting_take(&shooting, 0, samples, &record, error);
        rehearsal->seconds_per_photograph = weft_now_s() - start_s;
        weft_shooting_end(&shooting);
        rig.close(rig.back_end);
    }
    free(samples);
    return code;
}

weft_code weft_capture_rehearse(const weft_capture_request *request, weft_capture_rehearsal *rehearsal,
                                weft_error *error)
{
    weft_capture_setup setup;
    *rehearsal = (weft_capture_rehearsal){0};
    WEFT_TRY(weft_capture_setup_make(request, &setup, error));
    memcpy(rehearsal->warning, setup.warning, sizeof rehearsal->warning);
    count_plan(&setup.session, rehearsal);
    weft_code code = time_photograph(request, &setup, rehearsal, error);
    weft_capture_setup_free(&setup);
    return code;
}

#include "capture/night_pages.h"

#include "base/atomic_file.h"
#include "base/clock.h"
#include "capture/status/status_overview.h"

#include <limits.h>
#include <stdio.h>

const char weft_night_stopped[] = "it was stopped; run again to go on";

weft_code weft_night_page_begin(const weft_night *night, weft_camera_at_work *c, weft_error *error)
{
    const char *name = c->rig->camera_name;
    char folder[PATH_MAX];
    if (!night->status || !name)
        return weft_status_page_begin(night->status, c->session, NULL, &c->status, error);
    WEFT_TRY(weft_make_folder(night->status, error));
    snprintf(folder, sizeof folder, "%s/%s", night->status, name);
    return weft_status_page_begin(folder, c->session, name, &c->status, error);
}

weft_status_counts weft_night_counts(const weft_camera_at_work *c, double start_s)
{
    return (weft_status_counts){.taken = c->found + c->taken,
                                .total = c->session->shot_count,
                                .taken_now = c->taken,
                                .seconds = weft_now_s() - start_s,
                                .damaged = c->damaged,
                                .timeouts = c->shooting.timeouts,
                                .disturbed = c->shooting.disturbed};
}

const char *weft_night_why_early(const weft_camera_at_work *c, const char *failure)
{
    if (c->code != WEFT_OK)
        return c->failure.message;
    if (c->found + c->taken == c->session->shot_count)
        return NULL;
    return failure ? failure : weft_night_stopped;
}

weft_code weft_night_overview_write(const weft_night *night, const weft_camera_at_work *camera, int count,
                                    double start_s, const char *why, weft_error *error)
{
    weft_status_share share[WEFT_CAMERAS_MAX];
    if (!night->status || !night->rig->first)
        return WEFT_OK;
    for (int i = 0; i < count; i++) {
        const weft_camera_at_work *c = &camera[i];
        share[i] = (weft_status_share){.camera = c->rig->camera_name,
                                       .counts = weft_night_counts(c, start_s),
                                       .failure = c->code != WEFT_OK ? c->failure.message : NULL,
                                       .left_out = c->left_out};
    }
    return weft_status_overview_write(night->status, night->rig->sample, share, count, why, error);
}

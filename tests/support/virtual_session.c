#include "tests/support/virtual_session.h"

static weft_code take(const virtual_session *request, weft_virtual_rig *rig, const volatile sig_atomic_t *stop,
                      const weft_progress *progress, weft_capture_summary *summary, weft_error *error)
{
    weft_capture capture;
    WEFT_TRY(weft_capture_begin(&request->capture, &rig->rig, progress, &capture, error));
    const weft_session *session = &capture.held[0].session;
    weft_code code = weft_truth_check_path(&request->truth, session, error);
    if (code == WEFT_OK)
        code = weft_capture_take(&capture, stop, progress, error);
    if (code == WEFT_OK)
        code = weft_truth_write(&request->truth, session, rig, progress, error);
    *summary = capture.summary;
    weft_capture_end(&capture);
    return code;
}

weft_code virtual_session_take(const virtual_session *request, const volatile sig_atomic_t *stop,
                               const weft_progress *progress, weft_capture_summary *summary, weft_error *error)
{
    weft_virtual_rig rig;
    *summary = (weft_capture_summary){0};
    WEFT_TRY(weft_virtual_rig_open(&request->rig, &rig, error));
    weft_code code = take(request, &rig, stop, progress, summary, error);
    weft_virtual_rig_close(&rig);
    return code;
}

weft_code virtual_session_rehearse(const virtual_session *request, weft_capture_rehearsal *rehearsal, weft_error *error)
{
    weft_virtual_rig rig;
    WEFT_TRY(weft_virtual_rig_open(&request->rig, &rig, error));
    weft_code code = weft_capture_rehearse(&request->capture, &rig.rig, rehearsal, error);
    weft_virtual_rig_close(&rig);
    return code;
}

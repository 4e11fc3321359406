#include "cli/capture_report.h"

#include "base/text/json_text.h"
#include "capture/capture.h"
#include "capture/shot_order.h"
#include "cli/command/describe.h"

#include <stdio.h>

/* ---- What would be done ---- */

static void report_rehearsal(const weft_common_options *common, const weft_capture_rehearsal *rehearsal)
{
    weft_command_say(common, "%d photographs: %d views, each with all its lights before the camera moves on",
                     rehearsal->shot_count, rehearsal->view_count);
    weft_command_say(common, "%d lights step aside for the camera", rehearsal->driven_aside);
    weft_command_say(common, "disk: %.2f GB; time: about %.0f s, at the %.1f ms that one photograph took",
                     (double)rehearsal->bytes * 1e-9, rehearsal->seconds_per_photograph * rehearsal->shot_count,
                     rehearsal->seconds_per_photograph * 1e3);
}

/* The views in the order in which the stage takes them. */
static void report_order(const weft_common_options *common, const weft_capture_rehearsal *rehearsal)
{
    const weft_shot *shot = rehearsal->session.shot;
    for (int i = 0, next; i < rehearsal->shot_count; i = next) {
        weft_angles view = shot[rehearsal->order[i]].view;
        for (next = i + 1; next < rehearsal->shot_count; next++) {
            weft_angles other = shot[rehearsal->order[next]].view;
            if (other.theta_rad != view.theta_rad || other.phi_rad != view.phi_rad)
                break;
        }
        weft_command_say(common, "view %5.1f %5.1f degrees: photographs %d to %d", weft_deg_of_rad(view.theta_rad),
                         weft_deg_of_rad(view.phi_rad), i + 1, next);
    }
}

static void report_stage(const weft_common_options *common, const weft_capture_rehearsal *rehearsal)
{
    const weft_stage_estimate *stage = &rehearsal->stage;
    double photographs_s = rehearsal->seconds_per_photograph * rehearsal->shot_count;
    weft_command_say(common, "%d photographs, %d lights step aside for the camera", rehearsal->shot_count,
                     rehearsal->driven_aside);
    weft_command_say(common, "disk: %.2f GB, and what the camera itself writes", (double)rehearsal->bytes * 1e-9);
    weft_command_say(common, "time: %.2f h for %d moves, %.2f h for photographs of %.2f s", stage->seconds / 3600,
                     stage->moves, photographs_s / 3600, rehearsal->seconds_per_photograph);
}

void weft_report_rehearsal(const weft_common_options *common, const weft_capture_rehearsal *rehearsal, bool in_order)
{
    if (in_order)
        report_order(common, rehearsal);
    (in_order ? report_stage : report_rehearsal)(common, rehearsal);
    if (weft_session_frame_count(&rehearsal->session) > 0)
        weft_command_say(common, "before them %d + %d dark and %d flat frames of the sensor",
                         rehearsal->session.dark_frames, rehearsal->session.dark_frames,
                         rehearsal->session.flat_frames);
}

/* ---- What a check found ---- */

static json_t *pack_check(const weft_preflight *result, int kind)
{
    const weft_preflight_limits *limits = &weft_preflight_limits_of[kind];
    const weft_preflight_check *check = &result->check[kind];
    double limit = kind == WEFT_CHECK_DISK ? result->disk_needed : limits->limit;
    json_t *packed = json_pack("{s:s, s:b, s:f, s:f, s:s}", "check", limits->name, "passed", check->passed, "value",
                               check->value * limits->scale, "limit", limit * limits->scale, "unit", limits->unit);
    if (limits->of_view)
        weft_json_put(&packed, "view",
                      json_pack("[ff]", weft_deg_of_rad(check->view.theta_rad), weft_deg_of_rad(check->view.phi_rad)));
    if (!check->passed)
        weft_json_put(&packed, "advice", json_string(limits->advice));
    return packed;
}

static void report_check(const weft_common_options *common, const weft_preflight *result, int kind)
{
    const weft_preflight_limits *limits = &weft_preflight_limits_of[kind];
    const weft_preflight_check *check = &result->check[kind];
    double limit = kind == WEFT_CHECK_DISK ? result->disk_needed : limits->limit;
    char view[64] = "";
    if (!check->done) {
        weft_command_say(common, "%-4s %-15s not known", "-", limits->name);
        return;
    }
    if (limits->of_view)
        snprintf(view, sizeof view, ", seen from %.0f %.0f degrees", weft_deg_of_rad(check->view.theta_rad),
                 weft_deg_of_rad(check->view.phi_rad));
    weft_command_say(common, "%-4s %-15s %.3g %s (%s %.3g)%s", check->passed ? "pass" : "FAIL", limits->name,
                     check->value * limits->scale, limits->unit, limits->is_least ? "at least" : "at most",
                     limit * limits->scale, view);
    if (!check->passed)
        weft_command_say(common, "     %s", limits->advice);
}

weft_code weft_report_checks(const weft_common_options *common, const weft_preflight *result, weft_error *error)
{
    weft_code code = WEFT_OK;
    for (int kind = 0; kind < WEFT_CHECK_KINDS && code == WEFT_OK; kind++) {
        if (!common->json) {
            report_check(common, result, kind);
        } else if (result->check[kind].done) {
            json_t *packed = pack_check(result, kind);
            code = weft_command_describe(common, "check", packed, error);
            json_decref(packed);
        }
    }
    return code;
}

/* ---- Several cameras ---- */

static weft_code order_shots(const weft_capture_request *request, const weft_rig *rig, weft_session *sessions,
                             weft_shot_order *order, weft_error *error)
{
    const weft_session *all[WEFT_CAMERAS_MAX];
    int count = 0;
    for (const weft_rig *one = rig; one; one = one->next, count++) {
        WEFT_TRY(weft_session_of_plan(request->folder, request->plan, one, &sessions[count], error));
        all[count] = &sessions[count];
    }
    return weft_shot_order_make(rig, all, count, order, error);
}

weft_code weft_report_synchronised_shots(const weft_common_options *common, const weft_capture_request *request,
                                         const weft_rig *rig, weft_error *error)
{
    weft_session sessions[WEFT_CAMERAS_MAX] = {0};
    weft_shot_order order = {0};
    int shots = 0;
    weft_code code = order_shots(request, rig, sessions, &order, error);
    for (int i = 0; i < WEFT_CAMERAS_MAX; i++) {
        shots += sessions[i].shot_count;
        weft_session_free(&sessions[i]);
    }
    if (code == WEFT_OK)
        weft_command_say(common, "together: %d photographs in %d synchronised shots, %.2f h of moves", shots,
                         order.count, order.stage.seconds / 3600);
    weft_shot_order_free(&order);
    return code;
}

#include "cli/describe.h"

#include "base/text/json_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = 1024 };

/* One value on one line: numbers short, strings bare. False where memory is short. */
static bool format_value(const json_t *value, char *text, size_t size)
{
    char *dumped = NULL;
    if (json_is_real(value))
        snprintf(text, size, "%.6g", json_real_value(value));
    else if (json_is_string(value))
        snprintf(text, size, "%s", json_string_value(value));
    else if (json_is_array(value) && json_array_size(value) == 2 && json_is_integer(json_array_get(value, 0)))
        snprintf(text, size, "%lld x %lld", json_integer_value(json_array_get(value, 0)),
                 json_integer_value(json_array_get(value, 1)));
    else if ((dumped = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(6))))
        snprintf(text, size, "%s", dumped);
    else
        return false;
    free(dumped);
    return true;
}

static bool is_list_of_objects(const json_t *value)
{
    return json_is_array(value) && json_is_object(json_array_get(value, 0));
}

static bool say_object(const weft_common_options *common, json_t *object, int indent);

static bool say_member(const weft_common_options *common, const char *name, json_t *value, int indent)
{
    if (json_is_object(value)) {
        weft_command_say(common, "%*s%s:", indent, "", name);
        return say_object(common, value, indent + 2);
    }
    if (is_list_of_objects(value)) {
        for (size_t i = 0; i < json_array_size(value); i++) {
            weft_command_say(common, "%*s%s %zu:", indent, "", name, i);
            if (!say_object(common, json_array_get(value, i), indent + 2))
                return false;
        }
        return true;
    }
    char text[LINE_SIZE];
    if (!format_value(value, text, sizeof text))
        return false;
    weft_command_say(common, "%*s%s: %s", indent, "", name, text);
    return true;
}

static bool say_object(const weft_common_options *common, json_t *object, int indent)
{
    const char *name;
    json_t *value;
    json_object_foreach (object, name, value) {
        if (!say_member(common, name, value, indent))
            return false;
    }
    return true;
}

static bool say_event(const weft_common_options *common, const char *event, json_t *object)
{
    json_t *whole = json_pack("{s:s}", "event", event);
    char *line = json_object_update(whole, object) == 0 ? json_dumps(whole, JSON_COMPACT) : NULL;
    bool is_complete = line != NULL;
    if (is_complete)
        weft_command_event(common, line);
    free(line);
    json_decref(whole);
    return is_complete;
}

weft_code weft_command_describe(const weft_common_options *common, const char *event, json_t *object, weft_error *error)
{
    bool said = common->json ? say_event(common, event, object) : say_object(common, object, 0);
    return said ? WEFT_OK : weft_fail_memory(error, "description", 0);
}

/* ---- What would be done ---- */

static void say_rehearsal(const weft_common_options *common, const weft_capture_rehearsal *rehearsal)
{
    weft_command_say(common, "%d photographs: %d views, each with all its lights before the camera moves on",
                     rehearsal->shot_count, rehearsal->view_count);
    weft_command_say(common, "%d lights step aside for the camera", rehearsal->driven_aside);
    weft_command_say(common, "disk: %.2f GB; time: about %.0f s, at the %.1f ms that one photograph took",
                     (double)rehearsal->bytes * 1e-9, rehearsal->seconds_per_photograph * rehearsal->shot_count,
                     rehearsal->seconds_per_photograph * 1e3);
}

/* The views in the order in which the stage takes them. */
static void say_order(const weft_common_options *common, const weft_capture_rehearsal *rehearsal)
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

static void say_stage(const weft_common_options *common, const weft_capture_rehearsal *rehearsal)
{
    const weft_stage_estimate *stage = &rehearsal->stage;
    double photographs_s = rehearsal->seconds_per_photograph * rehearsal->shot_count;
    weft_command_say(common, "%d photographs, %d lights step aside for the camera", rehearsal->shot_count,
                     rehearsal->driven_aside);
    weft_command_say(common, "disk: %.2f GB, and what the camera itself writes", (double)rehearsal->bytes * 1e-9);
    weft_command_say(common, "time: %.2f h for %d moves, %.2f h for photographs of %.2f s", stage->seconds / 3600,
                     stage->moves, photographs_s / 3600, rehearsal->seconds_per_photograph);
    if (stage->bound_seconds > 0)
        weft_command_say(common, "no order of these poses takes less than %.2f h of moves: this one takes %.1f %% more",
                         stage->bound_seconds / 3600, 100 * (stage->seconds / stage->bound_seconds - 1));
}

void weft_say_rehearsal(const weft_common_options *common, const weft_capture_rehearsal *rehearsal, bool in_order)
{
    if (in_order)
        say_order(common, rehearsal);
    (in_order ? say_stage : say_rehearsal)(common, rehearsal);
    if (weft_session_frame_count(&rehearsal->session) > 0)
        weft_command_say(common, "before them %d + %d dark and %d flat frames of the sensor",
                         rehearsal->session.dark_frames, rehearsal->session.dark_frames,
                         rehearsal->session.flat_frames);
}

/* ---- What a check found ---- */

static json_t *pack_check(const weft_preflight *result, int kind)
{
    const weft_preflight_meaning *meaning = &weft_preflight_meaning_of[kind];
    const weft_preflight_check *check = &result->check[kind];
    double limit = kind == WEFT_CHECK_DISK ? result->disk_needed : meaning->limit;
    json_t *packed = json_pack("{s:s, s:b, s:f, s:f, s:s}", "check", meaning->name, "passed", check->passed, "value",
                               check->value * meaning->scale, "limit", limit * meaning->scale, "unit", meaning->unit);
    if (meaning->of_view)
        weft_json_put(&packed, "view",
                      json_pack("[ff]", weft_deg_of_rad(check->view.theta_rad), weft_deg_of_rad(check->view.phi_rad)));
    if (!check->passed)
        weft_json_put(&packed, "advice", json_string(meaning->advice));
    return packed;
}

static void say_check(const weft_common_options *common, const weft_preflight *result, int kind)
{
    const weft_preflight_meaning *meaning = &weft_preflight_meaning_of[kind];
    const weft_preflight_check *check = &result->check[kind];
    double limit = kind == WEFT_CHECK_DISK ? result->disk_needed : meaning->limit;
    char view[64] = "";
    if (!check->done) {
        weft_command_say(common, "%-4s %-15s not known", "-", meaning->name);
        return;
    }
    if (meaning->of_view)
        snprintf(view, sizeof view, ", seen from %.0f %.0f degrees", weft_deg_of_rad(check->view.theta_rad),
                 weft_deg_of_rad(check->view.phi_rad));
    weft_command_say(common, "%-4s %-15s %.3g %s (%s %.3g)%s", check->passed ? "pass" : "FAIL", meaning->name,
                     check->value * meaning->scale, meaning->unit, meaning->is_least ? "at least" : "at most",
                     limit * meaning->scale, view);
    if (!check->passed)
        weft_command_say(common, "     %s", meaning->advice);
}

weft_code weft_say_checks(const weft_common_options *common, const weft_preflight *result, weft_error *error)
{
    weft_code code = WEFT_OK;
    for (int kind = 0; kind < WEFT_CHECK_KINDS && code == WEFT_OK; kind++) {
        if (!common->json) {
            say_check(common, result, kind);
        } else if (result->check[kind].done) {
            json_t *packed = pack_check(result, kind);
            code = weft_command_describe(common, "check", packed, error);
            json_decref(packed);
        }
    }
    return code;
}

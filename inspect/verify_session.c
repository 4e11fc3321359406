#include "inspect/verify.h"

#include "base/text/json_text.h"
#include "capture/session_check.h"

#include <stdio.h>
#include <string.h>

static json_t *pack_problem(const weft_session_problem *problem)
{
    json_t *packed = json_pack("{s:s}", "kind", weft_session_problem_name[problem->kind]);
    if (problem->shot >= 0)
        weft_json_put(&packed, "shot", json_integer(problem->shot));
    if (problem->frame >= 0)
        weft_json_put(&packed, "frame", json_integer(problem->frame));
    weft_json_put(&packed, "text", weft_json_text(problem->text, strlen(problem->text)));
    return packed;
}

static weft_code put_problems(const weft_session_problems *found, json_t *problems, weft_error *error)
{
    for (int i = 0; i < found->count; i++)
        if (json_array_append_new(problems, pack_problem(&found->problem[i])) != 0)
            return weft_fail_memory(error, "problems of a session", 0);
    return WEFT_OK;
}

static int count_frames(const weft_session *session)
{
    int taken = 0;
    for (int frame = 0; frame < weft_session_frame_count(session); frame++)
        taken += session->frame[frame].taken;
    return taken;
}

static weft_code put_count(const weft_session *session, json_t *description, weft_error *error)
{
    int taken = 0;
    for (int shot = 0; shot < session->shot_count; shot++)
        taken += session->record[shot].taken;
    json_t *verified = json_pack("{s:i}", "photographs", taken);
    if (session->frame) {
        weft_json_put(&verified, "sensor_frames", json_integer(count_frames(session)));
        weft_json_put(&verified, "sensor_frames_wanted", json_integer(weft_session_frame_count(session)));
    }
    bool put = verified && json_object_set_new(description, "verified", verified) == 0;
    return put ? WEFT_OK : weft_fail_memory(error, "description", 0);
}

/* "session 'scarf': 2 missing, 1 damaged". */
static weft_code fail_of(const weft_session *session, const weft_session_problems *problems, weft_error *error)
{
    int counts[WEFT_PROBLEM_KINDS] = {0};
    char text[128] = "";
    if (problems->count == 1)
        return weft_fail(error, WEFT_BAD_INPUT, "%s", problems->problem[0].text);
    for (int i = 0; i < problems->count; i++)
        counts[problems->problem[i].kind]++;
    for (int kind = 0; kind < WEFT_PROBLEM_KINDS; kind++) {
        size_t length = strlen(text);
        if (counts[kind] > 0)
            snprintf(text + length, sizeof text - length, "%s%d %s", length ? ", " : "", counts[kind],
                     weft_session_problem_name[kind]);
    }
    return weft_fail(error, WEFT_BAD_INPUT, "session '%s': %s", session->folder, text);
}

weft_code weft_verify_session(const weft_session *session, const weft_progress *progress, json_t *description,
                              weft_error *error)
{
    weft_session_problems problems;
    WEFT_TRY(weft_session_check(session, progress, &problems, error));
    weft_code code = put_count(session, description, error);
    if (code == WEFT_OK && problems.count > 0) {
        json_t *list = json_array();
        code = put_problems(&problems, list, error);
        if (json_object_set_new(description, "faults", list) != 0)
            code = weft_fail_memory(error, "problems of a session", 0);
        if (code == WEFT_OK)
            code = fail_of(session, &problems, error);
    }
    weft_session_problems_free(&problems);
    return code;
}

/* ---- Several cameras ---- */

/* Moves the problems of one camera to those of all, and adds its photographs to theirs. */
static weft_code join(json_t *one, json_t *problems, json_int_t *photographs, weft_error *error)
{
    json_t *verified = json_object_get(one, "verified"), *own = json_object_get(one, "faults");
    *photographs += json_integer_value(json_object_get(verified, "photographs"));
    if (own && json_array_extend(problems, own) != 0)
        return weft_fail_memory(error, "problems of a session", 0);
    json_object_del(one, "faults");
    return WEFT_OK;
}

/* What lies beside the sessions of the cameras. */
static weft_code check_beside(const char *folder, const weft_camera_list *list, json_t *problems, weft_error *error)
{
    weft_session_problems found = {0};
    weft_code code = weft_camera_folder_check(folder, list, &found, error);
    if (code == WEFT_OK)
        code = put_problems(&found, problems, error);
    weft_session_problems_free(&found);
    return code;
}

static weft_code check_all(const char *folder, const weft_session *sessions, const weft_camera_list *list,
                           const weft_progress *progress, json_t *description, json_t *problems, weft_error *error)
{
    json_int_t photographs = 0;
    WEFT_TRY(check_beside(folder, list, problems, error));
    for (int i = 0; i < list->count; i++) {
        json_t *one = json_array_get(json_object_get(description, "cameras"), (size_t)i);
        weft_code code = weft_verify_session(&sessions[i], progress, one, error);
        if (code != WEFT_OK && !json_object_get(one, "faults"))
            return code;
        WEFT_TRY(join(one, problems, &photographs, error));
    }
    json_t *verified = json_pack("{s:I}", "photographs", photographs);
    return json_object_set_new(description, "verified", verified) == 0 ? WEFT_OK
                                                                       : weft_fail_memory(error, "description", 0);
}

weft_code weft_verify_cameras(const char *folder, const weft_session *sessions, const weft_camera_list *list,
                              const weft_progress *progress, json_t *description, weft_error *error)
{
    json_t *problems = json_array();
    weft_code code = problems ? check_all(folder, sessions, list, progress, description, problems, error)
                              : weft_fail_memory(error, "description", 0);
    size_t count = json_array_size(problems);
    if (code == WEFT_OK && count > 0 && json_object_set(description, "faults", problems) != 0)
        code = weft_fail_memory(error, "description", 0);
    if (code == WEFT_OK && count > 0) {
        const char *first = json_string_value(json_object_get(json_array_get(problems, 0), "text"));
        code = count == 1 ? weft_fail(error, WEFT_BAD_INPUT, "%s", first)
                          : weft_fail(error, WEFT_BAD_INPUT, "session '%s': %zu faults of %d cameras", folder, count,
                                      list->count);
    }
    json_decref(problems);
    return code;
}

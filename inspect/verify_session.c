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

static weft_code put_problems(const weft_session_problems *problems, json_t *description, weft_error *error)
{
    json_t *list = json_array();
    for (int i = 0; list && i < problems->count; i++)
        weft_json_append(&list, pack_problem(&problems->problem[i]));
    bool put = list && json_object_set_new(description, "faults", list) == 0;
    return put ? WEFT_OK : weft_fail_memory(error, "problems of a session", 0);
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
        code = put_problems(&problems, description, error);
        if (code == WEFT_OK)
            code = fail_of(session, &problems, error);
    }
    weft_session_problems_free(&problems);
    return code;
}

#include "inspect/verify.h"

#include "base/text/json_text.h"
#include "capture/session_check.h"

#include <string.h>

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

static weft_code put_problems(const weft_session_problems *found, json_t *problems, weft_error *error)
{
    for (int i = 0; i < found->count; i++) {
        const char *text = found->problem[i].text;
        json_t *packed = json_pack("{s:s s:o}", "kind", weft_session_problem_name[found->problem[i].kind], "text",
                                   weft_json_text(text, strlen(text)));
        if (!packed || json_array_append_new(problems, packed) != 0)
            return weft_fail_memory(error, "problems of a session", 0);
    }
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

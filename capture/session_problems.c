#include "capture/session_check.h"

#include <stdlib.h>
#include <string.h>

const char *const weft_session_problem_name[WEFT_PROBLEM_KINDS] = {"missing", "damaged", "duplicate", "unexpected"};

void weft_session_problems_free(weft_session_problems *problems)
{
    for (int i = 0; i < problems->count; i++)
        free(problems->problem[i].text);
    free(problems->problem);
    *problems = (weft_session_problems){0};
}

weft_code weft_session_problems_add(weft_session_problems *problems, weft_session_problem_kind kind, int shot,
                                    const char *text, weft_error *error)
{
    size_t bytes = ((size_t)problems->count + 1) * sizeof *problems->problem;
    char *copy = strdup(text);
    weft_session_problem *grown = copy ? realloc(problems->problem, bytes) : NULL;
    if (!grown) {
        free(copy);
        return weft_fail_memory(error, "problems of a session", bytes);
    }
    problems->problem = grown;
    problems->problem[problems->count++] = (weft_session_problem){kind, shot, -1, copy};
    return WEFT_OK;
}

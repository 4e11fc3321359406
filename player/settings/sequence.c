#include "player/settings/sequence.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "%d" or "%04d" in a name. */
typedef struct place {
    size_t start, end; /* in the name */
    int width;         /* 0 for "%d" */
} place;

static bool find_place(const char *pattern, place *found)
{
    const char *percent = strchr(pattern, '%');
    *found = (place){0};
    if (!percent || strchr(percent + 1, '%'))
        return false;
    const char *at = percent + 1;
    if (*at == '0' && isdigit((unsigned char)at[1]) && at[2] == 'd') {
        found->width = at[1] - '0';
        at += 2;
    }
    found->start = (size_t)(percent - pattern);
    found->end = (size_t)(at - pattern) + 1;
    return *at == 'd';
}

bool weft_sequence_is_pattern(const char *pattern)
{
    place found;
    return find_place(pattern, &found);
}

/* The caller frees; NULL where memory is short. */
static char *frame_name(const char *pattern, int number)
{
    place p;
    char *name;
    if (!find_place(pattern, &p))
        return strdup(pattern);
    int length = asprintf(&name, "%.*s%0*d%s", (int)p.start, pattern, p.width, number, pattern + p.end);
    return length < 0 ? NULL : name;
}

weft_code weft_sequence_draw(const char *pattern, const weft_path *path, double frames_per_second,
                             const weft_settings *settings, weft_player *player, const weft_progress *progress,
                             weft_error *error)
{
    int count;
    weft_settings at_frame = *settings;
    WEFT_TRY(weft_path_count_frames(path, frames_per_second, &count, error));
    for (int i = 0; i < count; i++) {
        weft_progress_report(progress, "drawing frames", i, count);
        weft_path_apply(path, path->time_s[0] + i / frames_per_second, &at_frame.scene);
        char *name = frame_name(pattern, i);
        if (!name)
            return weft_fail_memory(error, pattern, strlen(pattern));
        weft_code code = weft_settings_draw(name, player, &at_frame, NULL, error);
        free(name);
        WEFT_TRY(code);
    }
    weft_progress_report(progress, "drawing frames", count, count);
    return WEFT_OK;
}

#include "capture/session_check.h"

#include "base/atomic_file.h"
#include "capture/photograph_writer.h"

#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A shot of the plan: "FOLDER/NAME" without ".tif", and the most photographs of a bracket that it may have. */
typedef struct expected_shot {
    char name[64];
    int brackets;
} expected_shot;

/* Sorted by name. */
typedef struct expected_shots {
    int count;
    expected_shot *shot;
} expected_shots;

static int compare_names(const void *a, const void *b)
{
    const expected_shot *p = a, *q = b;
    return strcmp(p->name, q->name);
}

/* What a killed capture took of a shot has no line in the journal yet. */
static weft_code list_expected(const weft_session *session, expected_shots *expected, weft_error *error)
{
    size_t skipped = strlen(session->folder) + 1, count = (size_t)session->shot_count;
    *expected = (expected_shots){session->shot_count, calloc(count, sizeof *expected->shot)};
    if (!expected->shot)
        return weft_fail_memory(error, "names of photographs", count * sizeof *expected->shot);
    for (int i = 0; i < session->shot_count; i++) {
        char path[PATH_MAX];
        expected_shot *shot = &expected->shot[i];
        const weft_shot_record *record = &session->record[i];
        weft_session_photograph_path(session, i, path, sizeof path);
        snprintf(shot->name, sizeof shot->name, "%.*s", (int)(strlen(path) - skipped - strlen(".tif")), path + skipped);
        shot->brackets = record->taken ? record->bracket_count : WEFT_SESSION_MAX_BRACKETS;
    }
    qsort(expected->shot, count, sizeof *expected->shot, compare_names);
    return WEFT_OK;
}

/* A photograph, one of its bracket, or what the camera wrote for either. */
static bool belongs(const expected_shots *expected, const char *folder, const char *file)
{
    expected_shot key;
    int stem = (int)strcspn(file, "."), bracket = 0, read = 0;
    const char *ending = file + stem;
    if (sscanf(ending, ".bracket%1d%n", &bracket, &read) == 1)
        ending += read;
    if (snprintf(key.name, sizeof key.name, "%s/%.*s", folder, stem, file) >= (int)sizeof key.name)
        return false;
    const expected_shot *shot =
        bsearch(&key, expected->shot, (size_t)expected->count, sizeof *expected->shot, compare_names);
    return shot && bracket <= shot->brackets &&
           (strcmp(ending, ".tif") == 0 || strncmp(ending, ".original", strlen(".original")) == 0);
}

static bool is_folder_of_views(const expected_shots *expected, const char *folder)
{
    size_t length = strlen(folder);
    for (int i = 0; i < expected->count; i++) {
        const char *name = expected->shot[i].name;
        if (strncmp(name, folder, length) == 0 && name[length] == '/')
            return true;
    }
    return false;
}

/* ---- Looking through the folders ---- */

static const char sensor_folder[] = "sensor";

typedef struct search {
    const weft_session *session;
    expected_shots expected;
    weft_session_problems *problems;
} search;

static weft_code add(const search *s, const char *folder, const char *file, const char *what, weft_error *error)
{
    weft_error found;
    weft_error_set(&found, WEFT_BAD_INPUT, "'%s/%s%s%s' %s", s->session->folder, folder, folder[0] ? "/" : "", file,
                   what);
    return weft_session_problems_add(s->problems, WEFT_PROBLEM_UNEXPECTED, -1, found.message, error);
}

static bool is_frame(const weft_session *session, const char *file)
{
    size_t skipped = strlen(session->folder) + strlen("/sensor/");
    for (int frame = 0; frame < weft_session_frame_count(session); frame++) {
        char path[PATH_MAX];
        weft_session_frame_path(session, frame, path, sizeof path);
        if (strcmp(path + skipped, file) == 0)
            return true;
    }
    return false;
}

static weft_code look_into(const search *s, const char *folder, weft_error *error)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", s->session->folder, folder);
    DIR *listing = opendir(path);
    weft_code code = listing ? WEFT_OK : weft_fail_errno(error, "list folder", path);
    for (struct dirent *entry; code == WEFT_OK && (entry = readdir(listing));) {
        bool known = strcmp(folder, sensor_folder) == 0 ? is_frame(s->session, entry->d_name)
                                                        : belongs(&s->expected, folder, entry->d_name);
        if (entry->d_name[0] != '.' && !known)
            code = add(s, folder, entry->d_name, "belongs to no shot of the plan", error);
    }
    if (listing)
        closedir(listing);
    return code;
}

static weft_code look_at_entry(const search *s, const char *name, weft_error *error)
{
    if (strcmp(name, weft_unfinished_photograph) == 0 || weft_is_left_over(name, "session.json"))
        return add(s, "", name, "was left by a capture that was killed, or still runs", error);
    if (name[0] == '.' || strcmp(name, "session.json") == 0 || strcmp(name, "journal.jsonl") == 0)
        return WEFT_OK;
    bool is_sensor = strcmp(name, sensor_folder) == 0 && weft_session_frame_count(s->session) > 0;
    if (is_sensor || is_folder_of_views(&s->expected, name))
        return look_into(s, name, error);
    return add(s, "", name, "is no part of a session", error);
}

static weft_code look(const search *s, weft_error *error)
{
    DIR *listing = opendir(s->session->folder);
    weft_code code = listing ? WEFT_OK : weft_fail_errno(error, "list folder", s->session->folder);
    for (struct dirent *entry; code == WEFT_OK && (entry = readdir(listing));)
        code = look_at_entry(s, entry->d_name, error);
    if (listing)
        closedir(listing);
    return code;
}

weft_code weft_find_unexpected(const weft_session *session, weft_session_problems *problems, weft_error *error)
{
    search s = {.session = session, .problems = problems};
    WEFT_TRY(list_expected(session, &s.expected, error));
    weft_code code = look(&s, error);
    free(s.expected.shot);
    return code;
}

/* ---- Beside the sessions of several cameras ---- */

static bool is_of_cameras(const weft_camera_list *list, const char *name)
{
    bool known = strcmp(name, weft_camera_list_file) == 0;
    for (int i = 0; i < list->count; i++)
        known = known || strcmp(name, list->name[i]) == 0;
    return known;
}

static weft_code look_beside(const char *folder, const char *name, const weft_camera_list *list,
                             weft_session_problems *problems, weft_error *error)
{
    bool left_over = weft_is_left_over(name, weft_camera_list_file);
    weft_error found;
    if (!left_over && (name[0] == '.' || is_of_cameras(list, name)))
        return WEFT_OK;
    weft_error_set(&found, WEFT_BAD_INPUT, "'%s/%s' %s", folder, name,
                   left_over ? "was left by a capture that was killed, or still runs" : "is no session of a camera");
    return weft_session_problems_add(problems, WEFT_PROBLEM_UNEXPECTED, -1, found.message, error);
}

weft_code weft_camera_folder_check(const char *folder, const weft_camera_list *list, weft_session_problems *problems,
                                   weft_error *error)
{
    DIR *listing = opendir(folder);
    weft_code code = listing ? WEFT_OK : weft_fail_errno(error, "list folder", folder);
    for (struct dirent *entry; code == WEFT_OK && (entry = readdir(listing));)
        code = look_beside(folder, entry->d_name, list, problems, error);
    if (listing)
        closedir(listing);
    return code;
}

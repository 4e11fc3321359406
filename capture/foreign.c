#include "capture/foreign.h"

#include "base/atomic_file.h"
#include "capture/photograph_writer.h"

#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The photographs of the plan as "FOLDER/NAME" without ".tif", sorted. */
typedef struct expected_names {
    int count;
    char (*name)[64];
} expected_names;

static int compare_names(const void *a, const void *b)
{
    return strcmp(a, b);
}

static weft_code list_expected(const weft_session *session, expected_names *names, weft_error *error)
{
    size_t skipped = strlen(session->folder) + 1;
    *names = (expected_names){session->shot_count, calloc((size_t)session->shot_count, sizeof *names->name)};
    if (!names->name)
        return weft_fail_memory(error, "names of photographs", (size_t)session->shot_count * sizeof *names->name);
    for (int shot = 0; shot < session->shot_count; shot++) {
        char path[PATH_MAX];
        weft_session_photograph_path(session, shot, path, sizeof path);
        snprintf(names->name[shot], sizeof *names->name, "%.*s", (int)(strlen(path) - skipped - strlen(".tif")),
                 path + skipped);
    }
    qsort(names->name, (size_t)names->count, sizeof *names->name, compare_names);
    return WEFT_OK;
}

/* A photograph, one of its bracket, or what the camera wrote for either. */
static bool belongs(const expected_names *names, const char *folder, const char *file)
{
    char name[PATH_MAX];
    int stem = (int)strcspn(file, "."), bracket, read = 0;
    const char *ending = file + stem;
    if (sscanf(ending, ".bracket%1d%n", &bracket, &read) == 1 && bracket <= WEFT_SESSION_MAX_BRACKETS)
        ending += read;
    snprintf(name, sizeof name, "%s/%.*s", folder, stem, file);
    return (strcmp(ending, ".tif") == 0 || strncmp(ending, ".original", strlen(".original")) == 0) &&
           bsearch(name, names->name, (size_t)names->count, sizeof *names->name, compare_names);
}

static bool is_folder_of_views(const expected_names *names, const char *folder)
{
    size_t length = strlen(folder);
    for (int i = 0; i < names->count; i++) {
        if (strncmp(names->name[i], folder, length) == 0 && names->name[i][length] == '/')
            return true;
    }
    return false;
}

/* ---- Looking through the folders ---- */

typedef struct search {
    const weft_session *session;
    expected_names names;
    weft_session_faults *faults;
} search;

static weft_code add(const search *s, const char *folder, const char *file, const char *what, weft_error *error)
{
    weft_error found;
    weft_error_set(&found, WEFT_BAD_INPUT, "'%s/%s%s%s' %s", s->session->folder, folder, folder[0] ? "/" : "", file,
                   what);
    return weft_session_faults_add(s->faults, WEFT_FAULT_FOREIGN, -1, found.message, error);
}

static weft_code look_at_view(const search *s, const char *folder, weft_error *error)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", s->session->folder, folder);
    DIR *listing = opendir(path);
    weft_code code = listing ? WEFT_OK : weft_fail_errno(error, "list folder", path);
    for (struct dirent *entry; code == WEFT_OK && (entry = readdir(listing));) {
        if (entry->d_name[0] != '.' && !belongs(&s->names, folder, entry->d_name))
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
    if (is_folder_of_views(&s->names, name))
        return look_at_view(s, name, error);
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

weft_code weft_find_foreign(const weft_session *session, weft_session_faults *faults, weft_error *error)
{
    search s = {.session = session, .faults = faults};
    WEFT_TRY(list_expected(session, &s.names, error));
    weft_code code = look(&s, error);
    free(s.names.name);
    return code;
}

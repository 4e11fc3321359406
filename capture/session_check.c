#include "capture/session_check.h"

#include "base/atomic_file.h"
#include "base/picture/image.h"
#include "capture/photograph_writer.h"

#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *const weft_session_problem_name[WEFT_PROBLEM_KINDS] = {"missing", "damaged", "duplicate", "unexpected"};

void weft_session_problems_free(weft_session_problems *problems)
{
    for (int i = 0; i < problems->count; i++)
        free(problems->problem[i].text);
    free(problems->problem);
    *problems = (weft_session_problems){0};
}

static weft_code add_problem(weft_session_problems *problems, weft_session_problem_kind kind, int shot,
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

/* What sorts shots so that those of one checksum follow each other, the first one of the journal first. */
typedef struct signature {
    uint64_t bytes;
    uint32_t crc32;
    int line, shot;
} signature;

static int compare_signatures(const void *a, const void *b)
{
    const signature *p = a, *q = b;
    if (p->bytes != q->bytes)
        return p->bytes < q->bytes ? -1 : 1;
    if (p->crc32 != q->crc32)
        return p->crc32 < q->crc32 ? -1 : 1;
    return p->line - q->line;
}

static int list_signatures(const weft_session *session, signature *list)
{
    int count = 0;
    for (int shot = 0; shot < session->shot_count; shot++) {
        const weft_shot_record *record = &session->record[shot];
        if (record->taken)
            list[count++] = (signature){record->bytes, record->crc32, record->line, shot};
    }
    qsort(list, (size_t)count, sizeof *list, compare_signatures);
    return count;
}

/* Files that cannot be read are a problem of another kind. */
static bool same_contents(const char *a, const char *b, size_t size)
{
    char *first = NULL, *second = NULL;
    size_t first_size = 0, second_size = 0;
    bool same = weft_read_file(a, size, &first, &first_size, NULL) == WEFT_OK &&
                weft_read_file(b, size, &second, &second_size, NULL) == WEFT_OK && first_size == second_size &&
                memcmp(first, second, first_size) == 0;
    free(first);
    free(second);
    return same;
}

static weft_code compare(const weft_session *session, const signature *first, const signature *second,
                         weft_session_problems *problems, weft_error *error)
{
    char path[PATH_MAX], before[PATH_MAX];
    weft_error what;
    weft_session_photograph_path(session, first->shot, before, sizeof before);
    weft_session_photograph_path(session, second->shot, path, sizeof path);
    if (!same_contents(before, path, first->bytes))
        return WEFT_OK;
    weft_error_set(&what, WEFT_BAD_INPUT, "'%s' has the bytes of shot %d, '%s'", path, first->shot, before);
    return add_problem(problems, WEFT_PROBLEM_DUPLICATE, second->shot, what.message, error);
}

static bool alike(const signature *a, const signature *b)
{
    return a->bytes == b->bytes && a->crc32 == b->crc32;
}

static weft_code find_duplicates(const weft_session *session, weft_session_problems *problems, weft_error *error)
{
    size_t bytes = (size_t)session->shot_count * sizeof(signature);
    signature *list = malloc(bytes);
    if (!list)
        return weft_fail_memory(error, "checksums of a session", bytes);
    int count = list_signatures(session, list), first = 0;
    weft_code code = WEFT_OK;
    for (int i = 1; i < count && code == WEFT_OK; i++) {
        if (alike(&list[first], &list[i]))
            code = compare(session, &list[first], &list[i], problems, error);
        else
            first = i;
    }
    free(list);
    return code;
}

/* ---- One shot ---- */

/* What the journal says of one photograph. */
typedef struct expected_file {
    uint64_t bytes;
    uint32_t crc32;
} expected_file;

static weft_code check_bytes(const char *path, const expected_file *record, weft_error *error)
{
    uint64_t bytes = 0;
    uint32_t crc32 = 0;
    WEFT_TRY(weft_file_crc(path, &bytes, &crc32, error));
    if (bytes != record->bytes)
        return weft_fail(error, WEFT_DAMAGED, "'%s' has %llu bytes, but %llu in the journal", path,
                         (unsigned long long)bytes, (unsigned long long)record->bytes);
    if (crc32 != record->crc32)
        return weft_fail(error, WEFT_DAMAGED, "'%s' has the checksum %08x, but %08x in the journal", path, crc32,
                         record->crc32);
    return WEFT_OK;
}

static weft_code check_picture(const weft_session *session, const char *path, weft_error *error)
{
    const weft_camera *camera = &session->camera;
    size_t bytes = (size_t)camera->width * (size_t)camera->height * 3 * sizeof(uint16_t);
    uint16_t *samples = malloc(bytes);
    weft_code code = samples ? weft_photograph_read(path, camera->width, camera->height, session->bits, samples, error)
                             : weft_fail_memory(error, "photograph", bytes);
    free(samples);
    return code;
}

static weft_code check_file(const weft_session *session, const char *path, expected_file expected,
                            weft_session_problem_kind *kind, weft_error *what)
{
    *kind = access(path, F_OK) == 0 ? WEFT_PROBLEM_DAMAGED : WEFT_PROBLEM_MISSING;
    WEFT_TRY(check_bytes(path, &expected, what));
    return check_picture(session, path, what);
}

/* What is wrong with a shot is an error of `what`, and its kind. */
static weft_code check_shot(const weft_session *session, int shot, weft_session_problem_kind *kind, weft_error *what)
{
    char path[PATH_MAX];
    weft_session_photograph_path(session, shot, path, sizeof path);
    const weft_shot_record *record = &session->record[shot];
    WEFT_TRY(check_file(session, path, (expected_file){record->bytes, record->crc32}, kind, what));
    for (int i = 0; i < record->bracket_count; i++) {
        const weft_bracket_record *bracket = &record->bracket[i];
        weft_session_bracket_path(session, shot, i, path, sizeof path);
        WEFT_TRY(check_file(session, path, (expected_file){bracket->bytes, bracket->crc32}, kind, what));
    }
    return WEFT_OK;
}

/* ---- All of them ---- */

/* What the threads that check shots share. */
typedef struct shot_checks {
    weft_session_problems *problems;
    const weft_progress *progress;
    long done, total;
    weft_code code;
    weft_error *error;
} shot_checks;

/* Short memory is no problem of the session. */
static void note(shot_checks *checks, int shot, weft_session_problem_kind kind, weft_code found, const weft_error *what)
{
    weft_progress_report(checks->progress, "checking photographs", ++checks->done, checks->total);
    if (found == WEFT_OK || checks->code != WEFT_OK)
        return;
    if (weft_class_of(found) == WEFT_BAD_INPUT) {
        checks->code = add_problem(checks->problems, kind, shot, what->message, checks->error);
        return;
    }
    checks->code = found;
    if (checks->error)
        *checks->error = *what;
}

static long count_taken(const weft_session *session)
{
    long taken = 0;
    for (int shot = 0; shot < session->shot_count; shot++)
        taken += session->record[shot].taken;
    return taken;
}

static weft_code check_shots(const weft_session *session, const weft_progress *progress,
                             weft_session_problems *problems, weft_error *error)
{
    shot_checks checks = {.problems = problems, .progress = progress, .total = count_taken(session), .error = error};
#pragma omp parallel for schedule(dynamic, 16)
    for (int shot = 0; shot < session->shot_count; shot++) {
        if (!session->record[shot].taken)
            continue;
        weft_error what = {0};
        weft_session_problem_kind kind = WEFT_PROBLEM_MISSING;
        weft_code found = check_shot(session, shot, &kind, &what);
#pragma omp critical
        note(&checks, shot, kind, found, &what);
    }
    return checks.code;
}

/* ---- Frames of the sensor ---- */

static weft_code check_frames(const weft_session *session, weft_session_problems *problems, weft_error *error)
{
    for (int frame = 0; frame < weft_session_frame_count(session); frame++) {
        const weft_frame_record *record = &session->frame[frame];
        char path[PATH_MAX];
        weft_error what = {0};
        weft_session_problem_kind kind = WEFT_PROBLEM_MISSING;
        weft_session_frame_path(session, frame, path, sizeof path);
        weft_code found = record->taken
                              ? check_file(session, path, (expected_file){record->bytes, record->crc32}, &kind, &what)
                              : WEFT_OK;
        if (weft_class_of(found) == WEFT_BAD_INPUT) {
            WEFT_TRY(add_problem(problems, kind, -1, what.message, error));
            problems->problem[problems->count - 1].frame = frame;
        } else if (found != WEFT_OK) {
            if (error)
                *error = what;
            return found;
        }
    }
    return WEFT_OK;
}

/* ---- Unexpected files ---- */

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
    return add_problem(s->problems, WEFT_PROBLEM_UNEXPECTED, -1, found.message, error);
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

/* Adds every file, and every folder of files, that belongs to no shot of the plan and is no part of a session; and what
 * a killed capture leaves. Other hidden files are ignored. Errors: WEFT_SYSTEM. */
static weft_code find_unexpected(const weft_session *session, weft_session_problems *problems, weft_error *error)
{
    search s = {.session = session, .problems = problems};
    WEFT_TRY(list_expected(session, &s.expected, error));
    weft_code code = look(&s, error);
    free(s.expected.shot);
    return code;
}

/* ---- The whole session ---- */

static int compare_problems(const void *a, const void *b)
{
    const weft_session_problem *p = a, *q = b;
    int shots = (p->shot > q->shot) - (p->shot < q->shot);
    return shots ? shots : p->frame - q->frame;
}

weft_code weft_session_check(const weft_session *session, const weft_progress *progress,
                             weft_session_problems *problems, weft_error *error)
{
    *problems = (weft_session_problems){0};
    weft_code code = check_frames(session, problems, error);
    if (code == WEFT_OK)
        code = check_shots(session, progress, problems, error);
    if (code == WEFT_OK)
        code = find_duplicates(session, problems, error);
    if (problems->count > 1)
        qsort(problems->problem, (size_t)problems->count, sizeof *problems->problem, compare_problems);
    if (code == WEFT_OK)
        code = find_unexpected(session, problems, error);
    if (code != WEFT_OK)
        weft_session_problems_free(problems);
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
    return add_problem(problems, WEFT_PROBLEM_UNEXPECTED, -1, found.message, error);
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

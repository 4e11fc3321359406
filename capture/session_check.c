#include "capture/session_check.h"

#include "base/atomic_file.h"
#include "base/picture/image.h"
#include "capture/photograph_writer.h"

#include <limits.h>
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
    return weft_session_problems_add(problems, WEFT_PROBLEM_DUPLICATE, second->shot, what.message, error);
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
        checks->code = weft_session_problems_add(checks->problems, kind, shot, what->message, checks->error);
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
            WEFT_TRY(weft_session_problems_add(problems, kind, -1, what.message, error));
            problems->problem[problems->count - 1].frame = frame;
        } else if (found != WEFT_OK) {
            if (error)
                *error = what;
            return found;
        }
    }
    return WEFT_OK;
}

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
        code = weft_find_unexpected(session, problems, error);
    if (code != WEFT_OK)
        weft_session_problems_free(problems);
    return code;
}

#include "capture/session_check.h"

#include "base/atomic_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

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

weft_code weft_find_duplicates(const weft_session *session, weft_session_problems *problems, weft_error *error)
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

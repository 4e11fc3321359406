#include "btf/session/session.h"

#include "base/atomic_file.h"
#include "base/text/json_text.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_JOURNAL_BYTES = 1 << 30 };

static void journal_path(const weft_session *session, char path[PATH_MAX])
{
    snprintf(path, PATH_MAX, "%s/journal.jsonl", session->folder);
}

/* ---- Reading ---- */

static bool unpack_bracket(json_t *json, weft_bracket_record *bracket)
{
    json_int_t bytes, crc32;
    if (json_unpack(json, "{sF sI sI}", "exposure_s", &bracket->exposure_s, "bytes", &bytes, "crc32", &crc32) != 0 ||
        bytes < 0 || crc32 < 0 || crc32 > UINT32_MAX || !(bracket->exposure_s > 0))
        return false;
    bracket->bytes = (uint64_t)bytes;
    bracket->crc32 = (uint32_t)crc32;
    return true;
}

static bool unpack_brackets(json_t *list, weft_shot_record *record)
{
    size_t count = json_array_size(list);
    if ((list && !json_is_array(list)) || count > WEFT_SESSION_MAX_BRACKETS)
        return false;
    for (size_t i = 0; i < count; i++) {
        if (!unpack_bracket(json_array_get(list, i), &record->bracket[i]))
            return false;
    }
    record->bracket_count = (int)count;
    return true;
}

static bool unpack_record(json_t *json, json_int_t *shot, weft_shot_record *record)
{
    json_int_t viewpoint, bytes, crc32;
    const char *key = json_object_get(json, "stay") ? "stay" : "viewpoint"; /* before and since 0.2 */
    if (json_unpack(json, "{sI sI sF sI sI}", "shot", shot, key, &viewpoint, "exposure_s", &record->exposure_s, "bytes",
                    &bytes, "crc32", &crc32) != 0)
        return false;
    if (bytes < 0 || crc32 < 0 || crc32 > UINT32_MAX || viewpoint < 0 || viewpoint >= WEFT_SESSION_MAX_SHOTS ||
        !(record->exposure_s > 0) || !unpack_brackets(json_object_get(json, "brackets"), record))
        return false;
    record->viewpoint = (int)viewpoint;
    record->taken = true;
    record->bytes = (uint64_t)bytes;
    record->crc32 = (uint32_t)crc32;
    return true;
}

/* A line {"frame":...} is of a frame of the sensor. */
static bool unpack_frame(json_t *json, weft_session *session)
{
    json_int_t frame;
    weft_bracket_record file;
    if (json_unpack(json, "{sI}", "frame", &frame) != 0 || frame < 0 || frame >= weft_session_frame_count(session) ||
        !unpack_bracket(json, &file))
        return false;
    session->frame[frame] = (weft_frame_record){true, file.exposure_s, file.bytes, file.crc32};
    return true;
}

static weft_code read_line(weft_session *session, const char *path, int line, const char *text, size_t length,
                           weft_error *error)
{
    json_error_t where;
    errno = 0;
    json_t *json = json_loadb(text, length, 0, &where);
    json_int_t shot = -1;
    weft_shot_record record = {0};
    bool is_frame = json && json_object_get(json, "frame");
    bool understood = json && (is_frame ? unpack_frame(json, session) : unpack_record(json, &shot, &record));
    json_decref(json);
    if (!understood)
        return weft_json_fail(error, WEFT_BAD_INPUT, "'%s': line %d is not a journal line", path, line);
    if (is_frame)
        return WEFT_OK;
    if (shot < 0 || shot >= session->shot_count)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': line %d names shot %lld, the plan has %d", path, line,
                         (long long)shot, session->shot_count);
    record.line = line;
    session->record[shot] = record;
    return WEFT_OK;
}

/* What follows the last newline was cut by a crash. */
static weft_code read_lines(weft_session *session, const char *path, const char *text, size_t size, weft_error *error)
{
    int line = 1;
    const char *end_of_text = text + size;
    for (const char *end; (end = memchr(text, '\n', (size_t)(end_of_text - text))); text = end + 1, line++)
        WEFT_TRY(read_line(session, path, line, text, (size_t)(end - text), error));
    return WEFT_OK;
}

weft_code weft_journal_read(weft_session *session, weft_error *error)
{
    char path[PATH_MAX], *text = NULL;
    size_t size;
    journal_path(session, path);
    if (access(path, F_OK) != 0)
        return WEFT_OK;
    WEFT_TRY(weft_read_file(path, MAX_JOURNAL_BYTES, &text, &size, error));
    weft_code code = read_lines(session, path, text, size, error);
    free(text);
    return code;
}

/* ---- Appending ---- */

/* Offset just behind the last newline: a crash can leave a cut line after it. */
static off_t end_of_complete_lines(int descriptor)
{
    off_t end = lseek(descriptor, 0, SEEK_END);
    char byte;
    while (end > 0 && pread(descriptor, &byte, 1, end - 1) == 1 && byte != '\n')
        end--;
    return end;
}

static int append_text(const char *path, const char *text, size_t length)
{
    int descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return -1;
    off_t end = end_of_complete_lines(descriptor);
    ssize_t written = -1;
    if (end >= 0 && ftruncate(descriptor, end) == 0)
        written = pwrite(descriptor, text, length, end);
    int saved = errno;
    if (written >= 0 && (size_t)written < length) {
        saved = ENOSPC;
        written = -1;
    }
    close(descriptor);
    errno = saved;
    return written < 0 ? -1 : 0;
}

weft_code weft_session_sync(const weft_session *session, weft_error *error)
{
    char path[PATH_MAX];
    journal_path(session, path);
    weft_sync_folder_of(path);
    return weft_sync_file(path, error);
}

/* Room for a line of a shot with all its brackets. */
enum { LINE_SIZE = 1024 };

static int write_line(int shot, const weft_shot_record *record, char line[LINE_SIZE])
{
    int length =
        snprintf(line, LINE_SIZE, "{\"shot\":%d,\"viewpoint\":%d,\"exposure_s\":%.9g,\"bytes\":%llu,\"crc32\":%u", shot,
                 record->viewpoint, record->exposure_s, (unsigned long long)record->bytes, record->crc32);
    for (int i = 0; i < record->bracket_count; i++) {
        const weft_bracket_record *bracket = &record->bracket[i];
        length += snprintf(line + length, (size_t)(LINE_SIZE - length),
                           "%s{\"exposure_s\":%.9g,\"bytes\":%llu,\"crc32\":%u}", i ? "," : ",\"brackets\":[",
                           bracket->exposure_s, (unsigned long long)bracket->bytes, bracket->crc32);
    }
    return length + snprintf(line + length, (size_t)(LINE_SIZE - length), "%s}\n", record->bracket_count ? "]" : "");
}

weft_code weft_session_append(weft_session *session, int shot, const weft_shot_record *record, weft_error *error)
{
    char path[PATH_MAX], line[LINE_SIZE];
    journal_path(session, path);
    int length = write_line(shot, record, line);
    if (append_text(path, line, (size_t)length) != 0)
        return weft_fail_errno(error, "append to", path);
    session->record[shot] = *record;
    session->record[shot].taken = true;
    return WEFT_OK;
}

weft_code weft_session_append_frame(weft_session *session, int frame, const weft_frame_record *record,
                                    weft_error *error)
{
    char path[PATH_MAX], line[LINE_SIZE];
    journal_path(session, path);
    int length = snprintf(line, sizeof line, "{\"frame\":%d,\"exposure_s\":%.9g,\"bytes\":%llu,\"crc32\":%u}\n", frame,
                          record->exposure_s, (unsigned long long)record->bytes, record->crc32);
    if (append_text(path, line, (size_t)length) != 0)
        return weft_fail_errno(error, "append to", path);
    session->frame[frame] = *record;
    session->frame[frame].taken = true;
    return WEFT_OK;
}

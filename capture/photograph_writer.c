#include "capture/photograph_writer.h"

#include "base/atomic_file.h"
#include "base/picture/image.h"

#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { MAX_FILE_BYTES = 1 << 30 };

weft_code weft_file_crc(const char *path, uint64_t *bytes, uint32_t *crc, weft_error *error)
{
    char *content = NULL;
    size_t size;
    WEFT_TRY(weft_read_file(path, MAX_FILE_BYTES, &content, &size, error));
    *bytes = size;
    *crc = (uint32_t)crc32(crc32(0, Z_NULL, 0), (const Bytef *)content, (uInt)size);
    free(content);
    return WEFT_OK;
}

static weft_code copy_file(const char *from, const char *to, weft_error *error)
{
    const size_t limit = (size_t)1 << 31;
    char *bytes;
    size_t size;
    weft_sweep_left_over(to);
    WEFT_TRY(weft_read_file(from, limit, &bytes, &size, error));
    weft_code code = weft_write_file(to, bytes, size, error);
    free(bytes);
    if (code == WEFT_OK && remove(from) != 0)
        return weft_fail_errno(error, "remove", from);
    return code;
}

weft_code weft_keep_file(const char *from, const char *to, weft_error *error)
{
    char folder[PATH_MAX];
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(to, '/') - to), to);
    WEFT_TRY(weft_make_folder(folder, error));
    if (rename(from, to) == 0)
        return weft_sync_file(to, error);
    return errno == EXDEV ? copy_file(from, to, error) : weft_fail_errno(error, "keep", from);
}

const char weft_unfinished_photograph[] = ".photograph.tif";

struct weft_photograph_writer {
    weft_session *session;
    uint16_t *filling, *writing; /* two buffers that change places */
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    bool busy, closing; /* a photograph is waiting or being written; no more will come */
    int shot;
    int unsynced_shot; /* one of the viewpoint whose names and journal lines may not be on the disk; -1: none */
    weft_shot_record record;
    weft_code code;
    weft_error error;
};

/* ---- In the writer's thread ---- */

static size_t sample_count(const weft_session *session)
{
    return (size_t)session->camera.width * (size_t)session->camera.height * 3;
}

static weft_code make_folder_of(const char *path, weft_error *error)
{
    char folder[PATH_MAX];
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(path, '/') - path), path);
    return weft_make_folder(folder, error);
}

/* The photographs of the last viewpoint are on the disk already; now their names are, and then the journal that has
 * them. */
static weft_code sync_viewpoint(weft_photograph_writer *writer, weft_error *error)
{
    char path[PATH_MAX];
    if (writer->unsynced_shot < 0)
        return WEFT_OK;
    weft_session_photograph_path(writer->session, writer->unsynced_shot, path, sizeof path);
    writer->unsynced_shot = -1;
    weft_sync_folder_of(path);
    return weft_session_sync(writer->session, error);
}

static bool begins_viewpoint(const weft_photograph_writer *writer)
{
    int before = writer->unsynced_shot;
    return before >= 0 && writer->session->record[before].viewpoint != writer->record.viewpoint;
}

weft_code weft_photograph_store(const weft_session *session, const char *path, const uint16_t *samples, uint64_t *bytes,
                                uint32_t *crc32, weft_error *error)
{
    const weft_camera *camera = &session->camera;
    char temporary[PATH_MAX];
    snprintf(temporary, sizeof temporary, "%s/%s", session->folder, weft_unfinished_photograph);
    WEFT_TRY(make_folder_of(path, error));
    WEFT_TRY(weft_photograph_write(temporary, camera->width, camera->height, session->bits, samples, error));
    WEFT_TRY(weft_file_crc(temporary, bytes, crc32, error));
    WEFT_TRY(weft_sync_file(temporary, error));
    return rename(temporary, path) == 0 ? WEFT_OK : weft_fail_errno(error, "write", path);
}

static weft_code store_photograph(const weft_photograph_writer *writer, const char *path, int index, uint64_t *bytes,
                                  uint32_t *crc32, weft_error *error)
{
    const uint16_t *samples = writer->writing + (size_t)index * sample_count(writer->session);
    return weft_photograph_store(writer->session, path, samples, bytes, crc32, error);
}

/* Of a shot that had more before. */
static void remove_brackets(const weft_session *session, int shot, int first)
{
    char path[PATH_MAX];
    for (int i = first; i < WEFT_SESSION_MAX_BRACKETS; i++) {
        weft_session_bracket_path(session, shot, i, path, sizeof path);
        remove(path);
    }
}

/* Photographs are synced before the journal names their shot. */
static weft_code store(weft_photograph_writer *writer, weft_error *error)
{
    weft_session *session = writer->session;
    weft_shot_record record = writer->record;
    char path[PATH_MAX];
    if (begins_viewpoint(writer))
        WEFT_TRY(sync_viewpoint(writer, error));
    for (int i = 0; i < record.bracket_count; i++) {
        weft_bracket_record *bracket = &record.bracket[i];
        weft_session_bracket_path(session, writer->shot, i, path, sizeof path);
        WEFT_TRY(store_photograph(writer, path, i + 1, &bracket->bytes, &bracket->crc32, error));
    }
    weft_session_photograph_path(session, writer->shot, path, sizeof path);
    WEFT_TRY(store_photograph(writer, path, 0, &record.bytes, &record.crc32, error));
    record.taken = true;
    WEFT_TRY(weft_session_append(session, writer->shot, &record, error));
    remove_brackets(session, writer->shot, record.bracket_count);
    writer->unsynced_shot = writer->shot;
    return WEFT_OK;
}

static void remove_temporary(const weft_session *session)
{
    char temporary[PATH_MAX];
    snprintf(temporary, sizeof temporary, "%s/%s", session->folder, weft_unfinished_photograph);
    remove(temporary);
}

static void *write_photographs(void *argument)
{
    weft_photograph_writer *writer = argument;
    pthread_mutex_lock(&writer->mutex);
    for (;;) {
        while (!writer->busy && !writer->closing)
            pthread_cond_wait(&writer->changed, &writer->mutex);
        if (!writer->busy)
            break;
        pthread_mutex_unlock(&writer->mutex);
        weft_error error = {0};
        weft_code code = store(writer, &error);
        if (code != WEFT_OK)
            remove_temporary(writer->session);
        pthread_mutex_lock(&writer->mutex);
        writer->code = code;
        writer->error = error;
        writer->busy = false;
        pthread_cond_broadcast(&writer->changed);
        if (code != WEFT_OK)
            break;
    }
    pthread_mutex_unlock(&writer->mutex);
    return NULL;
}

/* ---- In the caller's thread ---- */

static void free_writer(weft_photograph_writer *writer)
{
    pthread_mutex_destroy(&writer->mutex);
    pthread_cond_destroy(&writer->changed);
    free(writer->filling);
    free(writer->writing);
    free(writer);
}

weft_code weft_photograph_writer_start(weft_session *session, int brackets, weft_photograph_writer **result,
                                       weft_error *error)
{
    weft_photograph_writer *writer = calloc(1, sizeof *writer);
    if (!writer)
        return weft_fail_memory(error, "photograph writer", sizeof *writer);
    size_t bytes = (1 + (size_t)brackets) * sample_count(session) * sizeof(uint16_t);
    writer->session = session;
    writer->unsynced_shot = -1;
    pthread_mutex_init(&writer->mutex, NULL);
    pthread_cond_init(&writer->changed, NULL);
    writer->filling = malloc(bytes);
    writer->writing = malloc(bytes);
    weft_code code = WEFT_OK;
    if (!writer->filling || !writer->writing)
        code = weft_fail_memory(error, "photographs", 2 * bytes);
    else if (pthread_create(&writer->thread, NULL, write_photographs, writer) != 0)
        code = weft_fail(error, WEFT_SYSTEM, "cannot start the thread that writes photographs");
    if (code != WEFT_OK) {
        free_writer(writer);
        return code;
    }
    *result = writer;
    return WEFT_OK;
}

uint16_t *weft_photograph_writer_buffer(weft_photograph_writer *writer)
{
    return writer->filling;
}

static weft_code failure_of(const weft_photograph_writer *writer, weft_error *error)
{
    if (writer->code != WEFT_OK && error)
        *error = writer->error;
    return writer->code;
}

weft_code weft_photograph_writer_submit(weft_photograph_writer *writer, int shot, const weft_shot_record *record,
                                        weft_error *error)
{
    pthread_mutex_lock(&writer->mutex);
    while (writer->busy)
        pthread_cond_wait(&writer->changed, &writer->mutex);
    weft_code code = failure_of(writer, error);
    if (code == WEFT_OK) {
        uint16_t *filled = writer->filling;
        writer->filling = writer->writing;
        writer->writing = filled;
        writer->shot = shot;
        writer->record = *record;
        writer->busy = true;
        pthread_cond_broadcast(&writer->changed);
    }
    pthread_mutex_unlock(&writer->mutex);
    return code;
}

weft_code weft_photograph_writer_finish(weft_photograph_writer *writer, weft_error *error)
{
    pthread_mutex_lock(&writer->mutex);
    writer->closing = true;
    pthread_cond_broadcast(&writer->changed);
    pthread_mutex_unlock(&writer->mutex);
    pthread_join(writer->thread, NULL);
    weft_error last = {0};
    weft_code synced = sync_viewpoint(writer, &last);
    if (writer->code == WEFT_OK) {
        writer->code = synced;
        writer->error = last;
    }
    weft_code code = failure_of(writer, error);
    free_writer(writer);
    return code;
}

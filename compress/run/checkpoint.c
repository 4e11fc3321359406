#include "compress/run/checkpoint.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum { MAX_IDENTITY = 4096, VERSION = 2 };

static const char magic[8] = {'W', 'E', 'F', 'T', 'P', 'A', 'R', 'T'};

typedef struct file_header {
    char magic[8];
    uint32_t version, identity_size, identity_checksum;
} file_header;

typedef struct record_header {
    uint64_t index, size;
    uint32_t checksum, own_checksum;
} record_header;

struct weft_checkpoint {
    char *path;
    int descriptor;
    uint64_t count, read; /* records in the file, of these read or appended */
    off_t at, end;        /* of the next record to read, of the whole records */
};

static uint32_t checksum_of(const void *bytes, size_t size)
{
    return (uint32_t)crc32_z(0, bytes, size);
}

static uint32_t header_checksum(const record_header *header)
{
    return checksum_of(header, offsetof(record_header, own_checksum));
}

/* Bytes read, fewer than `size` at the end of the file. */
static size_t read_at(int descriptor, void *bytes, size_t size, off_t at)
{
    size_t done = 0;
    while (done < size) {
        ssize_t got = pread(descriptor, (char *)bytes + done, size - done, at + (off_t)done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            break;
        done += (size_t)got;
    }
    return done;
}

static bool write_at(int descriptor, const void *bytes, size_t size, off_t at)
{
    size_t done = 0;
    while (done < size) {
        ssize_t written = pwrite(descriptor, (const char *)bytes + done, size - done, at + (off_t)done);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return false;
        done += (size_t)written;
    }
    return true;
}

/* ---- Bytes of a record ---- */

static bool make_room(weft_record *record, size_t size)
{
    if (record->capacity - record->size >= size)
        return true;
    size_t capacity = record->capacity + record->capacity / 2 + size;
    unsigned char *bytes = realloc(record->bytes, capacity);
    if (!bytes)
        return false;
    record->bytes = bytes;
    record->capacity = capacity;
    return true;
}

void weft_record_transfer(weft_record *record, void *value, size_t size)
{
    bool possible = record->loading ? record->size - record->at >= size : make_room(record, size);
    record->failed = record->failed || !possible;
    if (record->failed || size == 0)
        return;
    if (record->loading) {
        memcpy(value, record->bytes + record->at, size);
        record->at += size;
    } else {
        memcpy(record->bytes + record->size, value, size);
        record->size += size;
    }
}

/* ---- Looking at what is there ---- */

/* What is found where a checkpoint should be. */
typedef enum finding { NOTHING, FOREIGN, DAMAGED, OTHER_PROGRAM, OTHER_DATASET, OTHER_OPTIONS, USABLE } finding;

/* Compares line by line, so that it can be said what differs. */
static finding compare_identity(const char *found, const weft_checkpoint_identity *identity)
{
    const char *const own[3] = {identity->program, identity->dataset, identity->options};
    for (int i = 0; i < 3; i++) {
        size_t length = strlen(own[i]);
        if (strncmp(found, own[i], length) != 0 || found[length] != '\n')
            return (finding)(OTHER_PROGRAM + i);
        found += length + 1;
    }
    return *found ? DAMAGED : USABLE;
}

static finding look_at_header(weft_checkpoint *checkpoint, const weft_checkpoint_identity *identity)
{
    file_header header;
    char found[MAX_IDENTITY + 1] = {0};
    size_t got = read_at(checkpoint->descriptor, &header, sizeof header, 0);
    if (memcmp(header.magic, magic, got < sizeof magic ? got : sizeof magic) != 0)
        return FOREIGN;
    if (got < sizeof header)
        return NOTHING;
    if (header.version != VERSION)
        return OTHER_PROGRAM;
    if (header.identity_size > MAX_IDENTITY)
        return DAMAGED;
    if (read_at(checkpoint->descriptor, found, header.identity_size, sizeof header) < header.identity_size)
        return NOTHING;
    if (checksum_of(found, header.identity_size) != header.identity_checksum)
        return DAMAGED;
    checkpoint->at = checkpoint->end = (off_t)(sizeof header + header.identity_size);
    return compare_identity(found, identity);
}

static bool payload_is_whole(const weft_checkpoint *checkpoint, const record_header *header, off_t at)
{
    unsigned char bytes[65536];
    uLong checksum = 0;
    for (uint64_t left = header->size; left > 0;) {
        size_t part = left < sizeof bytes ? (size_t)left : sizeof bytes;
        if (read_at(checkpoint->descriptor, bytes, part, at) < part)
            return false;
        checksum = crc32_z(checksum, bytes, part);
        at += (off_t)part;
        left -= part;
    }
    return checksum == header->checksum;
}

/* Counts the whole records. */
static finding look_at_records(weft_checkpoint *checkpoint)
{
    struct stat status;
    if (fstat(checkpoint->descriptor, &status) != 0)
        return DAMAGED;
    for (;;) {
        record_header header;
        if (read_at(checkpoint->descriptor, &header, sizeof header, checkpoint->end) < sizeof header)
            return USABLE;
        if (header_checksum(&header) != header.own_checksum || header.index != checkpoint->count)
            return DAMAGED;
        off_t payload = checkpoint->end + (off_t)sizeof header;
        if (header.size > (uint64_t)(status.st_size - payload))
            return USABLE;
        if (!payload_is_whole(checkpoint, &header, payload))
            return DAMAGED;
        checkpoint->end = payload + (off_t)header.size;
        checkpoint->count++;
    }
}

static weft_code begin_anew(weft_checkpoint *checkpoint, const weft_checkpoint_identity *identity, weft_error *error)
{
    char text[MAX_IDENTITY];
    int size = snprintf(text, sizeof text, "%s\n%s\n%s\n", identity->program, identity->dataset, identity->options);
    if (size < 0 || (size_t)size >= sizeof text)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s': an identity of %d bytes", checkpoint->path, size);
    file_header header = {
        .version = VERSION, .identity_size = (uint32_t)size, .identity_checksum = checksum_of(text, (size_t)size)};
    memcpy(header.magic, magic, sizeof magic);
    checkpoint->count = checkpoint->read = 0;
    checkpoint->at = checkpoint->end = (off_t)(sizeof header + header.identity_size);
    errno = ENOSPC;
    if (ftruncate(checkpoint->descriptor, 0) != 0 || !write_at(checkpoint->descriptor, &header, sizeof header, 0) ||
        !write_at(checkpoint->descriptor, text, (size_t)size, sizeof header)) {
        weft_code code = weft_fail_errno(error, "write", checkpoint->path);
        unlink(checkpoint->path);
        return code;
    }
    return WEFT_OK;
}

/* ---- Opening and closing ---- */

static weft_code open_and_lock(weft_checkpoint *checkpoint, weft_error *error)
{
    struct stat status;
    checkpoint->descriptor = open(checkpoint->path, O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
    if (checkpoint->descriptor < 0 || fstat(checkpoint->descriptor, &status) != 0)
        return weft_fail_errno(error, "open", checkpoint->path);
    if (!S_ISREG(status.st_mode))
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' is in the way: it is not a regular file", checkpoint->path);
    if (flock(checkpoint->descriptor, LOCK_EX | LOCK_NB) != 0)
        return weft_fail(error, WEFT_SYSTEM, "'%s' is in use by another weft compress to the same output",
                         checkpoint->path);
    return WEFT_OK;
}

static weft_code use_or_discard(weft_checkpoint *checkpoint, const weft_checkpoint_identity *identity,
                                char why[WEFT_MESSAGE_SIZE], weft_error *error)
{
    static const char *const reason[] = {[DAMAGED] = "it is damaged",
                                         [OTHER_PROGRAM] = "another version of weft or another processor made it",
                                         [OTHER_DATASET] = "it was made from another dataset",
                                         [OTHER_OPTIONS] = "it was made with other options"};
    finding found = look_at_header(checkpoint, identity);
    if (found == FOREIGN)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' is in the way: it is not a checkpoint of weft compress",
                         checkpoint->path);
    if (found == USABLE)
        found = look_at_records(checkpoint);
    if (found == USABLE)
        return WEFT_OK;
    if (found != NOTHING)
        snprintf(why, WEFT_MESSAGE_SIZE, "%s is discarded: %s", checkpoint->path, reason[found]);
    return begin_anew(checkpoint, identity, error);
}

weft_code weft_checkpoint_open(const char *path, const weft_checkpoint_identity *identity, weft_checkpoint **result,
                               char why[WEFT_MESSAGE_SIZE], weft_error *error)
{
    *result = NULL;
    why[0] = '\0';
    weft_checkpoint *checkpoint = calloc(1, sizeof *checkpoint);
    if (!checkpoint)
        return weft_fail_memory(error, "checkpoint", sizeof *checkpoint);
    checkpoint->descriptor = -1;
    checkpoint->path = strdup(path);
    weft_code code =
        checkpoint->path ? open_and_lock(checkpoint, error) : weft_fail_memory(error, "path", strlen(path));
    if (code == WEFT_OK)
        code = use_or_discard(checkpoint, identity, why, error);
    if (code == WEFT_OK) {
        *result = checkpoint;
        return WEFT_OK;
    }
    if (checkpoint->descriptor >= 0)
        close(checkpoint->descriptor);
    free(checkpoint->path);
    free(checkpoint);
    return code;
}

void weft_checkpoint_forget(weft_checkpoint *checkpoint)
{
    if (checkpoint)
        checkpoint->count = 0;
}

void weft_checkpoint_close(weft_checkpoint *checkpoint)
{
    if (!checkpoint)
        return;
    if (checkpoint->count == 0)
        unlink(checkpoint->path);
    close(checkpoint->descriptor);
    free(checkpoint->path);
    free(checkpoint);
}

/* ---- Records ---- */

uint64_t weft_checkpoint_unread(const weft_checkpoint *checkpoint)
{
    return checkpoint->count - checkpoint->read;
}

const char *weft_checkpoint_path(const weft_checkpoint *checkpoint)
{
    return checkpoint->path;
}

weft_code weft_checkpoint_read(weft_checkpoint *checkpoint, weft_record *record, weft_error *error)
{
    record_header header = {0};
    bool there = read_at(checkpoint->descriptor, &header, sizeof header, checkpoint->at) == sizeof header &&
                 checkpoint->at + (off_t)sizeof header + (off_t)header.size <= checkpoint->end;
    *record = (weft_record){.size = (size_t)header.size, .loading = true};
    record->bytes = there ? malloc(record->size + 1) : NULL;
    if (there && !record->bytes)
        return weft_fail_memory(error, "record of a checkpoint", record->size);
    checkpoint->at += (off_t)sizeof header;
    if (!there || read_at(checkpoint->descriptor, record->bytes, record->size, checkpoint->at) < record->size)
        return weft_fail(error, WEFT_SYSTEM, "cannot read '%s' at byte %lld", checkpoint->path,
                         (long long)checkpoint->at);
    checkpoint->at += (off_t)record->size;
    checkpoint->read++;
    return WEFT_OK;
}

weft_code weft_checkpoint_append(weft_checkpoint *checkpoint, const weft_record *record, weft_error *error)
{
    record_header header = {
        .index = checkpoint->count, .size = record->size, .checksum = checksum_of(record->bytes, record->size)};
    header.own_checksum = header_checksum(&header);
    /* A write of fewer bytes than asked for is a full disk, too, and sets no error number. */
    errno = ENOSPC;
    if (!write_at(checkpoint->descriptor, &header, sizeof header, checkpoint->end) ||
        !write_at(checkpoint->descriptor, record->bytes, record->size, checkpoint->end + (off_t)sizeof header))
        return weft_fail(error, WEFT_SYSTEM, "cannot append to '%s': %s; what is in it is kept", checkpoint->path,
                         strerror(errno));
    checkpoint->end += (off_t)(sizeof header + record->size);
    checkpoint->count++;
    checkpoint->read++;
    return WEFT_OK;
}

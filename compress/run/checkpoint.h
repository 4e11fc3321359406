/* What is done of a long fit, in a file beside its output: one record a block, appended when the block is fitted.
 *
 *     "WEFTPART"  u32 version  u32 size and u32 CRC-32 of the identity  identity
 *     records:    u64 index  u64 size  u32 CRC-32 of the payload  u32 CRC-32 of these 20 bytes  payload
 *
 * A kill at any moment leaves whole records and at most one that is cut, which is dropped. Records are not synced to
 * the disk one by one; what a power cut leaves is told by the checksums. */
#ifndef WEFT_COMPRESS_RUN_CHECKPOINT_H
#define WEFT_COMPRESS_RUN_CHECKPOINT_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- Records ---- */

/* A run of bytes that is filled and read back by the same code, so that the two cannot differ. Zero-initialise to save;
 * set bytes and size to load. Freed by its owner: free(record.bytes). */
typedef struct weft_record {
    unsigned char *bytes;
    size_t size, capacity;
    size_t at;    /* of the next byte to load */
    bool loading; /* else saving */
    bool failed;  /* out of memory, or loaded beyond the end */
} weft_record;

/* Saves `size` bytes from `value`, or loads them into it. Does nothing once failed. */
void weft_record_transfer(weft_record *record, void *value, size_t size);

/* Whose work it is: single lines, compared byte by byte. */
typedef struct weft_checkpoint_identity {
    const char *program, *dataset, *options;
} weft_checkpoint_identity;

typedef struct weft_checkpoint weft_checkpoint;

/* Opens or creates a checkpoint and locks it. One of another identity or with a wrong checksum is discarded; `why`
 * then says so in a sentence that names the file, else it is "". Errors: WEFT_SYSTEM where the file cannot be opened
 * or another process has locked it; WEFT_BAD_USAGE where it is something else than a checkpoint, which stays. */
weft_code weft_checkpoint_open(const char *path, const weft_checkpoint_identity *identity, weft_checkpoint **result,
                               char why[WEFT_MESSAGE_SIZE], weft_error *error);

/* Records that have not been read yet. */
uint64_t weft_checkpoint_unread(const weft_checkpoint *checkpoint);

/* The name of the file, which the checkpoint owns. */
const char *weft_checkpoint_path(const weft_checkpoint *checkpoint);

/* Reads the next record, in the order in which they were appended, into record->bytes, which it allocates anew. Errors:
 * WEFT_SYSTEM. */
weft_code weft_checkpoint_read(weft_checkpoint *checkpoint, weft_record *record, weft_error *error);

/* Appends a record after all have been read. On failure (a full disk) the records before stay. Errors: WEFT_SYSTEM. */
weft_code weft_checkpoint_append(weft_checkpoint *checkpoint, const weft_record *record, weft_error *error);

/* Says that the records are of no use: closing removes the file. NULL is fine. */
void weft_checkpoint_forget(weft_checkpoint *checkpoint);

/* Closes the file and leaves it for the next time; removes it where it holds no record. NULL is fine. */
void weft_checkpoint_close(weft_checkpoint *checkpoint);

#endif

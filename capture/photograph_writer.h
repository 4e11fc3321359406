/* Writes photographs into a session in a thread of its own, while the rig takes the next one. */
#ifndef WEFT_CAPTURE_PHOTOGRAPH_WRITER_H
#define WEFT_CAPTURE_PHOTOGRAPH_WRITER_H

#include "base/status.h"
#include "btf/session/session.h"

#include <stdint.h>

/* ---- Size and checksum of a file: how the journal knows a photograph again. ---- */

/* CRC-32 (ISO 3309, as in zlib) of all bytes of a file. Thread-safe. Errors: WEFT_BAD_INPUT where it cannot be read. */
weft_code weft_file_crc(const char *path, uint64_t *bytes, uint32_t *crc32, weft_error *error);

/* ---- Files of a camera that a session keeps as they are. ---- */

/* Puts the file of a camera where the session keeps it: moved, or copied and then removed where it lies on another
 * disk. Makes the folder. Errors: WEFT_SYSTEM; what was there is there still. */
weft_code weft_keep_file(const char *from, const char *to, weft_error *error);

/* Name, in the folder of the session, of the photograph that is being written. */
extern const char weft_unfinished_photograph[];

/* Writes one photograph of the session: it appears under its name when it is complete and on the disk. Makes its
 * folder. *bytes and *crc32 receive what the journal is to say. Errors: WEFT_SYSTEM; the unfinished one may lie there
 * then. */
weft_code weft_photograph_store(const weft_session *session, const char *path, const uint16_t *samples, uint64_t *bytes,
                                uint32_t *crc32, weft_error *error);

typedef struct weft_photograph_writer weft_photograph_writer;

/* Starts the thread, for shots of up to `brackets` photographs beyond the first. It writes session->record and the
 * journal until finish; nobody else may meanwhile. Errors: WEFT_SYSTEM. */
weft_code weft_photograph_writer_start(weft_session *session, int brackets, weft_photograph_writer **result,
                                       weft_error *error);

/* The buffer for the next shot, [1 + brackets][height][width][3] raw samples, owned by the writer and valid until it is
 * submitted. */
uint16_t *weft_photograph_writer_buffer(weft_photograph_writer *writer);

/* Hands over the buffer: the photographs of `shot`, of which `record` holds viewpoint and exposures. Waits until the
 * photograph before it is written, so at most one is under way. A file appears under its final name when it is
 * complete and on the disk, and after that the journal names the shot. Names and journal are synced when a viewpoint is
 * over, so that a power cut takes the photographs of one viewpoint at most. Errors: the first failure of an earlier
 * photograph. */
weft_code weft_photograph_writer_submit(weft_photograph_writer *writer, int shot, const weft_shot_record *record,
                                        weft_error *error);

/* Waits for the last photograph, syncs its viewpoint, ends the thread and frees the writer. Errors: the first failure,
 * if submit has not reported it. */
weft_code weft_photograph_writer_finish(weft_photograph_writer *writer, weft_error *error);

#endif

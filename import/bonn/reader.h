/* A file read from front to back, in small pieces that are checked against what is left of it. Numbers are
 * little-endian. Private to the readers of the files of Bonn. */
#ifndef WEFT_IMPORT_BONN_READER_H
#define WEFT_IMPORT_BONN_READER_H

#include "base/status.h"

#include <stdint.h>
#include <stdio.h>

typedef struct weft_bonn_reader {
    const char *path; /* for messages; not owned */
    FILE *stream;
    uint64_t left;       /* bytes behind what was read */
    const char *section; /* what is being read, as in "ends in its SECTION" */
} weft_bonn_reader;

/* Opens a regular file; the caller closes the stream. Errors: WEFT_BAD_INPUT. */
weft_code weft_bonn_reader_open(const char *path, weft_bonn_reader *reader, weft_error *error);

/* Errors of all that follow: WEFT_BAD_INPUT where the file ends before, naming the section; WEFT_SYSTEM. */

/* That `bytes` more are there: before memory for them is allocated. */
weft_code weft_bonn_reader_expect(const weft_bonn_reader *reader, uint64_t bytes, weft_error *error);
weft_code weft_bonn_reader_take(weft_bonn_reader *reader, void *to, uint64_t bytes, weft_error *error);
weft_code weft_bonn_reader_skip(weft_bonn_reader *reader, uint64_t bytes, weft_error *error);

weft_code weft_bonn_reader_byte(weft_bonn_reader *reader, uint8_t *number, weft_error *error);
weft_code weft_bonn_reader_whole(weft_bonn_reader *reader, uint32_t *number, weft_error *error);
weft_code weft_bonn_reader_singles(weft_bonn_reader *reader, float *number, int count, weft_error *error);

/* The little-endian number at `bytes`. Pure. */
static inline uint32_t weft_bonn_whole_of(const uint8_t bytes[4])
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

float weft_bonn_single_of(const uint8_t bytes[4]);
double weft_bonn_double_of(const uint8_t bytes[8]);

#endif

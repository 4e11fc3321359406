/* A run of bytes that is filled and read back by the same code, so that the two cannot differ. */
#ifndef WEFT_COMPRESS_RUN_RECORD_H
#define WEFT_COMPRESS_RUN_RECORD_H

#include <stdbool.h>
#include <stddef.h>

/* Zero-initialise to save; set bytes and size to load. Freed by its owner: free(record.bytes). */
typedef struct weft_record {
    unsigned char *bytes;
    size_t size, capacity;
    size_t at;    /* of the next byte to load */
    bool loading; /* else saving */
    bool failed;  /* out of memory, or loaded beyond the end */
} weft_record;

/* Saves `size` bytes from `value`, or loads them into it. Does nothing once failed. */
void weft_record_transfer(weft_record *record, void *value, size_t size);

#endif

/* Blocks of a dataset read ahead: one thread reads the next while the caller works on the present one. HDF5 is not
 * thread-safe, so that nothing else may use the dataset while a reader of it lives. */
#ifndef WEFT_COMPRESS_RUN_BLOCK_READER_H
#define WEFT_COMPRESS_RUN_BLOCK_READER_H

#include "btf/dataset/dataset.h"

typedef struct weft_block_place {
    int x, y, width, height; /* texels */
} weft_block_place;

typedef struct weft_block_samples {
    weft_block_place place;
    weft_half *samples; /* [height][width][image_count][3] */
    uint8_t *mask;      /* [height][width][image_count] */
} weft_block_samples;

typedef struct weft_block_reader weft_block_reader;

/* Bytes that a reader of blocks of so many texels allocates. Pure. */
uint64_t weft_block_reader_bytes(const weft_dataset_layout *layout, size_t texels);

/* Starts reading place[0..count), each of at most `texels` texels. `place` must outlive the reader. The caller frees
 * the reader. Errors: WEFT_SYSTEM. */
weft_code weft_block_reader_create(weft_dataset *dataset, const weft_block_place *place, size_t count, size_t texels,
                                   weft_block_reader **result, weft_error *error);

/* Gives back the block before, if any, and waits for the next one, which stays the reader's. Errors: those of
 * weft_dataset_read_block; WEFT_BAD_USAGE after the last block. */
weft_code weft_block_reader_next(weft_block_reader *reader, const weft_block_samples **block, weft_error *error);

/* Ends the thread, at once if between blocks, and frees. NULL is fine. */
void weft_block_reader_free(weft_block_reader *reader);

#endif

/* Writing a dataset block of texels by block of texels: for what is computed from another dataset, texel by texel.
 * Keeps one block in memory and needs no scratch file (btf/dataset/dataset.h has the writer that takes whole images).
 */
#ifndef WEFT_BTF_DATASET_WRITE_BLOCKS_H
#define WEFT_BTF_DATASET_WRITE_BLOCKS_H

#include "btf/dataset/dataset.h"

#include <jansson.h>

/* Size of the blocks to read and write, texels: whole chunks of the file, about 64 MiB of samples at most where a chunk
 * is not larger. Blocks lie at multiples of it. Pure. */
void weft_dataset_block_size(const weft_dataset_layout *layout, int *width, int *height);

typedef struct weft_dataset_block_writer weft_dataset_block_writer;

/* Copies `path`; `layout` must outlive the writer. Reserves the disk space of the samples. Errors: WEFT_BAD_INPUT for
 * an impossible layout, WEFT_SYSTEM. */
weft_code weft_dataset_block_writer_create(const char *path, const weft_dataset_layout *layout,
                                           weft_dataset_block_writer **result, weft_error *error);

/* Texels [x, x + width) x [y, y + height): samples [height][width][image_count][3], mask [height][width][image_count].
 * Every texel must be put once. Not thread-safe. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_block_writer_put(weft_dataset_block_writer *writer, int x, int y, int width, int height,
                                        const weft_half *samples, const uint8_t *mask, weft_error *error);

/* Optional, once: opacity [height][width][view_count] of the whole material. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_block_writer_put_opacity(weft_dataset_block_writer *writer, const float *opacity,
                                                weft_error *error);

/* Optional, once: frames [height][width][2][3] of the whole material. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_block_writer_put_frames(weft_dataset_block_writer *writer, const float *frames,
                                               weft_error *error);

/* Optional, once: heights of the surface. Errors: WEFT_BAD_INPUT for some that a reader would refuse, WEFT_SYSTEM. */
weft_code weft_dataset_block_writer_put_heights(weft_dataset_block_writer *writer, const weft_dataset_heights *heights,
                                                weft_error *error);

/* Writes the file under its final name (atomically) and frees the writer, also on failure. `provenance` is JSON text.
 */
weft_code weft_dataset_block_writer_finish(weft_dataset_block_writer *writer, const char *provenance,
                                           weft_error *error);

/* Frees the writer and removes what it wrote. NULL is fine. */
void weft_dataset_block_writer_abandon(weft_dataset_block_writer *writer);

/* ---- Of a dataset that is computed from another one ---- */

/* Refuses an output that is the file of the dataset itself; `loss` ends the message, as in "the tile would replace it".
 * Errors: WEFT_BAD_USAGE. */
weft_code weft_derived_dataset_check(const weft_dataset *dataset, const char *output, const char *loss,
                                     weft_error *error);

/* Finishes the writer with the provenance of `source`, to which `made` is added under `name`: what was done. Frees the
 * writer and takes the reference to `made`, also on failure. Errors: those of weft_dataset_block_writer_finish. */
weft_code weft_derived_dataset_finish(weft_dataset_block_writer *writer, const weft_dataset_layout *source,
                                      const char *name, json_t *made, weft_error *error);

#endif

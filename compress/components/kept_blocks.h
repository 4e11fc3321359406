/* Blocks of texels that have been projected on components, in the checkpoint of a compression: one record a block,
 * after those of the dense model. */
#ifndef WEFT_COMPRESS_COMPONENTS_KEPT_BLOCKS_H
#define WEFT_COMPRESS_COMPONENTS_KEPT_BLOCKS_H

#include "compress/components/projection.h"
#include "compress/run/block_plan.h"

/* Fills `projection`, whose memory is there, with the blocks of `plan` that are in `checkpoint` and unread, and says
 * how many they are: 0 where it is NULL. Errors: WEFT_BAD_INPUT for a record of another size than its block; those of
 * weft_checkpoint_read. */
weft_code weft_kept_blocks_take(weft_checkpoint *checkpoint, const weft_log *log, const weft_block_plan *plan,
                                weft_projection *projection, size_t *count, weft_error *error);

/* Appends a block that has just been projected; does nothing where `checkpoint` is NULL. Errors: WEFT_SYSTEM for
 * memory; those of weft_checkpoint_append. */
weft_code weft_kept_blocks_add(weft_checkpoint *checkpoint, weft_projection *projection, const weft_block_place *place,
                               weft_error *error);

#endif

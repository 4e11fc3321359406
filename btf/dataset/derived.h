/* Writing a dataset that is computed from another one. */
#ifndef WEFT_BTF_DATASET_DERIVED_H
#define WEFT_BTF_DATASET_DERIVED_H

#include "btf/dataset/write_blocks.h"

#include <jansson.h>

/* Refuses an output that is the file of the dataset itself; `loss` ends the message, as in "the tile would replace it".
 * Errors: WEFT_BAD_USAGE. */
weft_code weft_derived_dataset_check(const weft_dataset *dataset, const char *output, const char *loss,
                                     weft_error *error);

/* Finishes the writer with the provenance of `source`, to which `made` is added under `name`: what was done. Frees the
 * writer and takes the reference to `made`, also on failure. Errors: those of weft_dataset_block_writer_finish. */
weft_code weft_derived_dataset_finish(weft_dataset_block_writer *writer, const weft_dataset_layout *source,
                                      const char *name, json_t *made, weft_error *error);

#endif

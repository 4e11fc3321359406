/* What a material says of how it was made. */
#ifndef WEFT_COMPRESS_METADATA_H
#define WEFT_COMPRESS_METADATA_H

#include "btf/dataset/fingerprint.h"
#include "compress/compress.h"
#include "compress/sparse/sparse.h"

/* A constant. Pure. */
const char *weft_compress_model_name(weft_compress_model model);

/* Replaces the metadata of `material` by {"provenance": of the dataset, "dataset": its fingerprint, "fit": what was
 * done}. There is no time of day in it and no duration, so that equal input gives equal bytes. `setting` is that of a
 * sparse model. Errors: WEFT_SYSTEM for memory. */
weft_code weft_compress_describe(const weft_dataset_layout *layout, const weft_compress_options *options,
                                 const weft_compress_report *report, const weft_dataset_fingerprint *fingerprint,
                                 const weft_sparse_setting *setting, weft_material *material, weft_error *error);

#endif

/* The layout of the dataset that a collection becomes. */
#ifndef WEFT_IMPORT_LAYOUT_H
#define WEFT_IMPORT_LAYOUT_H

#include "import/collection.h"
#include "import/decode.h"
#include "import/import.h"

/* Image i of the layout is photograph i; photographs with the same view share it. Freed by the caller with
 * weft_dataset_layout_free. Notes where the texel pitch had to be assumed. Errors: WEFT_SYSTEM for memory. */
weft_code weft_import_layout(const weft_collection *collection, const weft_import_options *options,
                             const weft_decoding *decoding, weft_dataset_layout *layout, weft_lines *notes,
                             weft_error *error);

#endif

/* What the dataset of a collection says besides its samples: its layout and its provenance. */
#ifndef WEFT_IMPORT_DATASET_DESCRIPTION_H
#define WEFT_IMPORT_DATASET_DESCRIPTION_H

#include "import/bonn/file.h"
#include "import/decode.h"
#include "import/import.h"

/* Image i of the layout is photograph i; photographs with the same view share it. Freed by the caller with
 * weft_dataset_layout_free. Notes where the texel pitch had to be assumed. Errors: WEFT_SYSTEM for memory. */
weft_code weft_import_layout(const weft_collection *collection, const weft_import_options *options,
                             const weft_decoding *decoding, weft_dataset_layout *layout, weft_lines *notes,
                             weft_error *error);

/* JSON text in new memory: program, source, kind, conversion, and "photographs": the file of every image in order (null
 * where it is missing), or what a file of Bonn says of itself (else NULL). NULL where memory is short. */
char *weft_import_provenance(const char *source, const weft_collection *collection, const weft_bonn_file *bonn,
                             const weft_import_options *options, const weft_decoding *decoding,
                             const weft_import_report *report);

#endif

/* What an imported dataset remembers of its photographs. */
#ifndef WEFT_IMPORT_IMPORT_PROVENANCE_H
#define WEFT_IMPORT_IMPORT_PROVENANCE_H

#include "import/collection.h"
#include "import/decode.h"
#include "import/import.h"

/* JSON text in new memory: program, source, kind, conversion, and "photographs": the file of every image in order (null
 * where it is missing). NULL where memory is short. */
char *weft_import_provenance(const char *source, const weft_collection *collection, const weft_import_options *options,
                             const weft_decoding *decoding, const weft_import_report *report);

#endif

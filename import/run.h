/* One run of weft_import: what its workers share while they put images into the dataset. Private to the room. */
#ifndef WEFT_IMPORT_RUN_H
#define WEFT_IMPORT_RUN_H

#include "import/bonn/file.h"
#include "import/colour_messages.h"
#include "import/decode.h"
#include "import/import.h"

typedef struct weft_import_run {
    const char *source;
    const weft_import_options *options;
    const weft_progress *progress;
    weft_import_report *report;
    const weft_collection *collection;
    weft_decoding decoding;
    weft_dataset_writer *writer;
    weft_code code; /* of the first failure; guarded, with everything below, by the critical section */
    weft_error error;
    long done;
    size_t saturated, outside, samples;
    double sum;
    weft_colour_messages messages;
} weft_import_run;

/* Whether a worker has failed. Thread-safe. */
bool weft_import_has_stopped(const weft_import_run *run);

/* Takes note of what came of an image of the collection. Thread-safe. */
void weft_import_count(weft_import_run *run, int index, weft_code code, const weft_error *error,
                       const weft_decoded *decoded);

/* Puts all images of the collection: photographs in files of their own, or those of one file of Bonn. What failed is in
 * run->code. */
void weft_import_photographs(weft_import_run *run);
void weft_import_bonn_images(weft_import_run *run, const weft_bonn_file *file);

/* Puts the frames of the texels, where the file has some; notes where they are none. Errors: WEFT_SYSTEM. */
weft_code weft_import_bonn_frames(weft_import_run *run, const weft_bonn_file *file, weft_error *error);

#endif

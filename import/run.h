/* One run of weft_import: what its workers share while they put images into the dataset. Private to this folder. */
#ifndef WEFT_IMPORT_RUN_H
#define WEFT_IMPORT_RUN_H

#include "base/progress.h"
#include "import/bonn/file.h"
#include "import/decode.h"
#include "weft/import.h"

/* ---- What photographs say of their colours ---- */

enum { WEFT_COLOUR_MESSAGES = 8 };

/* Of photographs that say the same. */
typedef struct weft_colour_message {
    weft_claim_kind claim;
    char words[200];
    int count, first; /* the lowest index */
} weft_colour_message;

/* Starts as {0}. What is said beyond the eighth kind is dropped. */
typedef struct weft_colour_messages {
    int count;
    weft_colour_message message[WEFT_COLOUR_MESSAGES];
    int read, unsaid_exr;    /* photographs; and EXR files of them that say nothing */
    int more, first_of_more; /* files of more than one picture, and the lowest index of them */
} weft_colour_messages;

/* Adds what photograph `index` says; in any order. */
void weft_colour_messages_add(weft_colour_messages *messages, int index, const char *name, const weft_decoded *decoded);

/* A line for files of more than one picture, and one for each kind, that of the lowest index first; and a question
 * where EXR files that are named by their angles say nothing. */
weft_code weft_colour_messages_note(weft_colour_messages *messages, const weft_collection *collection,
                                    weft_import_colours colours, weft_lines *notes, weft_error *error);

typedef struct weft_import_run {
    const char *source;
    const weft_import_options *options;
    const weft_progress *progress;
    weft_import_report *report;
    const weft_collection *collection;
    weft_decoding decoding;
    weft_shown_photograph first; /* of index first_index; who puts it takes its pixels */
    int first_index;
    weft_dataset_writer *writer;
    weft_values values; /* of the dataset */
    weft_code code;     /* of the first failure; guarded, with everything below, by the critical section */
    weft_error error;
    long done;
    size_t saturated, outside, samples;
    size_t lacking;             /* samples that files lack though they show them */
    int partial, first_partial; /* such files, and the lowest index of one */
    double sum;
    weft_photograph_light *light; /* [collection->count] */
    uint8_t *seen; /* [height][width] texels that some photograph shows unmasked; not of a file of Bonn */
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

/* What the dataset of a collection says besides its samples: its layout and its provenance. */

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

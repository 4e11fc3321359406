/* What a file of Weft holds, and whether it is sound. */
#ifndef WEFT_INSPECT_H
#define WEFT_INSPECT_H

#include "weft/progress.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Describes a .weft, .btf.h5, .wv, .mc or .stitch file or a session folder from its headers, as `weft info --json`
 * does: *json is the text of an object with its kind, dimensions, provenance, errors and sizes; the caller frees it
 * (free). One thread at a time may read datasets. Errors: WEFT_BAD_INPUT (WEFT_MISSING, WEFT_DAMAGED,
 * WEFT_NOT_SUPPORTED) for a file that its reader refuses; WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_info(const char *path, char **json, weft_error *error);

/* Reads all of it, as `weft verify` does: every checksum and number of a material; every sample of a dataset; every
 * photograph of a session. *json is that of weft_info; of a dataset or a session it also has what was counted, under
 * "verified". `progress` may be NULL. Errors: as above, naming the first thing that is wrong; of a session, how many
 * things are. */
WEFT_API weft_code weft_check(const char *path, const weft_progress *progress, char **json, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif

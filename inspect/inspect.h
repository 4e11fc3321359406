/* What a file holds, and whether it is sound. */
#ifndef WEFT_INSPECT_INSPECT_H
#define WEFT_INSPECT_INSPECT_H

#include "base/progress.h"
#include "base/status.h"
#include "weft/inspect.h"

#include <jansson.h>

/* Describes a .weft, .btf.h5, .wv or .stitch file or a session folder from its headers: kind, dimensions, provenance,
 * errors, sizes. *result is a JSON object for which the caller calls json_decref. Errors: WEFT_BAD_INPUT for a file
 * that its reader refuses. */
weft_code weft_inspect(const char *path, json_t **result, weft_error *error);

/* Reads all of it: every checksum of a material and every number in it; every sample of a dataset; every photograph of
 * a session (size, checksum, decoding). *result is as from weft_inspect, with what was counted under "verified".
 * Errors: WEFT_BAD_INPUT naming the first thing that is wrong, and *result is NULL. Of a session all that is wrong is
 * found: *result then lists it under "faults", each with "kind", "shot" (of shots) and "text". */
weft_code weft_verify(const char *path, const weft_progress *progress, json_t **result, weft_error *error);

#endif

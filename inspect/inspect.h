/* What a file holds, and whether it is sound. */
#ifndef WEFT_INSPECT_INSPECT_H
#define WEFT_INSPECT_INSPECT_H

#include "base/picture/image.h"
#include "base/progress.h"
#include "base/status.h"
#include "btf/material/material.h"

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

/* ---- Model report ---- */

/* What was chosen for each texel of a material, as a page: a map in colours with its legend, and numbers by level. */

/* All levels side by side in texels of several pixels, each in the colour of its model (sRGB): its hue says what tables
 * it has, its brightness the number of lobes. Below them the legend, with the share of level 0. `image` is allocated.
 * Errors: WEFT_BAD_USAGE for a material without maps of models, WEFT_SYSTEM. */
weft_code weft_model_picture(const weft_material *material, weft_image *image, weft_error *error);

/* Writes FOLDER/models.png and FOLDER/index.html. Errors: as weft_model_picture and those of writing. */
weft_code weft_model_report_write(const char *folder, const weft_material *material, weft_error *error);

/* The colour of a byte of MODL, red, green, blue. Pure. */
void weft_model_colour(uint8_t code, float rgb[3]);

#endif

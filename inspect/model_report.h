/* What was chosen for each texel of a material, as a page: a map in colours with its legend, and numbers by level. */
#ifndef WEFT_INSPECT_MODEL_REPORT_H
#define WEFT_INSPECT_MODEL_REPORT_H

#include "base/picture/image.h"
#include "btf/material/material.h"

/* All levels side by side in texels of several pixels, each in the colour of its model (sRGB): its hue says what tables
 * it has, its brightness the number of lobes. Below them the legend, with the share of level 0. `image` is allocated.
 * Errors: WEFT_BAD_USAGE for a material without maps of models, WEFT_SYSTEM. */
weft_code weft_model_picture(const weft_material *material, weft_image *image, weft_error *error);

/* Writes FOLDER/models.png and FOLDER/index.html. Errors: as weft_model_picture and those of writing. */
weft_code weft_model_report_write(const char *folder, const weft_material *material, weft_error *error);

/* The colour of a byte of MODL, red, green, blue. Pure. */
void weft_model_colour(uint8_t code, float rgb[3]);

#endif

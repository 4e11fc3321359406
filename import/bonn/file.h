/* The binary BTF files of the University of Bonn (UBO2014): every image of a material as a product of two matrices. A
 * file is read from end to end and checked; import/bonn/images.h makes images of it. The layout is told in
 * docs/reference/import-layouts.md. */
#ifndef WEFT_IMPORT_BONN_FILE_H
#define WEFT_IMPORT_BONN_FILE_H

#include "base/text/lines.h"
#include "base/vector.h"
#include "import/bonn/colour.h"
#include "import/bonn/matrix.h"

#include <stdbool.h>

enum { WEFT_BONN_WORDS = 80 };

typedef struct weft_bonn_file {
    const char *kind;                                                                        /* in words */
    char setup[WEFT_BONN_WORDS + 1], sensor[WEFT_BONN_WORDS + 1], lamp[WEFT_BONN_WORDS + 1]; /* as the file says */
    double pixels_per_mm;        /* as the file says: may be anything */
    float rgb_scale[3];          /* told, and not applied */
    bool has_cosine;             /* values are times cos(theta_light) */
    int view_count, light_count; /* every view has as many lights */
    weft_vec3 *view;             /* [view_count] unit directions */
    weft_vec3 *light;            /* [view_count][light_count] */
    int width, height;           /* row 0 is the top row */
    float (*frame)[9];           /* [height][width] as the file says: tangent, bitangent, normal; NULL: none */
    weft_bonn_colour colour;
    weft_bonn_matrices matrices; /* image view * light_count + light, texel y * width + x */
    weft_lines notes;            /* what of the file is left out */
} weft_bonn_file;

/* The caller frees with weft_bonn_file_close. Errors: WEFT_BAD_INPUT naming the file and what is wrong or not read;
 * WEFT_SYSTEM. */
weft_code weft_bonn_file_open(const char *path, weft_bonn_file *file, weft_error *error);
void weft_bonn_file_close(weft_bonn_file *file);

#endif

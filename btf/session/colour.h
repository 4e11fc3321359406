/* The colours of a camera under a lamp, as `weft colour` finds them out: a JSON file (docs/reference/colour-format.md),
 * and a field of a session. */
#ifndef WEFT_BTF_SESSION_COLOUR_H
#define WEFT_BTF_SESSION_COLOUR_H

#include "base/status.h"

#include <jansson.h>
#include <stdbool.h>

enum { WEFT_COLOUR_LINEAR_TERMS = 3, WEFT_COLOUR_ROOT_TERMS = 6 };

/* CIEDE2000 over the patches of a chart. */
typedef struct weft_colour_residual {
    double mean, worst;
} weft_colour_residual;

/* From values of the camera, of which those of a perfect white diffuser under the same lamp are 1, to linear sRGB:
 *     srgb[i] = sum over k of matrix[i][k] term[k]
 * with the terms r, g, b, and of root polynomials sqrt(rg), sqrt(gb), sqrt(rb) (Finlayson, Mackiewicz and Hurlbert
 * 2015). Each row sums to 1: white stays white. All terms are of degree 1: twice the light is twice the value. */
typedef struct weft_colour {
    int terms; /* 0: none, colours are those of the camera; else WEFT_COLOUR_LINEAR_TERMS or WEFT_COLOUR_ROOT_TERMS */
    double matrix[3][WEFT_COLOUR_ROOT_TERMS];
    weft_colour_residual fitted;
    weft_colour_residual left_out; /* each patch by the matrix that is fitted to the others */
} weft_colour;

/* The terms of a value; a negative one has no root: 0. Pure. */
void weft_colour_terms(int terms, const double rgb[3], double term[WEFT_COLOUR_ROOT_TERMS]);

/* Turns rgb [count][3] into linear sRGB in place; nothing is done where colour->terms is 0. Values below 0 and above 1
 * are kept: colours outside sRGB, and noise. Pure. */
void weft_colour_apply(const weft_colour *colour, float *rgb, long count);

/* The fields of a colour. The caller owns the reference; NULL where memory is short. */
json_t *weft_colour_pack(const weft_colour *colour);

/* Reads what weft_colour_pack made. Errors: WEFT_BAD_INPUT naming the file `path` and what is wrong: a field, a value
 * beyond 1000, a row that does not sum to 1, a matrix that has no inverse at white; WEFT_SYSTEM. */
weft_code weft_colour_unpack(json_t *json, const char *path, weft_colour *colour, weft_error *error);

/* Reads a file of `weft colour`. Errors: as above. Thread-safe. */
weft_code weft_colour_read(const char *path, weft_colour *colour, weft_error *error);

/* Writes one atomically: the colour, and the members of `record` beside it (borrowed). Errors:
 * WEFT_BAD_INPUT naming a number that is not finite; WEFT_SYSTEM; WEFT_BAD_USAGE where the path names no file. */
weft_code weft_colour_write(const char *path, const weft_colour *colour, json_t *record, weft_error *error);

#endif

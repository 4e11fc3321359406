/* What the golden files hold, decoded, as text: one line a thing, its name first. */
#ifndef WEFT_TESTS_GOLDEN_PRINT_H
#define WEFT_TESTS_GOLDEN_PRINT_H

#include "base/status.h"
#include "base/vector.h"

#include <stdio.h>

/* Each reads a file of one kind and prints all that a reader can get from it. Errors: those of the reader. */
weft_code print_material(const char *path, FILE *out, weft_error *error);
weft_code print_dataset(const char *path, FILE *out, weft_error *error);
weft_code print_session(const char *path, FILE *out, weft_error *error);
weft_code print_weave(const char *path, FILE *out, weft_error *error);
weft_code print_stitch(const char *path, FILE *out, weft_error *error);
weft_code print_microcylinder(const char *path, FILE *out, weft_error *error);

/* " x y z" and " r g b" */
void print_vector(FILE *out, weft_vec3 vector);
void print_colour(FILE *out, weft_rgb colour);

#endif

/* Whether a text still says what it said. */
#ifndef WEFT_TESTS_GOLDEN_COMPARE_H
#define WEFT_TESTS_GOLDEN_COMPARE_H

#include <stdbool.h>
#include <stdio.h>

/* Compares the file `path`, which is what was said, with `actual`. Words must be the same. Numbers agree to 1e-6 of
 * themselves or to 1e-9; where the file has LOW..HIGH, a number between them will do. The first line that differs goes
 * to standard error. */
bool golden_compare(const char *path, FILE *actual);

#endif

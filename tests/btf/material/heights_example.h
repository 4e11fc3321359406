/* A material with heights of known contents. */
#ifndef WEFT_TESTS_HEIGHTS_EXAMPLE_H
#define WEFT_TESTS_HEIGHTS_EXAMPLE_H

#include "btf/material/material.h"

enum { HEIGHTS_EXAMPLE_WIDTH = 10, HEIGHTS_EXAMPLE_HEIGHT = 6 };

/* Code of place (x, y). */
uint8_t heights_example_code(int x, int y);

/* The example of components (tests/btf/components_example.h) with two by two heights a texel, from -0.75 to 0.5 mm, on
 * the two finest levels. */
void heights_write_example(const char *path);

#endif

/* A material with maps of what is seen, of known contents. */
#ifndef WEFT_TESTS_VISIBILITY_EXAMPLE_H
#define WEFT_TESTS_VISIBILITY_EXAMPLE_H

#include "btf/material/material.h"

enum { VISIBILITY_EXAMPLE_SIDE = 8 };

/* Cell `i` of all maps. */
uint8_t visibility_example_cell(int i);

/* The example of components (tests/btf/components_example.h) as if two finer levels and a coarser one were gone. */
void visibility_write_example(const char *path);

#endif

/* The cloths of microcylinder_cloths.csv. */
#ifndef WEFT_TESTS_REFLECTANCE_MICROCYLINDER_CLOTHS_H
#define WEFT_TESTS_REFLECTANCE_MICROCYLINDER_CLOTHS_H

#include "reflectance/microcylinder/microcylinder.h"

enum { REFERENCE_CLOTHS = 4 };

typedef struct reference_cloth {
    char name[32];
    weft_prepared_cloth prepared;
} reference_cloth;

/* Fails the test where the file does not hold them. */
void reference_cloths_read(reference_cloth cloths[REFERENCE_CLOTHS]);

const weft_prepared_cloth *reference_cloth_named(const reference_cloth cloths[REFERENCE_CLOTHS], const char *name);

#endif

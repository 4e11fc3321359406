#include "tests/support/fuzz.h"
#include "tests/support/scratch_folder.h"

#include <stdlib.h>

/* A file of version 1 with tables by components and opacity by itself. */
void fuzz_write_seed(const char *path)
{
    size_t size;
    unsigned char *bytes = scratch_load(WEFT_TEST_DATA "/../golden/good/material/components.weft", &size);
    scratch_store(path, bytes, size);
    free(bytes);
}

#include "tests/support/fuzz.h"
#include "tests/support/scratch_folder.h"

#include <stdlib.h>

/* A file of version 1 with compact sections. */
void fuzz_write_seed(const char *path)
{
    size_t size;
    unsigned char *bytes = scratch_load(WEFT_TEST_DATA "/../golden/good/material/example.weft", &size);
    scratch_store(path, bytes, size);
    free(bytes);
}

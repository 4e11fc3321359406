#include "tests/btf/material/layers_example.h"
#include "tests/support/fuzz.h"

/* Linear layers. */
void fuzz_write_seed(const char *path)
{
    layers_write_example(path);
}

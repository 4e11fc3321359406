#include "tests/btf/material/components_example.h"
#include "tests/support/fuzz.h"

/* Components. */
void fuzz_write_seed(const char *path)
{
    components_write_example(path);
}

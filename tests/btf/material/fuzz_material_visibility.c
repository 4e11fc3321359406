#include "tests/btf/material/visibility_example.h"
#include "tests/support/fuzz.h"

/* Maps of what a scene reaches. */
void fuzz_write_seed(const char *path)
{
    visibility_write_example(path);
}

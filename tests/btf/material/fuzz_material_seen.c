#include "tests/btf/material/seen_example.h"
#include "tests/support/fuzz.h"

/* Maps of what a scene reaches. */
void fuzz_write_seed(const char *path)
{
    seen_write_example(path);
}

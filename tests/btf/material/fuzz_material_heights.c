#include "tests/btf/material/heights_example.h"
#include "tests/support/fuzz.h"

/* Heights that components are seen through. */
void fuzz_write_seed(const char *path)
{
    heights_write_example(path);
}

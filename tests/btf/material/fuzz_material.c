#include "tests/btf/material/weft_bytes.h"
#include "tests/support/fuzz.h"

void fuzz_write_seed(const char *path)
{
    weft_bytes_write_example(path);
}

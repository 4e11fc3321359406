/* The entry of libFuzzer, and what tests/support/fuzz_main.c needs to run it without libFuzzer. */
#ifndef WEFT_TESTS_SUPPORT_FUZZ_H
#define WEFT_TESTS_SUPPORT_FUZZ_H

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* Writes a valid file to start from. */
void fuzz_write_seed(const char *path);

/* Path of a file in memory that holds `bytes`; the next call replaces it. */
const char *fuzz_file(const uint8_t *bytes, size_t size);

#endif

/* A material with components, for tests of its file. */
#ifndef WEFT_TESTS_BTF_COMPONENTS_EXAMPLE_H
#define WEFT_TESTS_BTF_COMPONENTS_EXAMPLE_H

/* Writes the material of tests/btf/weft_bytes.h with 8 components of distinct contents. */
void components_write_example(const char *path);

#endif

/* A material with layers, for tests of its file. */
#ifndef WEFT_TESTS_BTF_LAYERS_EXAMPLE_H
#define WEFT_TESTS_BTF_LAYERS_EXAMPLE_H

/* Writes the material of tests/btf/weft_bytes.h with 8 layers of distinct contents. */
void layers_write_example(const char *path);

#endif

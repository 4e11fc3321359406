/* The bytes of a .weft file, edited by hand: written from docs/reference/weft-format.md, not from the writer. */
#ifndef WEFT_TESTS_WEFT_BYTES_H
#define WEFT_TESTS_WEFT_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { WEFT_BYTES_HEADER = 64, WEFT_BYTES_ENTRY = 40 };

/* Offsets in an entry of the section table. */
enum {
    ENTRY_TYPE = 0,
    ENTRY_LEVEL = 4,
    ENTRY_CODEC = 8,
    ENTRY_CHECKSUM = 12,
    ENTRY_OFFSET = 16,
    ENTRY_STORED = 24,
    ENTRY_DECODED = 32
};

uint32_t weft_bytes_u32(const unsigned char *at);
uint64_t weft_bytes_u64(const unsigned char *at);
void weft_bytes_put_u32(unsigned char *at, uint32_t value);
void weft_bytes_put_u64(unsigned char *at, uint64_t value);

/* Entry number `index` of the section table. */
unsigned char *weft_bytes_entry(unsigned char *file, int index);

/* Index of the entry of a section, or -1. */
int weft_bytes_find(unsigned char *file, const char type[4], uint32_t level);

/* Makes the checksums right again, those of sections too where asked, as far as sections lie inside the file. */
void weft_bytes_repair(unsigned char *file, size_t size, bool sections);

/* Writes a material of 5 x 3 texels, all levels, 2 lobes with ceilings, 4 views with opacity, with distinct
 * contents. */
void weft_bytes_write_example(const char *path);

#endif

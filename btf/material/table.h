/* A .weft file in memory: its header and table of sections, checked before anything is allocated for what they claim.
 * Private to btf/. */
#ifndef WEFT_BTF_MATERIAL_TABLE_H
#define WEFT_BTF_MATERIAL_TABLE_H

#include "btf/material/format.h"

typedef struct weft_file_image {
    const char *path;
    unsigned char *bytes; /* [size] */
    size_t size;
    int section_count;
    weft_section *section;                                   /* [section_count] */
    int found[WEFT_SECTION_KINDS][WEFT_MATERIAL_MAX_LEVELS]; /* index + 1 of the section, 0 = none */
} weft_file_image;

/* Checks header, table, places, sizes and checksums of `bytes`, and sets the shape of `material`; nothing of it is
 * allocated yet. `section` is the caller's to free, also after an error. Errors: WEFT_BAD_INPUT names file and section;
 * WEFT_SYSTEM for memory. */
weft_code weft_file_image_open(weft_file_image *file, weft_material *material, weft_error *error);

/* The section of a kind and level; it must have been found. */
const weft_section *weft_file_section(const weft_file_image *file, weft_section_kind kind, int level);

/* Sets the error "section ... of level ...: what" and returns WEFT_BAD_INPUT. */
weft_code weft_fail_section(const weft_file_image *file, const weft_section *section, weft_error *error,
                            const char *what);

/* Number of directions that a basis of components (TPCA, SPCA) has tables over. Pure. */
int weft_section_directions(const weft_material *material, weft_section_kind kind);

#endif

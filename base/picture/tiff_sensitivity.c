#include "base/picture/tiff_sensitivity.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { EXIF_DIRECTORY = 34665, SENSITIVITY = 34855, SHORT = 3, LONG = 4, ENTRY_BYTES = 12 };

typedef struct tiff {
    FILE *file;
    bool big_endian;
} tiff;

static uint32_t number_of(const tiff *t, const unsigned char *byte, int count)
{
    uint32_t value = 0;
    for (int i = 0; i < count; i++)
        value |= (uint32_t)byte[i] << 8 * (t->big_endian ? count - 1 - i : i);
    return value;
}

/* The first value of an entry of a directory, where the entry holds it; 0 where it lies elsewhere. */
static uint32_t value_of(const tiff *t, const unsigned char *entry)
{
    uint32_t type = number_of(t, entry + 2, 2), count = number_of(t, entry + 4, 4);
    if (type == SHORT && (count == 1 || count == 2))
        return number_of(t, entry + 8, 2);
    return type == LONG && count == 1 ? number_of(t, entry + 8, 4) : 0;
}

/* The value of a tag in the directory at an offset; 0 where there is none. */
static uint32_t value_in(const tiff *t, uint32_t offset, uint32_t tag)
{
    unsigned char byte[ENTRY_BYTES] = {0};
    if (offset == 0 || fseek(t->file, (long)offset, SEEK_SET) != 0 || fread(byte, 2, 1, t->file) != 1)
        return 0;
    for (uint32_t left = number_of(t, byte, 2); left > 0 && fread(byte, ENTRY_BYTES, 1, t->file) == 1; left--) {
        if (number_of(t, byte, 2) == tag)
            return value_of(t, byte);
    }
    return 0;
}

double weft_tiff_sensitivity(const char *path)
{
    tiff t = {.file = fopen(path, "rb")};
    unsigned char head[8] = {0};
    uint32_t sensitivity = 0;
    if (!t.file)
        return 0;
    if (fread(head, sizeof head, 1, t.file) == 1) {
        t.big_endian = head[0] == 'M';
        if ((memcmp(head, "II", 2) == 0 || t.big_endian) && number_of(&t, head + 2, 2) == 42)
            sensitivity = value_in(&t, value_in(&t, number_of(&t, head + 4, 4), EXIF_DIRECTORY), SENSITIVITY);
    }
    fclose(t.file);
    return sensitivity;
}

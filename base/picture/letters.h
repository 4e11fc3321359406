/* Letters of the typeface as coverage in memory, for pictures that no OpenGL draws as for those that it does. */
#ifndef WEFT_BASE_PICTURE_LETTERS_H
#define WEFT_BASE_PICTURE_LETTERS_H

#include "base/status.h"

#include <stb/stb_truetype.h>
#include <stdint.h>

enum { WEFT_LETTER_FIRST = 32, WEFT_LETTER_COUNT = 95 };

/* Printable ASCII at one size, all in one square. */
typedef struct weft_letters {
    int size, side;    /* of a line, and of the square, pixels */
    uint8_t *coverage; /* [side][side], 255: ink */
    stbtt_bakedchar glyph[WEFT_LETTER_COUNT];
} weft_letters;

/* The square's first pixel is full. The caller frees with weft_letters_free. Errors: WEFT_SYSTEM. */
weft_code weft_letters_bake(int size, weft_letters *letters, weft_error *error);
void weft_letters_free(weft_letters *letters);

/* That of '?' for what is not printable ASCII. Pure. */
const stbtt_bakedchar *weft_letters_find(const weft_letters *letters, char letter);

/* Where the letter after this one begins, whole pixels further: one pixel of the square for each of the picture keeps
 * letters sharp. Pure. */
int weft_letters_advance(const weft_letters *letters, char letter);
/* Of a whole line. Pure. */
int weft_letters_length(const weft_letters *letters, const char *text);

#endif

#include "base/picture/letters.h"

#include "base/picture/font_file.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

weft_code weft_letters_bake(int size, weft_letters *letters, weft_error *error)
{
    const int side = 16 * size; /* room for 95 glyphs of at most size x size */
    *letters = (weft_letters){.size = size, .side = side, .coverage = calloc((size_t)side, (size_t)side)};
    if (!letters->coverage)
        return weft_fail_memory(error, "letters", (size_t)side * (size_t)side);
    if (stbtt_BakeFontBitmap(weft_font_file, 0, (float)size, letters->coverage, side, side, WEFT_LETTER_FIRST,
                             WEFT_LETTER_COUNT, letters->glyph) <= 0) {
        weft_letters_free(letters);
        return weft_fail(error, WEFT_SYSTEM, "cannot draw letters %d pixels high", size);
    }
    letters->coverage[0] = 255;
    return WEFT_OK;
}

void weft_letters_free(weft_letters *letters)
{
    free(letters->coverage);
    *letters = (weft_letters){0};
}

const stbtt_bakedchar *weft_letters_find(const weft_letters *letters, char letter)
{
    bool known = letter >= WEFT_LETTER_FIRST && letter < WEFT_LETTER_FIRST + WEFT_LETTER_COUNT;
    return &letters->glyph[(known ? letter : '?') - WEFT_LETTER_FIRST];
}

int weft_letters_advance(const weft_letters *letters, char letter)
{
    return (int)lroundf(weft_letters_find(letters, letter)->xadvance);
}

int weft_letters_length(const weft_letters *letters, const char *text)
{
    int length = 0;
    for (; *text; text++)
        length += weft_letters_advance(letters, *text);
    return length;
}

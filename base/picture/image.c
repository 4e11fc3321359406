#include "base/picture/image.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

weft_code weft_image_create(int width, int height, weft_image *image, weft_error *error)
{
    size_t bytes = (size_t)width * (size_t)height * 3 * sizeof(float);
    *image = (weft_image){.width = width, .height = height, .pixels = calloc(1, bytes)};
    return image->pixels ? WEFT_OK : weft_fail_memory(error, "image", bytes);
}

void weft_image_free(weft_image *image)
{
    free(image->pixels);
    *image = (weft_image){0};
}

/* Where the pixel (x, y) of the picture as it is shown lies in the file (Exif 2.3, tag 274: which side of the picture
 * its first row and its first column are). */
static size_t stored_at(const weft_image *image, int orientation, int x, int y)
{
    bool is_exchanged = orientation >= 5;
    int column = is_exchanged ? y : x, row = is_exchanged ? x : y;
    if (orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8)
        column = image->width - 1 - column;
    if (orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7)
        row = image->height - 1 - row;
    return 3 * ((size_t)row * (size_t)image->width + (size_t)column);
}

weft_code weft_image_turn(weft_image *image, int orientation, weft_error *error)
{
    if (orientation < 2 || orientation > 8)
        return WEFT_OK;
    weft_image shown;
    bool is_exchanged = orientation >= 5;
    WEFT_TRY(weft_image_create(is_exchanged ? image->height : image->width, is_exchanged ? image->width : image->height,
                               &shown, error));
    float *pixel = shown.pixels;
    for (int y = 0; y < shown.height; y++) {
        for (int x = 0; x < shown.width; x++, pixel += 3)
            memcpy(pixel, image->pixels + stored_at(image, orientation, x, y), 3 * sizeof *pixel);
    }
    shown.is_partial = image->is_partial;
    weft_image_free(image);
    *image = shown;
    return WEFT_OK;
}

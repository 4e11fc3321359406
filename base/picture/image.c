#include "base/picture/image.h"

#include <stdlib.h>

weft_code weft_image_create(int width, int height, weft_image *image, weft_error *error)
{
    size_t bytes = (size_t)width * (size_t)height * 3 * sizeof(float);
    *image = (weft_image){width, height, calloc(1, bytes)};
    return image->pixels ? WEFT_OK : weft_fail_memory(error, "image", bytes);
}

void weft_image_free(weft_image *image)
{
    free(image->pixels);
    *image = (weft_image){0};
}

/* Mutated pictures: their settings are read, or refused with a message that names the file. */
#include "player/settings/settings.h"
#include "tests/player/settings_text.h"
#include "tests/support/fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void fuzz_write_seed(const char *path)
{
    weft_image image;
    if (weft_image_create(4, 3, &image, NULL) != WEFT_OK ||
        weft_image_write_settings("seed.png", &image, "a picture", SETTINGS_TEXT, NULL) != WEFT_OK ||
        rename("seed.png", path) != 0)
        abort();
    weft_image_free(&image);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    weft_settings settings;
    weft_error error = {0};
    FILE *file = fopen("fuzz.png", "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0)
        abort();
    weft_code code = weft_settings_read("fuzz.png", &settings, &error);
    if (code != WEFT_OK && (error.code != code || !strstr(error.message, "fuzz.png")))
        abort();
    weft_settings_free(&settings);
    return 0;
}

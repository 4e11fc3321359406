/* Mutated settings: refused with a message, or written back to a text that says the same. */
#include "player/settings/settings.h"
#include "tests/player/settings_text.h"
#include "tests/support/fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void fuzz_write_seed(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file || fputs(SETTINGS_TEXT, file) < 0 || fclose(file) != 0)
        abort();
}

static char *format(const weft_settings *settings, weft_error *error)
{
    char *text = NULL;
    weft_code code = weft_settings_format(settings, "fuzz.json", &text, error);
    if (code != WEFT_OK && (weft_class_of(code) != WEFT_BAD_INPUT || !strstr(error->message, "the folder of")))
        abort();
    return text;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    weft_settings settings, again;
    weft_error error = {0};
    weft_code code = weft_settings_parse((const char *)bytes, size, "fuzz.json", &settings, &error);
    if (code != WEFT_OK && (error.code != code || !strstr(error.message, "fuzz.json")))
        abort();
    char *text = code == WEFT_OK ? format(&settings, &error) : NULL;
    if (text) {
        if (weft_settings_parse(text, strlen(text), "fuzz.json", &again, &error) != WEFT_OK)
            abort();
        char *same = format(&again, &error);
        if (!same || strcmp(text, same) != 0)
            abort();
        free(same);
        weft_settings_free(&again);
    }
    free(text);
    weft_settings_free(&settings);
    return 0;
}

/* Mutated microcylinder files: refused with a message, or read and evaluated to finite values. */
#include "reflectance/microcylinder/file.h"
#include "tests/reflectance/microcylinder/microcylinder_text.h"
#include "tests/support/fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void fuzz_write_seed(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file || fputs(MICROCYLINDER_TEXT, file) < 0 || fclose(file) != 0)
        abort();
}

static void evaluate(const weft_microcylinder_cloth *cloth)
{
    const weft_vec3 light = weft_unit(weft_vec3_of((weft_real)0.3, (weft_real)-0.2, 1));
    const weft_vec3 view = weft_unit(weft_vec3_of((weft_real)-0.2, (weft_real)0.1, 1));
    weft_prepared_cloth prepared = weft_microcylinder_prepare(cloth);
    weft_rgb f = weft_microcylinder_brdf(&prepared, WEFT_CLOTH_BY_AREA, light, view);
    if (!(prepared.admissible && f.r >= 0 && f.g >= 0 && f.b >= 0 && isfinite(f.r + f.g + f.b)))
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const weft_parameter parameters[] = {{"a", {1, 1, 1}}};
    char *text = malloc(size + 1);
    weft_microcylinder_description description;
    weft_error error = {0};
    if (!text)
        abort();
    memcpy(text, bytes, size);
    text[size] = '\0';
    weft_code code = weft_microcylinder_parse(text, "fuzz.mc", parameters, 1, &description, &error);
    if (code != WEFT_OK && (error.code != code || strncmp(error.message, "fuzz.mc:", 8) != 0))
        abort();
    if (code == WEFT_OK)
        evaluate(&description.cloth);
    free(text);
    return 0;
}

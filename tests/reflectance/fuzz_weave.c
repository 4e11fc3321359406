/* Mutated weave files: refused with a message, or read and evaluated to finite values. */
#include "reflectance/weave/syntax.h"
#include "tests/reflectance/weave_text.h"
#include "tests/support/fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void fuzz_write_seed(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file || fputs(WEAVE_TEXT, file) < 0 || fclose(file) != 0)
        abort();
}

static void evaluate(const weft_weave *weave)
{
    const weft_vec3 light = weft_unit(weft_vec3_of((weft_real)0.3, (weft_real)-0.2, 1));
    const weft_vec3 view = weft_unit(weft_vec3_of((weft_real)-0.2, (weft_real)0.1, 1));
    for (int i = 0; i < 16; i++) {
        weft_real U = (weft_real)(i % 4) / 3, V = (weft_real)(i / 4) / 3;
        weft_weave_point point = weft_weave_locate(weave, U, V, 1);
        weft_rgb f = weft_weave_brdf(weave, &point, light, view);
        if (!(isfinite(f.r) && isfinite(f.g) && isfinite(f.b) && f.r >= 0 && f.g >= 0 && f.b >= 0))
            abort();
    }
}

/* Without the scale, which only takes time: it is 1 here. */
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const weft_parameter parameters[] = {{"a", {1, 1, 1}}};
    char warning[WEFT_MESSAGE_SIZE], *text = malloc(size + 1);
    weft_weave weave;
    weft_error error = {0};
    if (!text)
        abort();
    memcpy(text, bytes, size);
    text[size] = '\0';
    weft_code code = weft_weave_parse_text(text, "fuzz.wv", parameters, 1, &weave, &error);
    if (code != WEFT_OK && (error.code != code || strncmp(error.message, "fuzz.wv:", 8) != 0))
        abort();
    if (code == WEFT_OK) {
        weft_weave_derive(&weave, "fuzz.wv", warning);
        weave.specular_scale = 1;
        evaluate(&weave);
        weft_weave_free(&weave);
    }
    free(text);
    return 0;
}

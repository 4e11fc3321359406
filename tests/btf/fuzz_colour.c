#include "btf/session/colour.h"
#include "tests/support/fuzz.h"

#include <math.h>
#include <stdlib.h>

void fuzz_write_seed(const char *path)
{
    const weft_colour colour = {
        WEFT_COLOUR_ROOT_TERMS,
        {{0.5, -0.5, 0.1, 1.2, 0.1, -0.4}, {0.1, 0.9, -0.3, -0.1, 0.5, -0.1}, {0.2, -0.2, 1.25, 0.25, -0.25, -0.25}},
        {1, 2},
        {3, 4}};
    json_t *record = json_pack("{ss}", "chart", "classic");
    if (weft_colour_write(path, &colour, record, NULL) != WEFT_OK)
        abort();
    json_decref(record);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    weft_colour colour;
    weft_error error = {0};
    weft_code code = weft_colour_read(fuzz_file(bytes, size), &colour, &error);
    if (code != WEFT_OK && (error.code != code || !error.message[0]))
        abort();
    if (code == WEFT_OK) {
        /* What was read keeps white. */
        float rgb[6] = {1, 1, 1, 0.2f, -0.1f, 0.7f};
        weft_colour_apply(&colour, rgb, 2);
        for (int i = 0; i < 6; i++)
            if (!isfinite(rgb[i]) || (i < 3 && fabsf(rgb[i] - 1) > 1e-4f))
                abort();
    }
    return 0;
}

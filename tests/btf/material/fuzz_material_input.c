/* A .weft file of whatever seed. */
#include "btf/material/material.h"
#include "tests/btf/material/weft_bytes.h"
#include "tests/support/fuzz.h"

#include <stdlib.h>
#include <string.h>

static void read_once(const uint8_t *bytes, size_t size)
{
    weft_material material;
    weft_error error = {0};
    weft_code code = weft_material_read(fuzz_file(bytes, size), &material, &error);
    if (code != WEFT_OK && (error.code != code || !error.message[0]))
        abort();
    if (code == WEFT_OK)
        weft_material_free(&material);
}

/* As it is, and with right checksums: a reader that only checks those would pass the first. */
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    uint8_t *repaired = malloc(size + 1);
    if (!repaired)
        abort();
    memcpy(repaired, bytes, size);
    if (size >= WEFT_BYTES_HEADER)
        weft_bytes_put_u64(repaired + 16, size);
    weft_bytes_repair(repaired, size, true);
    read_once(bytes, size);
    read_once(repaired, size);
    free(repaired);
    return 0;
}

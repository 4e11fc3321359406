#include "inspect/verify.h"

/* Index of the first value that is not finite, or -1. */
static long first_bad(const weft_half *value, long count)
{
    for (long i = 0; i < count; i++) {
        if ((value[i] & 0x7c00) == 0x7c00)
            return i;
    }
    return -1;
}

static weft_code check_values(const char *path, const char *what, int level, const weft_material_level *at,
                              const weft_half *value, long repeats, weft_error *error)
{
    long bad = first_bad(value, repeats * at->width * at->height * 4);
    if (bad < 0)
        return WEFT_OK;
    long texel = bad / 4 % ((long)at->width * at->height);
    return weft_fail(error, WEFT_BAD_INPUT, "'%s': %s of texel (%ld, %ld), level %d, is not finite", path, what,
                     texel % at->width, texel / at->width, level);
}

weft_code weft_verify_material(const char *path, const weft_material *material, weft_error *error)
{
    for (int i = 0; i < material->level_count; i++) {
        const weft_material_level *level = &material->level[i];
        WEFT_TRY(check_values(path, "diffuse term", i, level, level->diffuse, 1, error));
        WEFT_TRY(check_values(path, "lobe", i, level, level->lobe, 3L * material->lobe_count, error));
    }
    return WEFT_OK;
}

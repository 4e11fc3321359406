#include "player/texture/seen_texture.h"

weft_code weft_seen_texture_upload(const weft_seen *seen, weft_seen_texture *t, weft_error *error)
{
    *t = (weft_seen_texture){0};
    if (!seen)
        return WEFT_OK;
    t->finer_levels = seen->finer_levels;
    t->coarser_levels = seen->coarser_levels;
    t->level_count = seen->level_count;
    return weft_gl_texture((weft_texture_format){GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE}, seen->side, seen->side,
                           WEFT_SEEN_PLACES + seen->level_count, seen->cell, &t->maps, error);
}

void weft_seen_texture_free(weft_seen_texture *t)
{
    glDeleteTextures(1, &t->maps);
    *t = (weft_seen_texture){0};
}

void weft_seen_texture_bind(const weft_seen_texture *t, GLuint program, int unit)
{
    weft_gl_bind(program, "seen_maps", unit, GL_TEXTURE_2D_ARRAY, t->maps);
    weft_gl_set_float(program, "seen_finest", t->finer_levels > 0 ? 0 : -1000);
    weft_gl_set_float(program, "seen_coarsest", t->coarser_levels > 0 ? t->level_count - 1 : 1000);
    weft_gl_set_float(program, "seen_last_level", t->level_count - 1);
}

#include "player/texture/visibility_texture.h"

weft_code weft_visibility_texture_upload(const weft_material_visibility *visibility, weft_visibility_texture *t,
                                         weft_error *error)
{
    *t = (weft_visibility_texture){0};
    if (!visibility)
        return WEFT_OK;
    t->finer_levels = visibility->finer_levels;
    t->coarser_levels = visibility->coarser_levels;
    t->level_count = visibility->level_count;
    return weft_gl_texture((weft_texture_format){GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE}, visibility->side,
                           visibility->side, WEFT_MATERIAL_VISIBILITY_PLACES + visibility->level_count,
                           visibility->cell, &t->maps, error);
}

void weft_visibility_texture_free(weft_visibility_texture *t)
{
    glDeleteTextures(1, &t->maps);
    *t = (weft_visibility_texture){0};
}

void weft_visibility_texture_bind(const weft_visibility_texture *t, GLuint program, int unit)
{
    weft_gl_bind(program, "seen_maps", unit, GL_TEXTURE_2D_ARRAY, t->maps);
    weft_gl_set_float(program, "seen_finest", t->finer_levels > 0 ? 0 : -1000);
    weft_gl_set_float(program, "seen_coarsest", t->coarser_levels > 0 ? t->level_count - 1 : 1000);
    weft_gl_set_float(program, "seen_last_level", t->level_count - 1);
}

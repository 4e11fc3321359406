#include "player/texture/thread_texture.h"

weft_code weft_thread_texture_upload(const weft_microcylinder_cloth *cloth, weft_thread_texture *t, weft_error *error)
{
    float texel[WEFT_MICROCYLINDER_TABLE_WIDTH][4];
    GLuint table = 0;
    const weft_prepared_cloth prepared = weft_microcylinder_prepare(cloth);
    weft_microcylinder_table(&prepared, texel);
    WEFT_TRY(weft_gl_texture((weft_texture_format){GL_RGBA32F, GL_RGBA, GL_FLOAT}, WEFT_MICROCYLINDER_TABLE_WIDTH, 1, 0,
                             texel, &table, error));
    glDeleteTextures(1, &t->table);
    t->table = table;
    return WEFT_OK;
}

void weft_thread_texture_free(weft_thread_texture *t)
{
    glDeleteTextures(1, &t->table);
    t->table = 0;
}

size_t weft_thread_texture_bytes(const weft_thread_texture *t)
{
    return t->table ? (size_t)16 * WEFT_MICROCYLINDER_TABLE_WIDTH : 0;
}

void weft_thread_texture_bind(const weft_thread_texture *t, GLuint program)
{
    weft_gl_bind(program, "thread_table", 0, GL_TEXTURE_2D, t->table);
}

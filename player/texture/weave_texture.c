#include "player/texture/weave_texture.h"

#include <math.h>

static const weft_texture_format float_format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};

static void delete_cloth(weft_weave_texture *t)
{
    glDeleteTextures(1, &t->table);
    glDeleteTextures(1, &t->means);
    glDeleteTextures(1, &t->noisy_means);
}

static weft_code upload_means(const weft_weave_means *means, GLuint *texture, weft_error *error)
{
    return weft_gl_texture(float_format, WEFT_WEAVE_MEAN_WIDTH, means->kinds, 0, means->texel, texture, error);
}

static weft_code upload_cloth(const weft_weave_texels *texels, weft_weave_texture *t, weft_error *error)
{
    WEFT_TRY(weft_gl_texture(float_format, texels->width, texels->height, 0, texels->table, &t->table, error));
    WEFT_TRY(upload_means(&texels->means, &t->means, error));
    return texels->noisy_means.texel ? upload_means(&texels->noisy_means, &t->noisy_means, error) : WEFT_OK;
}

weft_code weft_weave_texture_upload(const weft_weave_texels *texels, const weft_weave_layout *layout,
                                    weft_weave_texture *t, weft_error *error)
{
    double tiles_u = layout->tiles_u, tiles_v = layout->tiles_v;
    if (!(tiles_u > 0) || !(tiles_v > 0) || !isfinite(tiles_u) || !isfinite(tiles_v))
        return weft_fail(error, WEFT_BAD_USAGE, "a material of %g x %g tiles cannot be shown", tiles_u, tiles_v);
    weft_weave_texture added = {.texels = texels->width * texels->height,
                                .has_noise = texels->has_noise,
                                .has_staples = texels->means.has_staples,
                                .has_filaments = texels->means.has_filaments,
                                .layout = *layout};
    added.texels += WEFT_WEAVE_MEAN_WIDTH * (texels->means.kinds + texels->noisy_means.kinds);
    weft_code code = upload_cloth(texels, &added, error);
    delete_cloth(code == WEFT_OK ? t : &added);
    if (code == WEFT_OK)
        *t = added;
    return code;
}

void weft_weave_texture_free(weft_weave_texture *t)
{
    delete_cloth(t);
    *t = (weft_weave_texture){0};
}

size_t weft_weave_texture_bytes(const weft_weave_texture *t)
{
    return 16 * (size_t)t->texels;
}

void weft_weave_texture_bind(const weft_weave_texture *t, GLuint program, unsigned noise_seed)
{
    weft_gl_bind(program, "weave_table", 0, GL_TEXTURE_2D, t->table);
    weft_gl_bind(program, "weave_means", 1, GL_TEXTURE_2D, noise_seed && t->noisy_means ? t->noisy_means : t->means);
    glUniform2ui(weft_gl_uniform(program, "noise_seed"), noise_seed, 0);
    weft_gl_set_vec2(program, "weave_tiles", t->layout.tiles_u, t->layout.tiles_v);
    weft_gl_set_vec2(program, "weave_corner", t->layout.corner_u, t->layout.corner_v);
}

/* ---- Threads ---- */

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

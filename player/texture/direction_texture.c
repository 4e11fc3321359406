#include "player/texture/direction_texture.h"

#include <stdlib.h>
#include <string.h>

static int rows_for(int count, int per_row)
{
    return (count + per_row - 1) / per_row;
}

static weft_code upload_simplices(const weft_direction_map *map, GLuint *texture, weft_error *error)
{
    const weft_texture_format format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    int rows = rows_for(map->simplex_count, WEFT_DIRECTION_SIMPLICES_PER_ROW);
    weft_simplex *padded = calloc((size_t)rows * WEFT_DIRECTION_SIMPLICES_PER_ROW, sizeof *padded);
    if (!padded)
        return weft_fail_memory(error, "direction texture", (size_t)rows * WEFT_DIRECTION_SIMPLICES_PER_ROW);
    memcpy(padded, map->simplex, (size_t)map->simplex_count * sizeof *padded);
    weft_code code = weft_gl_texture(format, 4 * WEFT_DIRECTION_SIMPLICES_PER_ROW, rows, 0, padded, texture, error);
    free(padded);
    return code;
}

static weft_code upload_cells(const weft_direction_map *map, GLuint *texture, weft_error *error)
{
    const weft_texture_format format = {GL_R32I, GL_RED_INTEGER, GL_INT};
    int rows = rows_for(map->set_count, WEFT_DIRECTION_SETS_PER_ROW);
    WEFT_TRY(weft_gl_texture(format, WEFT_DIRECTION_SETS_PER_ROW * WEFT_DIRECTION_GRID, rows * WEFT_DIRECTION_GRID, 0,
                             NULL, texture, error));
    for (int set = 0; set < map->set_count; set++)
        glTexSubImage2D(GL_TEXTURE_2D, 0, set % WEFT_DIRECTION_SETS_PER_ROW * WEFT_DIRECTION_GRID,
                        set / WEFT_DIRECTION_SETS_PER_ROW * WEFT_DIRECTION_GRID, WEFT_DIRECTION_GRID,
                        WEFT_DIRECTION_GRID, GL_RED_INTEGER, GL_INT, map->cell[set]);
    return weft_gl_check("uploading directions", error);
}

weft_code weft_direction_texture_upload(const weft_direction_map *map, weft_direction_texture *texture,
                                        weft_error *error)
{
    *texture = (weft_direction_texture){0};
    WEFT_TRY(upload_simplices(map, &texture->simplex, error));
    return upload_cells(map, &texture->cell, error);
}

void weft_direction_texture_free(weft_direction_texture *texture)
{
    glDeleteTextures(1, &texture->simplex);
    glDeleteTextures(1, &texture->cell);
    *texture = (weft_direction_texture){0};
}

void weft_direction_texture_bind(const weft_direction_texture *texture, GLuint program, int unit)
{
    weft_gl_bind(program, "direction_simplex", unit, GL_TEXTURE_2D, texture->simplex);
    weft_gl_bind(program, "direction_cell", unit + 1, GL_TEXTURE_2D, texture->cell);
}

#include "player/material_texture.h"

static const weft_texture_format frame_format = {GL_RGB16I, GL_RGB_INTEGER, GL_SHORT};
static const weft_texture_format half_format = {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
static const weft_texture_format table_format = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};

static weft_code upload_frames(const weft_material *material, weft_material_texture *t, weft_error *error)
{
    const weft_mip_layout *layout = &t->layout;
    WEFT_TRY(weft_gl_texture(frame_format, layout->width, layout->height, 0, NULL, &t->frame, error));
    for (int k = 0; k < layout->level_count; k++) {
        weft_mip_area a = layout->area[k];
        glTexSubImage2D(GL_TEXTURE_2D, 0, a.x, a.y, a.width, a.height, frame_format.layout, frame_format.type,
                        material->level[k].frame);
    }
    return weft_gl_check("uploading frames", error);
}

static weft_code upload_diffuse(const weft_material *material, weft_material_texture *t, weft_error *error)
{
    const weft_mip_layout *layout = &t->layout;
    WEFT_TRY(weft_gl_texture(half_format, layout->width, layout->height, 0, NULL, &t->diffuse, error));
    for (int k = 0; k < layout->level_count; k++) {
        weft_mip_area a = layout->area[k];
        glTexSubImage2D(GL_TEXTURE_2D, 0, a.x, a.y, a.width, a.height, half_format.layout, half_format.type,
                        material->level[k].diffuse);
    }
    return weft_gl_check("uploading diffuse terms", error);
}

/* A material without lobes gets one layer that is never fetched: samplers must not be left empty. */
static weft_code upload_lobes(const weft_material *material, weft_material_texture *t, weft_error *error)
{
    const weft_mip_layout *layout = &t->layout;
    int layers = 3 * material->lobe_count;
    WEFT_TRY(weft_gl_texture(half_format, layout->width, layout->height, layers ? layers : 1, NULL, &t->lobe, error));
    for (int k = 0; layers > 0 && k < layout->level_count; k++) {
        weft_mip_area a = layout->area[k];
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, a.x, a.y, 0, a.width, a.height, layers, half_format.layout,
                        half_format.type, material->level[k].lobe);
    }
    return weft_gl_check("uploading lobes", error);
}

static const uint8_t *codes_of(const weft_material_level *level, bool of_lights)
{
    return of_lights ? level->light_table : level->table;
}

/* A table that is not there gets one layer that is never fetched. */
static weft_code upload_table(const weft_material *material, const weft_mip_layout *layout, bool of_lights,
                              weft_table_texture *table, weft_error *error)
{
    int count = of_lights ? material->light_count : material->view_count, most = weft_gl_max_layers();
    int columns = count > 0 ? (count + most - 1) / most : 1, layers = count > 0 ? (count + columns - 1) / columns : 1;
    *table = (weft_table_texture){.count = count, .columns = columns};
    WEFT_TRY(weft_gl_texture(table_format, layout->width * columns, layout->height, layers, NULL, &table->name, error));
    for (int k = 0; count > 0 && k < layout->level_count; k++) {
        weft_mip_area a = layout->area[k];
        const uint8_t *code = codes_of(&material->level[k], of_lights);
        for (int i = 0; i < count; i++)
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, a.x + i % columns * layout->width, a.y, i / columns, a.width,
                            a.height, 1, table_format.layout, table_format.type,
                            code + (size_t)i * (size_t)a.width * (size_t)a.height * 4);
    }
    return weft_gl_check(of_lights ? "uploading the light table" : "uploading the view table", error);
}

static weft_code add_directions(weft_direction_map *map, const weft_vec3 *direction, int count, weft_error *error)
{
    const weft_vec3 zenith = {0, 0, 1};
    return weft_direction_map_add(map, count > 0 ? direction : &zenith, NULL, count > 0 ? count : 1, error);
}

static weft_code upload_directions(const weft_material *material, weft_material_texture *t, weft_error *error)
{
    weft_direction_map map = {0};
    weft_code code = add_directions(&map, material->view, material->view_count, error);
    if (code == WEFT_OK)
        code = add_directions(&map, material->light, material->light_count, error);
    if (code == WEFT_OK)
        code = weft_direction_texture_upload(&map, &t->directions, error);
    weft_direction_map_free(&map);
    return code;
}

static bool is_opaque(const weft_material *material)
{
    for (int k = 0; k < material->level_count; k++) {
        const weft_material_level *level = &material->level[k];
        size_t count = (size_t)level->width * (size_t)level->height * (size_t)material->view_count;
        for (size_t i = 0; level->table && i < count; i++) {
            if (level->table[4 * i + 3] != 255)
                return false;
        }
    }
    return true;
}

weft_code weft_material_texture_upload(const weft_material *material, weft_material_texture *t, weft_error *error)
{
    *t = (weft_material_texture){
        .layout = weft_mip_layout_of(material->level[0].width, material->level[0].height, material->level_count, 0),
        .lobe_count = material->lobe_count,
        .opaque = is_opaque(material),
    };
    WEFT_TRY(upload_frames(material, t, error));
    WEFT_TRY(upload_diffuse(material, t, error));
    WEFT_TRY(upload_lobes(material, t, error));
    WEFT_TRY(upload_table(material, &t->layout, false, &t->table, error));
    WEFT_TRY(upload_table(material, &t->layout, true, &t->light_table, error));
    return upload_directions(material, t, error);
}

void weft_material_texture_free(weft_material_texture *t)
{
    glDeleteTextures(1, &t->frame);
    glDeleteTextures(1, &t->diffuse);
    glDeleteTextures(1, &t->lobe);
    glDeleteTextures(1, &t->table.name);
    glDeleteTextures(1, &t->light_table.name);
    weft_direction_texture_free(&t->directions);
    *t = (weft_material_texture){0};
}

void weft_material_texture_bind(const weft_material_texture *t, GLuint program)
{
    weft_gl_bind(program, "material_frame", 0, GL_TEXTURE_2D, t->frame);
    weft_gl_bind(program, "material_diffuse", 1, GL_TEXTURE_2D, t->diffuse);
    weft_gl_bind(program, "material_lobe", 2, GL_TEXTURE_2D_ARRAY, t->lobe);
    weft_gl_bind(program, "material_table", 3, GL_TEXTURE_2D_ARRAY, t->table.name);
    weft_gl_bind(program, "material_light_table", 4, GL_TEXTURE_2D_ARRAY, t->light_table.name);
    weft_direction_texture_bind(&t->directions, program, 5);
    weft_gl_set_int(program, "lobe_count", t->lobe_count);
    weft_gl_set_int(program, "has_table", t->table.count > 0);
    weft_gl_set_int(program, "has_light_table", t->light_table.count > 0);
    weft_gl_set_int(program, "opaque", t->opaque);
    weft_gl_set_int(program, "level_count", t->layout.level_count);
    glUniform2i(glGetUniformLocation(program, "table_tiles"), t->table.columns, t->layout.width);
    glUniform2i(glGetUniformLocation(program, "light_table_tiles"), t->light_table.columns, t->layout.width);
    glUniform4iv(glGetUniformLocation(program, "level_area"), t->layout.level_count, &t->layout.area[0].x);
}

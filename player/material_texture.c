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

static weft_code upload_table(const weft_material *material, weft_material_texture *t, weft_error *error)
{
    const weft_mip_layout *layout = &t->layout;
    int views = t->has_table ? material->view_count : 1, columns = t->table_columns;
    WEFT_TRY(weft_gl_texture(table_format, layout->width * columns, layout->height, (views + columns - 1) / columns,
                             NULL, &t->table, error));
    for (int k = 0; t->has_table && k < layout->level_count; k++) {
        weft_mip_area a = layout->area[k];
        for (int view = 0; view < views; view++)
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, a.x + view % columns * layout->width, a.y, view / columns, a.width,
                            a.height, 1, table_format.layout, table_format.type,
                            material->level[k].table + (size_t)view * (size_t)a.width * (size_t)a.height * 4);
    }
    return weft_gl_check("uploading the view table", error);
}

static weft_code upload_directions(const weft_material *material, weft_material_texture *t, weft_error *error)
{
    const weft_vec3 zenith = {0, 0, 1};
    weft_direction_map map = {0};
    weft_code code = weft_direction_map_add(&map, t->has_table ? material->view : &zenith, NULL,
                                            t->has_table ? material->view_count : 1, error);
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
    int layers = weft_gl_max_layers();
    *t = (weft_material_texture){
        .layout = weft_mip_layout_of(material->level[0].width, material->level[0].height, material->level_count, 0),
        .lobe_count = material->lobe_count,
        .has_table = material->view_count > 0 && material->level[0].table,
        .opaque = is_opaque(material),
        .table_columns = material->view_count > 0 ? (material->view_count + layers - 1) / layers : 1,
    };
    WEFT_TRY(upload_frames(material, t, error));
    WEFT_TRY(upload_diffuse(material, t, error));
    WEFT_TRY(upload_lobes(material, t, error));
    WEFT_TRY(upload_table(material, t, error));
    return upload_directions(material, t, error);
}

void weft_material_texture_free(weft_material_texture *t)
{
    glDeleteTextures(1, &t->frame);
    glDeleteTextures(1, &t->diffuse);
    glDeleteTextures(1, &t->lobe);
    glDeleteTextures(1, &t->table);
    weft_direction_texture_free(&t->directions);
    *t = (weft_material_texture){0};
}

void weft_material_texture_bind(const weft_material_texture *t, GLuint program)
{
    weft_gl_bind(program, "material_frame", 0, GL_TEXTURE_2D, t->frame);
    weft_gl_bind(program, "material_diffuse", 1, GL_TEXTURE_2D, t->diffuse);
    weft_gl_bind(program, "material_lobe", 2, GL_TEXTURE_2D_ARRAY, t->lobe);
    weft_gl_bind(program, "material_table", 3, GL_TEXTURE_2D_ARRAY, t->table);
    weft_direction_texture_bind(&t->directions, program, 4);
    weft_gl_set_int(program, "lobe_count", t->lobe_count);
    weft_gl_set_int(program, "has_table", t->has_table);
    weft_gl_set_int(program, "opaque", t->opaque);
    weft_gl_set_int(program, "level_count", t->layout.level_count);
    glUniform2i(glGetUniformLocation(program, "table_tiles"), t->table_columns, t->layout.width);
    glUniform4iv(glGetUniformLocation(program, "level_area"), t->layout.level_count, &t->layout.area[0].x);
}

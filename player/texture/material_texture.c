#include "player/texture/material_texture.h"

#include "reflectance/relief/material_relief.h"

#include <math.h>
#include <stdlib.h>

static const weft_texture_format packed_format = {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT};
static const weft_texture_format table_format = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};

/* The rotation from the axes of the surface to those of the texel, as a unit quaternion with w >= 0 (Shepperd 1978). */
static void encode_rotation(const weft_frame *frame, int16_t code[4])
{
    const double m[3][3] = {{(double)frame->tangent.x, (double)frame->bitangent.x, (double)frame->normal.x},
                            {(double)frame->tangent.y, (double)frame->bitangent.y, (double)frame->normal.y},
                            {(double)frame->tangent.z, (double)frame->bitangent.z, (double)frame->normal.z}};
    double q[4];
    if (m[0][0] + m[1][1] + m[2][2] > 0) {
        q[3] = sqrt(fmax(0, 1 + m[0][0] + m[1][1] + m[2][2])) / 2;
        for (int i = 0; i < 3; i++)
            q[i] = (m[(i + 2) % 3][(i + 1) % 3] - m[(i + 1) % 3][(i + 2) % 3]) / (4 * q[3]);
    } else {
        int i = m[1][1] > m[0][0] ? 1 : 0;
        i = m[2][2] > m[i][i] ? 2 : i;
        int j = (i + 1) % 3, k = (i + 2) % 3;
        q[i] = sqrt(fmax(0, 1 + m[i][i] - m[j][j] - m[k][k])) / 2;
        q[j] = (m[j][i] + m[i][j]) / (4 * q[i]);
        q[k] = (m[k][i] + m[i][k]) / (4 * q[i]);
        q[3] = (m[k][j] - m[j][k]) / (4 * q[i]);
    }
    for (int i = 0; i < 4; i++)
        code[i] = (int16_t)lrint(32767 * fmin(fmax(q[i], -1), 1));
}

static uint32_t packed(uint16_t low, uint16_t high)
{
    return (uint32_t)high << 16 | low;
}

static void pack_base(const weft_material_level *level, size_t texel, uint32_t word[4])
{
    int16_t rotation[4];
    weft_frame frame = weft_frame_decode(level->frame + 3 * texel);
    const weft_half *diffuse = level->diffuse + 4 * texel;
    encode_rotation(&frame, rotation);
    word[0] = packed((uint16_t)rotation[0], (uint16_t)rotation[1]);
    word[1] = packed((uint16_t)rotation[2], (uint16_t)rotation[3]);
    word[2] = packed(diffuse[0], diffuse[1]);
    word[3] = packed(diffuse[2], diffuse[3]);
}

static void pack_lobe(const weft_material_level *level, size_t texels, size_t texel, int lobe, uint32_t word[2])
{
    const weft_half *code = level->lobe + 4 * ((size_t)lobe * texels + texel);
    word[0] = packed(code[0], code[1]);
    word[1] = packed(code[2], code[3]);
}

static void pack_layer(const weft_material_level *level, int lobes, int layer, uint32_t (*word)[4])
{
    size_t texels = (size_t)level->width * (size_t)level->height;
    int first = 2 * (layer - 1);
    for (size_t i = 0; i < texels; i++) {
        if (layer == 0)
            pack_base(level, i, word[i]);
        for (int lobe = first; layer > 0 && lobe < first + 2 && lobe < lobes; lobe++)
            pack_lobe(level, texels, i, lobe, word[i] + 2 * (lobe - first));
    }
}

static weft_code upload_texels(const weft_material *material, weft_material_texture *t, weft_error *error)
{
    const weft_mip_layout *layout = &t->layout;
    int lobes = 3 * material->lobe_count, layers = 1 + (lobes + 1) / 2;
    size_t most = (size_t)layout->area[0].width * (size_t)layout->area[0].height;
    uint32_t(*word)[4] = calloc(most, sizeof *word);
    if (!word)
        return weft_fail_memory(error, "texels", most * sizeof *word);
    weft_code code = weft_gl_texture(packed_format, layout->width, layout->height, layers, NULL, &t->texel, error);
    for (int i = 0; code == WEFT_OK && i < layout->level_count * layers; i++) {
        weft_mip_area a = layout->area[i / layers];
        pack_layer(&material->level[i / layers], lobes, i % layers, word);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, a.x, a.y, i % layers, a.width, a.height, 1, packed_format.layout,
                        packed_format.type, word);
    }
    free(word);
    return code == WEFT_OK ? weft_gl_check("uploading texels", error) : code;
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
    int columns = count > 0 ? (count + most - 1) / most : 1,
        components = count > 0 ? (count + columns - 1) / columns : 1;
    *table = (weft_table_texture){.count = count, .columns = columns};
    WEFT_TRY(
        weft_gl_texture(table_format, layout->width * columns, layout->height, components, NULL, &table->name, error));
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

/* ---- Heights ---- */

/* The nearest of the table. */
static int entry_of_view(const weft_material *material, weft_vec3 view)
{
    int nearest = 0;
    for (int i = 1; i < material->view_count; i++) {
        if (weft_dot(material->view[i], view) > weft_dot(material->view[nearest], view))
            nearest = i;
    }
    return nearest;
}

static weft_code find_entries(const weft_material *material, const weft_material_relief *relief, int **entry,
                              weft_error *error)
{
    int views = relief->relief.view_count;
    if (views == 0)
        return WEFT_OK;
    *entry = malloc((size_t)views * sizeof **entry);
    for (int i = 0; *entry && i < views; i++)
        (*entry)[i] = entry_of_view(material, relief->view[i]);
    return *entry ? WEFT_OK : weft_fail_memory(error, "views", (size_t)views * sizeof **entry);
}

static weft_code upload_relief(const weft_material_relief *relief, weft_material_texture *t, weft_error *error)
{
    weft_relief_map map;
    if (relief->relief.view_count == 0)
        return WEFT_OK;
    WEFT_TRY(weft_relief_map_make(&relief->relief.field, relief->view, relief->relief.view_count, relief->level_count,
                                  &map, error));
    weft_code code = weft_relief_texture_upload(&map, &t->relief, error);
    weft_relief_map_free(&map);
    return code;
}

/* ---- What a pruned material holds ---- */

static weft_code upload_visibility(const weft_material_visibility *visibility, weft_visibility_texture *t,
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

void weft_visibility_texture_bind(const weft_visibility_texture *t, GLuint program, int unit)
{
    weft_gl_bind(program, "seen_maps", unit, GL_TEXTURE_2D_ARRAY, t->maps);
    weft_gl_set_float(program, "seen_finest", t->finer_levels > 0 ? 0 : -1000);
    weft_gl_set_float(program, "seen_coarsest", t->coarser_levels > 0 ? t->level_count - 1 : 1000);
    weft_gl_set_float(program, "seen_last_level", t->level_count - 1);
}

/* ---- The whole ---- */

static weft_code upload_directions(const weft_material *material, const weft_material_relief *relief,
                                   weft_material_texture *t, weft_error *error)
{
    weft_direction_map map = {0};
    weft_code code = add_directions(&map, material->view, material->view_count, error);
    if (code == WEFT_OK)
        code = add_directions(&map, material->light, material->light_count, error);
    if (code == WEFT_OK && relief->relief.view_count > 0)
        code = add_directions(&map, relief->view, relief->relief.view_count, error);
    if (code == WEFT_OK)
        code = weft_direction_texture_upload(&map, &t->directions, error);
    weft_direction_map_free(&map);
    return code;
}

weft_code weft_material_texture_upload(const weft_material *material, weft_material_texture *t, weft_error *error)
{
    *t = (weft_material_texture){
        .layout = weft_mip_layout_of(material->level[0].width, material->level[0].height, material->level_count, 0, 1),
        .lobe_count = material->lobe_count,
        .opaque = !weft_material_has_holes(material),
    };
    if (material->has_lobes)
        WEFT_TRY(upload_texels(material, t, error));
    WEFT_TRY(upload_table(material, &t->layout, false, &t->table, error));
    WEFT_TRY(upload_table(material, &t->layout, true, &t->light_table, error));
    WEFT_TRY(upload_visibility(material->visibility, &t->visibility, error));
    weft_material_relief relief;
    int *entry = NULL;
    WEFT_TRY(weft_material_relief_create(material, &relief, error));
    weft_code code = find_entries(material, &relief, &entry, error);
    if (code == WEFT_OK && material->components)
        code = weft_component_texture_upload(material->components, entry, &t->components, error);
    if (code == WEFT_OK)
        code = upload_relief(&relief, t, error);
    if (code == WEFT_OK)
        code = upload_directions(material, &relief, t, error);
    weft_material_relief_free(&relief);
    free(entry);
    return code;
}

void weft_material_texture_free(weft_material_texture *t)
{
    glDeleteTextures(1, &t->texel);
    glDeleteTextures(1, &t->table.name);
    glDeleteTextures(1, &t->light_table.name);
    weft_direction_texture_free(&t->directions);
    weft_component_texture_free(&t->components);
    weft_relief_texture_free(&t->relief);
    glDeleteTextures(1, &t->visibility.maps);
    *t = (weft_material_texture){0};
}

size_t weft_material_texture_bytes(const weft_material_texture *t)
{
    size_t texels = (size_t)t->layout.width * (size_t)t->layout.height;
    size_t layers = t->texel ? 1 + (3 * (size_t)t->lobe_count + 1) / 2 : 0;
    size_t shared, of_components = weft_component_texture_bytes(&t->components, &shared);
    return of_components + t->relief.bytes +
           texels * (16 * layers + 4 * (size_t)(t->table.count + t->light_table.count));
}

void weft_material_texture_bind(const weft_material_texture *t, GLuint program, bool factorised)
{
    if (factorised) {
        /* Unit 2 is that of a light table, which lobes alone have. */
        weft_component_texture_bind(&t->components, program, 5, 2);
        weft_relief_texture_bind(&t->relief, program, 9);
    } else {
        weft_gl_bind(program, "material_texel", 0, GL_TEXTURE_2D_ARRAY, t->texel);
    }
    weft_gl_bind(program, "material_table", 1, GL_TEXTURE_2D_ARRAY, t->table.name);
    weft_gl_bind(program, "material_light_table", 2, GL_TEXTURE_2D_ARRAY, t->light_table.name);
    weft_direction_texture_bind(&t->directions, program, 3);
    weft_gl_set_int(program, "level_count", t->layout.level_count);
    weft_gl_set_vec2(program, "texel_step", 1.0 / t->layout.width, 1.0 / t->layout.height);
    weft_gl_set_float(program, "table_columns", t->table.columns);
    weft_gl_set_float(program, "light_table_columns", t->light_table.columns);
    float area[WEFT_MIP_LEVELS][4];
    weft_mip_layout_areas(&t->layout, area);
    glUniform4fv(weft_gl_uniform(program, "level_area"), t->layout.level_count, area[0]);
}

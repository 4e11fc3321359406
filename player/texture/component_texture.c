#include "player/texture/material_texture.h"

#include "reflectance/components/components.h"

#include <stdlib.h>
#include <string.h>

enum { COLOURS = 3 };

static const weft_texture_format coefficient_format = {GL_RGBA8_SNORM, GL_RGBA, GL_BYTE};
static const weft_texture_format bounds_format = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};

static void filter_linearly(GLenum target)
{
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

/* ---- Coefficients ---- */

/* A group of a level with its first column and row again behind the last. */
static void wrap(const weft_components_level *level, size_t group, int8_t *wrapped)
{
    size_t width = (size_t)level->width, height = (size_t)level->height;
    const int8_t *plane = level->coefficient + WEFT_COMPONENTS_GROUP * width * height * group;
    for (size_t y = 0; y <= height; y++)
        for (size_t x = 0; x <= width; x++)
            memcpy(wrapped + WEFT_COMPONENTS_GROUP * (y * (width + 1) + x),
                   plane + WEFT_COMPONENTS_GROUP * (y % height * width + x % width), WEFT_COMPONENTS_GROUP);
}

static weft_code upload_coefficients(const weft_components *components, weft_component_texture *t, weft_error *error)
{
    const weft_components_level *finest = &components->level[0];
    size_t bytes = WEFT_COMPONENTS_GROUP * (size_t)(finest->width + 1) * (size_t)(finest->height + 1);
    int8_t *wrapped = malloc(bytes);
    if (!wrapped)
        return weft_fail_memory(error, "coefficients of components", bytes);
    weft_code code = weft_gl_texture(coefficient_format, t->layout.width, t->layout.height, t->group_count, NULL,
                                     &t->coefficient, error);
    if (code == WEFT_OK)
        filter_linearly(GL_TEXTURE_2D_ARRAY);
    for (int i = 0; code == WEFT_OK && i < components->level_count * t->group_count; i++) {
        int k = i / t->group_count, group = i % t->group_count;
        weft_mip_area a = t->layout.area[k];
        wrap(&components->level[k], (size_t)group, wrapped);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, a.x, a.y, group, a.width + 1, a.height + 1, 1,
                        coefficient_format.layout, coefficient_format.type, wrapped);
    }
    free(wrapped);
    return code == WEFT_OK ? weft_gl_check("uploading coefficients", error) : code;
}

/* Three floors and the ceiling of each square of a level. */
static void join_bounds(const weft_components_level *level, size_t squares, uint8_t (*texel)[4])
{
    for (size_t i = 0; i < squares; i++) {
        memcpy(texel[i], level->floor + 3 * i, 3);
        texel[i][3] = level->ceiling[i];
    }
}

static weft_code upload_bounds(const weft_components *components, weft_component_texture *t, weft_error *error)
{
    size_t most = weft_ceiling_count(components->level[0].width, components->level[0].height);
    uint8_t(*texel)[4] = calloc(most, sizeof *texel);
    if (!texel)
        return weft_fail_memory(error, "bounds of components", most * sizeof *texel);
    weft_code code =
        weft_gl_texture(bounds_format, t->bounds_layout.width, t->bounds_layout.height, 0, NULL, &t->bounds, error);
    for (int k = 0; k < components->level_count && code == WEFT_OK; k++) {
        weft_mip_area a = t->bounds_layout.area[k];
        join_bounds(&components->level[k], (size_t)a.width * (size_t)a.height, texel);
        glTexSubImage2D(GL_TEXTURE_2D, 0, a.x, a.y, a.width, a.height, bounds_format.layout, bounds_format.type, texel);
    }
    free(texel);
    return code == WEFT_OK ? weft_gl_check("uploading bounds", error) : code;
}

/* ---- Maps ---- */

/* Nodes [views][light node][layer][3] become the texture of factorised.glsl, for coefficients of 1 that stand for the
 * largest code. */
static void arrange(const weft_components *components, const float *node, size_t views, weft_half *texel)
{
    size_t side = (size_t)components->light_side;
    size_t count = (size_t)components->component_count, groups = count / WEFT_COMPONENTS_GROUP;
    for (size_t view = 0; view < views; view++)
        for (size_t at = 0; at < side * side; at++)
            for (size_t i = 0; i < COLOURS * count; i++) {
                size_t layer = i / COLOURS, colour = i % COLOURS, group = layer / WEFT_COMPONENTS_GROUP;
                size_t x = colour * side + at % side, y = group * side + at / side;
                size_t to = (view * groups * side + y) * COLOURS * side + x;
                float value = node[(view * side * side + at) * COLOURS * count + i] * WEFT_COMPONENTS_LARGEST_CODE;
                texel[WEFT_COMPONENTS_GROUP * to + layer % WEFT_COMPONENTS_GROUP] = weft_half_of_float(value);
            }
}

static weft_code upload_solid(const weft_component_texture *t, int depth, const weft_half *texel, GLuint *texture,
                              weft_error *error)
{
    GLint largest = 0;
    int width = COLOURS * t->light_side, height = t->group_count * t->light_side;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
    if (width > largest || height > largest || depth > largest)
        return weft_fail(
            error, WEFT_SYSTEM,
            "this graphics driver holds solid textures up to %d texels a side; the components need %d x %d x %d",
            largest, width, height, depth);
    glGenTextures(1, texture);
    glBindTexture(GL_TEXTURE_3D, *texture);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA16F, width, height, depth, 0, GL_RGBA, GL_HALF_FLOAT, texel);
    filter_linearly(GL_TEXTURE_3D);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAX_LEVEL, 0);
    return weft_gl_check("uploading the maps of components", error);
}

/* Between which nothing is interpolated. */
static weft_code upload_slices(const weft_component_texture *t, int count, const weft_half *texel, GLuint *texture,
                               weft_error *error)
{
    const weft_texture_format half = {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
    WEFT_TRY(
        weft_gl_texture(half, COLOURS * t->light_side, t->group_count * t->light_side, count, texel, texture, error));
    filter_linearly(GL_TEXTURE_2D_ARRAY);
    return WEFT_OK;
}

typedef weft_code upload_texels(const weft_component_texture *t, int count, const weft_half *texel, GLuint *texture,
                                weft_error *error);

/* Of `views` nodes or stored views. */
static weft_code upload_map(const weft_component_texture *t, const weft_components *components, const float *node,
                            int views, upload_texels *upload, GLuint *texture, weft_error *error)
{
    size_t lights = (size_t)components->light_side * (size_t)components->light_side;
    size_t bytes = lights * (size_t)views * COLOURS * (size_t)components->component_count * sizeof(weft_half);
    weft_half *texel = malloc(bytes);
    if (!texel)
        return weft_fail_memory(error, "maps of components", bytes);
    arrange(components, node, (size_t)views, texel);
    weft_code code = upload(t, views, texel, texture, error);
    free(texel);
    return code;
}

/* Directions, and the entry of each in the table of views. */
static weft_code upload_views(const weft_components *components, const int *entry_of_view, weft_component_texture *t,
                              weft_error *error)
{
    const weft_texture_format four = {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    size_t views = (size_t)components->view_count;
    float(*texel)[4] = malloc(views * sizeof *texel);
    if (!texel)
        return weft_fail_memory(error, "views of components", views * sizeof *texel);
    for (size_t i = 0; i < views; i++) {
        memcpy(texel[i], components->view + 3 * i, 3 * sizeof(float));
        texel[i][3] = (float)entry_of_view[i];
    }
    weft_code code = weft_gl_texture(four, components->view_count, 1, 0, texel, &t->view, error);
    free(texel);
    return code;
}

static weft_code upload_maps_of_views(const weft_components *components, const int *entry_of_view,
                                      weft_component_maps *maps, weft_component_texture *t, weft_error *error)
{
    t->view_count = components->view_count;
    WEFT_TRY(weft_component_maps_keep_views(maps, error));
    WEFT_TRY(
        upload_map(t, components, maps->node_of_view, components->view_count, upload_slices, &t->map_of_view, error));
    return upload_views(components, entry_of_view, t, error);
}

static weft_code upload_maps(const weft_components *components, const int *entry_of_view, weft_component_texture *t,
                             weft_error *error)
{
    weft_component_maps maps;
    WEFT_TRY(weft_component_maps_create(components, &maps, error));
    weft_code code = upload_map(t, components, maps.node, components->view_side * components->view_side, upload_solid,
                                &t->map, error);
    if (code == WEFT_OK && entry_of_view)
        code = upload_maps_of_views(components, entry_of_view, &maps, t, error);
    weft_component_maps_free(&maps);
    return code;
}

/* ---- The whole ---- */

weft_code weft_component_texture_upload(const weft_components *components, const int *entry_of_view,
                                        weft_component_texture *t, weft_error *error)
{
    const weft_components_level *finest = &components->level[0];
    int columns = (finest->width + WEFT_CEILING_SIDE - 1) / WEFT_CEILING_SIDE;
    int rows = (finest->height + WEFT_CEILING_SIDE - 1) / WEFT_CEILING_SIDE;
    *t = (weft_component_texture){.layout =
                                      weft_mip_layout_of(finest->width, finest->height, components->level_count, 1, 1),
                                  .bounds_layout = weft_mip_layout_of(columns, rows, components->level_count, 0, 1),
                                  .group_count = components->component_count / WEFT_COMPONENTS_GROUP,
                                  .light_side = components->light_side,
                                  .view_side = components->view_side,
                                  .over_half_vector = weft_components_are_over_half_vector(components->kind),
                                  .kriged = weft_components_are_kriged(components->kind),
                                  .exponent = components->exponent,
                                  .incidence_power = components->incidence_power,
                                  .cosine_power = components->cosine_power,
                                  .least_incidence = components->least_incidence,
                                  .least_cosine = components->least_cosine};
    WEFT_TRY(upload_coefficients(components, t, error));
    WEFT_TRY(upload_bounds(components, t, error));
    return upload_maps(components, entry_of_view, t, error);
}

void weft_component_texture_free(weft_component_texture *t)
{
    glDeleteTextures(1, &t->coefficient);
    glDeleteTextures(1, &t->bounds);
    glDeleteTextures(3, (const GLuint[]){t->map, t->map_of_view, t->view});
    *t = (weft_component_texture){0};
}

size_t weft_component_texture_bytes(const weft_component_texture *t, size_t *shared)
{
    size_t texels = (size_t)t->layout.width * (size_t)t->layout.height, groups = (size_t)t->group_count;
    size_t lights = (size_t)t->light_side * (size_t)t->light_side;
    size_t nodes = lights * ((size_t)t->view_side * (size_t)t->view_side + (size_t)t->view_count);
    *shared = nodes * groups * COLOURS * WEFT_COMPONENTS_GROUP * sizeof(weft_half);
    return *shared + texels * groups * WEFT_COMPONENTS_GROUP +
           sizeof(uint8_t[4]) * (size_t)t->bounds_layout.width * (size_t)t->bounds_layout.height;
}

static void set_areas(const weft_mip_layout *layout, GLuint program, const char *areas, const char *step)
{
    float area[WEFT_MIP_LEVELS][4];
    weft_mip_layout_areas(layout, area);
    glUniform4fv(weft_gl_uniform(program, areas), layout->level_count, area[0]);
    weft_gl_set_vec2(program, step, 1.0 / layout->width, 1.0 / layout->height);
}

void weft_component_texture_bind(const weft_component_texture *t, GLuint program, int unit, int view_unit)
{
    weft_gl_bind(program, "component_coefficient", unit, GL_TEXTURE_2D_ARRAY, t->coefficient);
    weft_gl_bind(program, "component_bounds", unit + 1, GL_TEXTURE_2D, t->bounds);
    weft_gl_bind(program, "component_map", unit + 2, GL_TEXTURE_3D, t->map);
    if (t->view_count > 0) {
        weft_gl_bind(program, "layer_map_of_view", unit + 3, GL_TEXTURE_2D_ARRAY, t->map_of_view);
        weft_gl_bind(program, "layer_view", view_unit, GL_TEXTURE_2D, t->view);
    }
    set_areas(&t->layout, program, "component_area", "component_step");
    set_areas(&t->bounds_layout, program, "bounds_area", "bounds_step");
    weft_gl_set_vec2(program, "component_sides", t->light_side, t->view_side);
    weft_gl_set_float(program, "least_cosine", (double)t->least_cosine);
    weft_gl_set_vec4(program, "component_powers", (double)t->incidence_power, (double)t->cosine_power,
                     (double)t->exponent, (double)t->least_incidence);
}

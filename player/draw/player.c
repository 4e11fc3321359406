#include "player/draw/player.h"

#include "player/draw/player_parts.h"
#include "player/gl/shaders.h"

#include <stddef.h>
#include <stdlib.h>

/* ---- Programs ---- */

static weft_code build_programs(weft_player *p, weft_error *error)
{
    const char *const screen[] = {weft_glsl_fullscreen_vert, NULL};
    const char *const environment[] = {weft_glsl_environment_frag, NULL};
    const char *const background[] = {weft_glsl_background_frag, NULL}, *const copy[] = {weft_glsl_add_frag, NULL};
    WEFT_TRY(weft_gl_program("background", screen, background, &p->background, error));
    WEFT_TRY(weft_gl_program("environment", screen, environment, &p->environment_background, error));
    const char *const ground[] = {weft_glsl_ground_frag, NULL};
    WEFT_TRY(weft_gl_program("ground", screen, ground, &p->ground, error));
    WEFT_TRY(weft_gl_program("copy", screen, copy, &p->copy, error));
    return weft_shadow_map_create(&p->shadow, error);
}

weft_code weft_player_create(weft_player **result, weft_error *error)
{
    *result = NULL;
    weft_player *p = calloc(1, sizeof *p);
    if (!p)
        return weft_fail_memory(error, "player", sizeof *p);
    glGenVertexArrays(1, &p->empty_array);
    weft_code code = build_programs(p, error);
    if (code == WEFT_OK)
        code = weft_labels_create(&p->labels, error);
    if (code == WEFT_OK)
        *result = p;
    else
        weft_player_free(p);
    return code;
}

static void free_mesh(weft_player *p)
{
    glDeleteVertexArrays(1, &p->vertex_array);
    glDeleteBuffers(1, &p->vertex_buffer);
    glDeleteBuffers(1, &p->index_buffer);
    p->vertex_array = p->vertex_buffer = p->index_buffer = 0;
    p->triangle_count = p->coarse_count = 0;
}

void weft_ground_shadow_free(weft_ground_shadow *s)
{
    glDeleteFramebuffers(1, &s->buffer);
    glDeleteRenderbuffers(1, &s->depth);
    glDeleteTextures(1, &s->hidden);
    *s = (weft_ground_shadow){0};
}

void weft_player_free(weft_player *p)
{
    if (!p)
        return;
    glUseProgram(0); /* a program in use would outlive its deletion */
    free_mesh(p);
    weft_raw_texture_free(&p->raw);
    weft_material_texture_free(&p->material);
    weft_table_directions_free(&p->directions);
    weft_weave_texture_free(&p->weave);
    weft_thread_texture_free(&p->threads);
    weft_programs_free(&p->programs);
    weft_shadow_map_free(&p->shadow);
    for (int i = 0; i < WEFT_GROUND_LIGHTS; i++)
        weft_ground_shadow_free(&p->ground_shadow[i]);
    for (int i = 0; i < WEFT_LAYER_COUNT; i++)
        weft_layer_free(&p->layer[i]);
    glDeleteProgram(p->background);
    glDeleteProgram(p->environment_background);
    glDeleteProgram(p->ground);
    glDeleteProgram(p->copy);
    glDeleteTextures(1, &p->kept);
    glDeleteTextures(1, &p->environment_map);
    free(p->environment);
    glDeleteVertexArrays(1, &p->empty_array);
    weft_labels_free(&p->labels);
    free(p);
}

/* ---- What is shown ---- */

void weft_player_forget_shadows(weft_player *p)
{
    weft_shadow_map_forget(&p->shadow);
    for (int i = 0; i < WEFT_GROUND_LIGHTS; i++)
        p->ground_shadow[i].count = 0;
}

static void describe_attribute(GLuint location, GLint size, size_t offset)
{
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, size, GL_FLOAT, GL_FALSE, sizeof(weft_vertex), (void *)offset);
}

weft_code weft_player_set_mesh(weft_player *p, const weft_mesh *mesh, weft_error *error)
{
    float centre[3], radius;
    weft_mesh_bounds(mesh, centre, &radius);
    if (!(radius > 0) || !isfinite(radius))
        return weft_fail(error, WEFT_BAD_INPUT, "the mesh is %g units large and cannot be looked at", (double)radius);
    free_mesh(p);
    weft_player_forget_shadows(p);
    p->centre = weft_vec3_of((weft_real)centre[0], (weft_real)centre[1], (weft_real)centre[2]);
    p->radius = (double)radius;
    p->lowest_z = p->highest_z = (double)mesh->vertex[0].position[2];
    for (int i = 1; i < mesh->vertex_count; i++) {
        p->lowest_z = fmin(p->lowest_z, (double)mesh->vertex[i].position[2]);
        p->highest_z = fmax(p->highest_z, (double)mesh->vertex[i].position[2]);
    }
    p->triangle_count = mesh->triangle_count;
    p->coarse_count = mesh->coarse_count;
    glGenVertexArrays(1, &p->vertex_array);
    glGenBuffers(1, &p->vertex_buffer);
    glGenBuffers(1, &p->index_buffer);
    glBindVertexArray(p->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, p->vertex_buffer);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, p->index_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)mesh->vertex_count * (GLsizeiptr)sizeof *mesh->vertex, mesh->vertex,
                 GL_STATIC_DRAW);
    GLsizeiptr triangles = (GLsizeiptr)mesh->triangle_count + mesh->coarse_count;
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, triangles * (GLsizeiptr)sizeof *mesh->index, mesh->index, GL_STATIC_DRAW);
    describe_attribute(WEFT_ATTRIBUTE_POSITION, 3, offsetof(weft_vertex, position));
    describe_attribute(WEFT_ATTRIBUTE_NORMAL, 3, offsetof(weft_vertex, normal));
    describe_attribute(WEFT_ATTRIBUTE_TANGENT, 4, offsetof(weft_vertex, tangent));
    describe_attribute(WEFT_ATTRIBUTE_COORDINATE, 2, offsetof(weft_vertex, coordinate));
    glBindVertexArray(0);
    return weft_gl_check("uploading the mesh", error);
}

static void has_now(weft_player *p, weft_mode mode, double width, double height)
{
    p->has[mode] = true;
    weft_player_forget_shadows(p);
    p->texel_count[mode][0] = width;
    p->texel_count[mode][1] = height;
}

double weft_player_last_ring_z(const weft_vec3 *direction, int count)
{
    double smallest = 1;
    for (int i = 0; i < count; i++)
        smallest = fmin(smallest, (double)direction[i].z);
    return smallest;
}

weft_code weft_player_set_material(weft_player *p, const weft_material *material, weft_error *error)
{
    weft_material_texture texture;
    weft_table_directions directions = {0};
    weft_code code = weft_material_texture_upload(material, &texture, error);
    if (code == WEFT_OK)
        code = weft_table_directions_create(material, &directions, error);
    if (code != WEFT_OK) {
        weft_material_texture_free(&texture);
        return code;
    }
    weft_material_texture_free(&p->material);
    weft_table_directions_free(&p->directions);
    p->material = texture;
    p->directions = directions;
    double *last = p->last_ring_z[WEFT_MODE_COMPRESSED];
    last[0] = material->view_count > 0 ? weft_player_last_ring_z(material->view, material->view_count) : 0;
    last[1] = material->light_count > 0 ? weft_player_last_ring_z(material->light, material->light_count) : last[0];
    has_now(p, WEFT_MODE_COMPRESSED, material->level[0].width, material->level[0].height);
    return WEFT_OK;
}

void weft_player_take_raw(weft_player *p, weft_raw_texture *texture, const double last_ring_z[2])
{
    weft_raw_texture_free(&p->raw);
    p->raw = *texture;
    *texture = (weft_raw_texture){0};
    p->last_ring_z[WEFT_MODE_RAW][0] = last_ring_z[0];
    p->last_ring_z[WEFT_MODE_RAW][1] = last_ring_z[1];
    weft_mip_area finest = p->raw.plan.layout.area[0];
    has_now(p, WEFT_MODE_RAW, finest.width, finest.height);
}

weft_code weft_player_set_dataset(weft_player *p, weft_dataset *dataset, const weft_progress *progress,
                                  int *skipped_levels, weft_error *error)
{
    weft_raw_texture texture;
    weft_raw_limits limits = weft_raw_texture_limits(WEFT_RAW_FITTING);
    /* Other models are held against these samples: blocks, which are 5 % off, would be measured as their error. */
    limits.has_bc6h = false;
    weft_code code = weft_raw_texture_upload(dataset, &limits, progress, &texture, error);
    if (code != WEFT_OK) {
        weft_raw_texture_free(&texture);
        return code;
    }
    *skipped_levels = texture.plan.skipped_levels;
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    const double last_ring_z[2] = {weft_player_last_ring_z(layout->view, layout->view_count),
                                   weft_player_last_ring_z(layout->light, layout->image_count)};
    weft_player_take_raw(p, &texture, last_ring_z);
    return WEFT_OK;
}

weft_code weft_player_set_weave_texels(weft_player *p, const weft_weave_texels *texels, const weft_weave_layout *layout,
                                       weft_error *error)
{
    WEFT_TRY(weft_weave_texture_upload(texels, layout, &p->weave, error));
    weft_thread_texture_free(&p->threads);
    p->weave_revision++;
    has_now(p, WEFT_MODE_ANALYTIC, layout->tiles_u * texels->tile_width, layout->tiles_v * texels->tile_height);
    return WEFT_OK;
}

weft_code weft_player_set_weave(weft_player *p, const weft_weave *weave, const weft_weave_layout *layout,
                                weft_error *error)
{
    weft_weave_texels texels;
    weft_code code = weft_weave_texels_of(weave, &texels, error);
    if (code == WEFT_OK)
        code = weft_player_set_weave_texels(p, &texels, layout, error);
    weft_weave_texels_free(&texels);
    return code;
}

weft_code weft_player_set_threads(weft_player *p, const weft_microcylinder_cloth *cloth, weft_error *error)
{
    WEFT_TRY(weft_thread_texture_upload(cloth, &p->threads, error));
    weft_weave_texture_free(&p->weave);
    p->weave_revision++;
    has_now(p, WEFT_MODE_ANALYTIC, 1, 1);
    return WEFT_OK;
}

bool weft_player_has_threads(const weft_player *p)
{
    return p->threads.table != 0;
}

long weft_player_weave_revision(const weft_player *p)
{
    return p->weave_revision;
}

void weft_player_lay_weave(weft_player *p, const weft_weave_layout *layout)
{
    double *cells = p->texel_count[WEFT_MODE_ANALYTIC];
    const weft_weave_layout *before = &p->weave.layout;
    cells[0] *= layout->tiles_u / before->tiles_u;
    cells[1] *= layout->tiles_v / before->tiles_v;
    p->weave.layout = *layout;
}

weft_weave_layout weft_player_weave_layout(const weft_player *p)
{
    return p->weave.layout;
}

void weft_player_clear(weft_player *p, weft_mode mode)
{
    p->has[mode] = false;
    if (mode == WEFT_MODE_RAW)
        weft_raw_texture_free(&p->raw);
    if (mode == WEFT_MODE_COMPRESSED)
        weft_material_texture_free(&p->material);
    if (mode == WEFT_MODE_ANALYTIC) {
        weft_weave_texture_free(&p->weave);
        weft_thread_texture_free(&p->threads);
    }
}

bool weft_player_has_mesh(const weft_player *p)
{
    return p->triangle_count > 0;
}

bool weft_player_has(const weft_player *p, weft_mode mode)
{
    return p->has[mode];
}

/* ---- Environment ---- */

static weft_code upload_map(const weft_image *image, GLuint *texture, weft_error *error)
{
    WEFT_TRY(weft_gl_texture((weft_texture_format){GL_RGB16F, GL_RGB, GL_FLOAT}, image->width, image->height, 0,
                             image->pixels, texture, error));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return weft_gl_check("uploading an environment map", error);
}

weft_code weft_player_set_environment(weft_player *p, const weft_image *image, int region_count, weft_error *error)
{
    weft_environment *environment = NULL;
    GLuint map = 0;
    if (image) {
        environment = calloc(1, sizeof *environment);
        weft_code code = environment ? weft_environment_of_image(image, region_count, environment, error)
                                     : weft_fail_memory(error, "environment", sizeof *environment);
        if (code == WEFT_OK)
            code = upload_map(image, &map, error);
        if (code != WEFT_OK) {
            free(environment);
            return code;
        }
    }
    free(p->environment);
    glDeleteTextures(1, &p->environment_map);
    p->environment = environment;
    weft_player_forget_shadows(p);
    p->environment_map = map;
    return WEFT_OK;
}

bool weft_player_has_environment(const weft_player *p)
{
    return p->environment != NULL;
}

/* ---- What there is ---- */

int weft_player_layer_count(const weft_player *p)
{
    return WEFT_COMPONENTS_GROUP * p->material.components.group_count;
}

int weft_player_drawn_components(const weft_player *p, const weft_scene *scene)
{
    int all = weft_player_layer_count(p), wanted = scene->components;
    if (wanted <= 0)
        return p->material.texel ? 0 : all;
    wanted = (wanted + WEFT_COMPONENTS_GROUP - 1) / WEFT_COMPONENTS_GROUP * WEFT_COMPONENTS_GROUP;
    return wanted < all ? wanted : all;
}

void weft_player_material_parts(const weft_player *p, int *lobe_count, bool *view_table, bool *light_table)
{
    *lobe_count = p->material.texel ? p->material.lobe_count : -1;
    *view_table = p->material.table.count > 0;
    *light_table = p->material.light_table.count > 0;
}

void weft_player_last_ring(const weft_player *p, weft_mode mode, double *view_rad, double *light_rad)
{
    *view_rad = acos(p->last_ring_z[mode][0]);
    *light_rad = acos(p->last_ring_z[mode][1]);
}

size_t weft_player_bytes(const weft_player *p, weft_mode mode)
{
    if (!p->has[mode])
        return 0;
    switch (mode) {
    case WEFT_MODE_RAW:
        return weft_raw_texture_bytes(&p->raw);
    case WEFT_MODE_COMPRESSED:
        return weft_material_texture_bytes(&p->material);
    default:
        return weft_weave_texture_bytes(&p->weave) + weft_thread_texture_bytes(&p->threads);
    }
}

bool weft_player_relief_mm(const weft_player *p, double *range_mm)
{
    const weft_relief_texture *relief = p->has[WEFT_MODE_RAW] && p->raw.relief.height ? &p->raw.relief
                                        : p->has[WEFT_MODE_COMPRESSED] && p->material.relief.height
                                            ? &p->material.relief
                                            : NULL;
    for (int i = 0; relief && range_mm && i < 2; i++)
        range_mm[i] = relief->range_mm[i];
    return relief != NULL;
}

const char *weft_player_raw_format(const weft_player *p)
{
    return p->has[WEFT_MODE_RAW] ? weft_raw_format_name(p->raw.plan.tiles[WEFT_RAW_SAMPLES].format) : "";
}

#include "player/player.h"

#include "player/player_parts.h"
#include "player/shaders.h"

#include <stddef.h>
#include <stdlib.h>

/* ---- Programs ---- */

static weft_code build_programs(weft_player *p, weft_error *error)
{
    const char *const surface[] = {weft_glsl_surface_vert, NULL}, *const screen[] = {weft_glsl_fullscreen_vert, NULL};
    const char *const raw[] = {weft_glsl_surface, weft_glsl_directions, weft_glsl_raw, weft_glsl_shade_frag, NULL};
    const char *const compressed[] = {weft_glsl_surface,    weft_glsl_directions, weft_glsl_lafortune,
                                      weft_glsl_compressed, weft_glsl_shade_frag, NULL};
    const char *const analytic[] = {weft_glsl_surface,
                                    weft_glsl_directions,
                                    weft_glsl_woven,
                                    weft_glsl_weave,
                                    weft_glsl_analytic,
                                    weft_glsl_shade_frag,
                                    NULL};
    const char *const background[] = {weft_glsl_background_frag, NULL};
    const char *const geometry[] = {weft_glsl_surface, weft_glsl_geometry_frag, NULL};
    WEFT_TRY(weft_gl_program("raw", surface, raw, &p->shade[WEFT_MODE_RAW], error));
    WEFT_TRY(weft_gl_program("compressed", surface, compressed, &p->shade[WEFT_MODE_COMPRESSED], error));
    WEFT_TRY(weft_gl_program("analytic", surface, analytic, &p->shade[WEFT_MODE_ANALYTIC], error));
    WEFT_TRY(weft_gl_program("background", screen, background, &p->background, error));
    return weft_gl_program("geometry", surface, geometry, &p->geometry, error);
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
        code = weft_overlay_create(&p->overlay, error);
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
    p->index_count = 0;
}

void weft_player_free(weft_player *p)
{
    if (!p)
        return;
    glUseProgram(0); /* a program in use would outlive its deletion */
    free_mesh(p);
    weft_raw_texture_free(&p->raw);
    weft_material_texture_free(&p->material);
    weft_weave_texture_free(&p->weave);
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++)
        glDeleteProgram(p->shade[mode]);
    glDeleteProgram(p->background);
    glDeleteProgram(p->geometry);
    glDeleteVertexArrays(1, &p->empty_array);
    weft_overlay_free(&p->overlay);
    free(p);
}

/* ---- What is shown ---- */

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
    p->centre = weft_vec3_of((weft_real)centre[0], (weft_real)centre[1], (weft_real)centre[2]);
    p->radius = (double)radius;
    p->index_count = 3 * mesh->triangle_count;
    glGenVertexArrays(1, &p->vertex_array);
    glGenBuffers(1, &p->vertex_buffer);
    glGenBuffers(1, &p->index_buffer);
    glBindVertexArray(p->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, p->vertex_buffer);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, p->index_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)mesh->vertex_count * (GLsizeiptr)sizeof *mesh->vertex, mesh->vertex,
                 GL_STATIC_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)mesh->triangle_count * (GLsizeiptr)sizeof *mesh->index,
                 mesh->index, GL_STATIC_DRAW);
    describe_attribute(WEFT_ATTRIBUTE_POSITION, 3, offsetof(weft_vertex, position));
    describe_attribute(WEFT_ATTRIBUTE_NORMAL, 3, offsetof(weft_vertex, normal));
    describe_attribute(WEFT_ATTRIBUTE_TANGENT, 4, offsetof(weft_vertex, tangent));
    describe_attribute(WEFT_ATTRIBUTE_COORDINATE, 2, offsetof(weft_vertex, coordinate));
    glBindVertexArray(0);
    return weft_gl_check("uploading the mesh", error);
}

static weft_code has_now(weft_player *p, weft_mode mode, double width, double height, weft_code code)
{
    p->has[mode] = code == WEFT_OK;
    p->texel_count[mode][0] = width;
    p->texel_count[mode][1] = height;
    return code;
}

weft_code weft_player_set_material(weft_player *p, const weft_material *material, weft_error *error)
{
    weft_material_texture_free(&p->material);
    weft_code code = weft_material_texture_upload(material, &p->material, error);
    return has_now(p, WEFT_MODE_COMPRESSED, material->level[0].width, material->level[0].height, code);
}

weft_code weft_player_set_dataset(weft_player *p, weft_dataset *dataset, const weft_progress *progress,
                                  int *skipped_levels, weft_error *error)
{
    weft_raw_texture_free(&p->raw);
    weft_code code = weft_raw_texture_upload(dataset, WEFT_RAW_HALF_LIMIT, WEFT_RAW_LIMIT, progress, &p->raw, error);
    *skipped_levels = p->raw.skipped_levels;
    weft_mip_area finest = p->raw.layout.area[0];
    return has_now(p, WEFT_MODE_RAW, finest.width, finest.height, code);
}

weft_code weft_player_set_weave(weft_player *p, const weft_weave *weave, double tiles_u, double tiles_v,
                                weft_error *error)
{
    weft_weave_texture_free(&p->weave);
    weft_code code = weft_weave_texture_upload(weave, tiles_u, tiles_v, &p->weave, error);
    return has_now(p, WEFT_MODE_ANALYTIC, tiles_u * weave->tile_width, tiles_v * weave->tile_height, code);
}

bool weft_player_has(const weft_player *p, weft_mode mode)
{
    return p->has[mode];
}

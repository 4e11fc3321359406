/* The ground below the mesh: the light that falls on it, and what the mesh hides of that. */
#include "player/draw/lighting.h"
#include "player/draw/player_parts.h"

#include <math.h>
#include <string.h>

/* Of the sum, texels. */
enum { MAX_SIDE = 1024 };

/* Directions that a frame adds to a sum that is not whole. */
enum { INTERACTIVE_DIRECTIONS = 4, CONVERGING_DIRECTIONS = 8 };

static const double backdrop[3] = {0.34, 0.335, 0.33};

/* ---- The sum ---- */

static weft_code create(weft_ground_shadow *s, int side, weft_error *error)
{
    const weft_texture_format format = {GL_R16F, GL_RED, GL_HALF_FLOAT}; /* exact for whole numbers to 2048 */
    weft_ground_shadow_free(s);
    s->side = side;
    WEFT_TRY(weft_gl_texture(format, side, side, 0, NULL, &s->hidden, error));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glGenRenderbuffers(1, &s->depth);
    glBindRenderbuffer(GL_RENDERBUFFER, s->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, side, side);
    glGenFramebuffers(1, &s->buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, s->buffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, s->hidden, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, s->depth);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return weft_fail(error, WEFT_SYSTEM, "this graphics driver does not draw into textures of half floats");
    return weft_gl_check("making the shadow on the ground", error);
}

static int directions_at(double detail)
{
    return (int)ceil(WEFT_GROUND_DIRECTIONS * detail);
}

/* Begins a sum without any direction over the square of 2 x half_side about `middle`. detail: share of all texels along
 * a side, and of all directions. */
static weft_code clear_sum(weft_ground_shadow *s, weft_vec3 middle, double half_side, double detail, weft_error *error)
{
    int side = (int)ceil(MAX_SIDE * detail);
    if (s->side != side)
        WEFT_TRY(create(s, side, error));
    s->count = 0;
    s->whole = directions_at(detail);
    s->middle = middle;
    s->half_side = half_side;
    glBindFramebuffer(GL_FRAMEBUFFER, s->buffer);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    return WEFT_OK;
}

/* Of the n-th of a sequence that fills the square of a texel evenly (Roberts' R2), -1/2 to 1/2: edges of the sum are
 * smooth. */
static double shift_of(int n, double step)
{
    return fmod(0.5 + n * step, 1) - 0.5;
}

/* Down to the ground along the light. Column-major. All heights are as near: none is cut off. */
static void look_down(const weft_ground_shadow *s, weft_vec3 light, float matrix[16])
{
    double scale = 1 / s->half_side, texel = 2.0 / s->side;
    double slope[2] = {(double)(light.x / light.z), (double)(light.y / light.z)};
    const double middle[2] = {(double)s->middle.x, (double)s->middle.y};
    const double shift[2] = {shift_of(s->count, 0.7548776662466927), shift_of(s->count, 0.5698402909980532)};
    memset(matrix, 0, 16 * sizeof *matrix);
    for (int i = 0; i < 2; i++) {
        matrix[4 * i + i] = (float)scale;
        matrix[8 + i] = (float)(-slope[i] * scale);
        matrix[12 + i] = (float)(scale * (slope[i] * (double)s->middle.z - middle[i]) + shift[i] * texel);
    }
    matrix[15] = 1;
}

/* Between the two, what is drawn by `program`, which is in use then, casts its shadow along one more direction: unit,
 * toward the light, above the horizon. Each direction lies before the ones before it, and all of it at one depth: the
 * first triangle of a place counts. */
static void begin_direction(weft_ground_shadow *s, weft_vec3 light, GLuint program)
{
    float clip_of_world[16], depth = 1 - (float)(s->count + 1) / (WEFT_GROUND_DIRECTIONS + 2);
    look_down(s, light, clip_of_world);
    glBindFramebuffer(GL_FRAMEBUFFER, s->buffer);
    glViewport(0, 0, s->side, s->side);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthRangef(depth, depth);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glUseProgram(program);
    glUniformMatrix4fv(weft_gl_uniform(program, "clip_of_world"), 1, GL_FALSE, clip_of_world);
}

static void end_direction(weft_ground_shadow *s)
{
    s->count++;
    glDepthRangef(0, 1);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
}

/* ---- Shadows ---- */

double weft_player_shadow_detail(int width, int height)
{
    const double whole = 128;
    return fmin(1, (width > height ? width : height) / whole);
}

/* Longest shadow that the sum holds, in radii of the mesh: beyond, little is seen of the ground. And what of the
 * environment stands lower than this brings little to it. */
static const double furthest = 6, low_environment_rad = 66 * WEFT_PI / 180;

static double reach_of(const weft_player *p, double theta_rad)
{
    double slope = tan(fmin(theta_rad, 1.5));
    return fmin(p->radius + (p->highest_z - p->lowest_z) * slope, furthest * p->radius) / 0.8;
}

static weft_vec3 ground_below(const weft_player *p)
{
    return weft_vec3_of(p->centre.x, p->centre.y, (weft_real)p->lowest_z);
}

static bool is_same_light(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Begins anew where the light is another one, or the picture asks for more detail. */
static weft_code follow(weft_player *p, weft_ground_shadow *shadow, const double light[3], double reach, double detail,
                        weft_error *error)
{
    if (shadow->count > 0 && is_same_light(shadow->light, light) && shadow->whole >= directions_at(detail))
        return WEFT_OK;
    WEFT_TRY(clear_sum(shadow, ground_below(p), reach, detail, error));
    memcpy(shadow->light, light, sizeof shadow->light);
    return WEFT_OK;
}

static weft_code follow_light(weft_player *p, const weft_scene *scene, int part, double detail, weft_error *error)
{
    const weft_angles key = scene->light[0].direction;
    const double light[WEFT_GROUND_LIGHTS][3] = {{key.theta_rad, key.phi_rad, scene->key_size_rad},
                                                 {scene->environment_turn_rad}};
    double lowest_rad = part == 0 ? key.theta_rad + scene->key_size_rad : low_environment_rad;
    return follow(p, &p->ground_shadow[part], light[part], reach_of(p, lowest_rad), detail, error);
}

static weft_vec3 direction_of(const weft_player *p, const weft_scene *scene, int part, int number)
{
    return part == 0 ? weft_lighting_key_place(scene, number)
                     : weft_lighting_ground_place(scene, p->environment, number);
}

static weft_code add_direction(weft_player *p, const weft_scene *scene, int part, weft_error *error)
{
    GLuint program;
    weft_ground_shadow *shadow = &p->ground_shadow[part];
    weft_vec3 light = direction_of(p, scene, part, shadow->count);
    bool is_above = (double)light.z > 1e-3;
    if (is_above) {
        WEFT_TRY(weft_player_find_caster(p, scene, true, &program, error));
        begin_direction(shadow, light, program);
        weft_player_set_caster(p, scene, light, weft_player_sequence(p, shadow->count), program);
        weft_player_draw_mesh(p, true);
    }
    end_direction(shadow);
    return WEFT_OK;
}

static bool has_part(const weft_player *p, const weft_scene *scene, int part)
{
    return part == 0 ? scene->light_count > 0 : scene->environment && p->environment;
}

/* A sum that is not whole goes on, in this frame by so many directions. */
static weft_code sum_shadows(weft_player *p, const weft_scene *scene, int directions, double detail, weft_error *error)
{
    if (!scene->ground || !weft_scene_has_shadows(scene))
        return WEFT_OK;
    weft_player_take_holes(p, scene);
    for (int part = 0; part < WEFT_GROUND_LIGHTS; part++) {
        if (!has_part(p, scene, part))
            continue;
        WEFT_TRY(follow_light(p, scene, part, detail, error));
        for (int i = 0; i < directions && p->ground_shadow[part].count < p->ground_shadow[part].whole; i++)
            WEFT_TRY(add_direction(p, scene, part, error));
    }
    return WEFT_OK;
}

weft_code weft_player_advance_ground(weft_player *p, const weft_scene *scene, const weft_pane *whole, weft_error *error)
{
    return sum_shadows(p, scene, whole->sampling.frame < 0 ? INTERACTIVE_DIRECTIONS : CONVERGING_DIRECTIONS,
                       weft_player_shadow_detail(whole->width, whole->height), error);
}

weft_code weft_player_finish_ground(weft_player *p, const weft_scene *scene, int width, int height, weft_error *error)
{
    return sum_shadows(p, scene, WEFT_GROUND_DIRECTIONS, weft_player_shadow_detail(width, height), error);
}

/* ---- Light ---- */

/* What falls on the ground, of the first light and of all others. */
static void set_light(const weft_player *p, GLuint program, const weft_scene *scene)
{
    weft_lighting l = weft_lighting_of(scene, p->environment, -1);
    float sum[WEFT_GROUND_LIGHTS][3] = {{0}};
    for (int i = 0; i < weft_lighting_stored(&l); i++) {
        for (int c = 0; c < 3; c++)
            sum[i > 0 || l.scene_count == 0][c] += l.irradiance[i][c] * fmaxf(l.direction[i][2], 0);
    }
    glUniform3fv(weft_gl_uniform(program, "ground_light"), WEFT_GROUND_LIGHTS, sum[0]);
}

static void set_shadows(const weft_player *p, GLuint program, const weft_scene *scene)
{
    static const char *const name[WEFT_GROUND_LIGHTS] = {"key_hidden", "environment_hidden"};
    GLfloat side[WEFT_GROUND_LIGHTS], share[WEFT_GROUND_LIGHTS];
    for (int i = 0; i < WEFT_GROUND_LIGHTS; i++) {
        const weft_ground_shadow *shadow = &p->ground_shadow[i];
        bool is_there = weft_scene_has_shadows(scene) && has_part(p, scene, i) && shadow->count > 0;
        side[i] = is_there ? (float)shadow->half_side : 1;
        share[i] = is_there ? 1 / (float)shadow->count : 0;
        weft_gl_bind(program, name[i], i, GL_TEXTURE_2D, shadow->hidden);
    }
    glUniform1fv(weft_gl_uniform(program, "hidden_side"), WEFT_GROUND_LIGHTS, side);
    glUniform1fv(weft_gl_uniform(program, "hidden_share"), WEFT_GROUND_LIGHTS, share);
}

void weft_player_use_ground(const weft_player *p, const weft_scene *scene, const weft_pane *pane)
{
    GLuint program = p->ground;
    weft_vec3 eye = weft_orbit_eye(&scene->orbit, p->centre, p->radius), centre = ground_below(p);
    glUseProgram(program);
    weft_player_set_rays(program, scene, pane);
    weft_gl_set_vec3(program, "eye", (double)eye.x, (double)eye.y, (double)eye.z);
    weft_gl_set_vec3(program, "backdrop", backdrop[0], backdrop[1], backdrop[2]);
    weft_gl_set_vec3(program, "ground_centre", (double)centre.x, (double)centre.y, (double)centre.z);
    weft_gl_set_float(program, "ground_size", p->radius);
    set_light(p, program, scene);
    set_shadows(p, program, scene);
}

/* The ground below the mesh: the light that falls on it, and what the mesh hides of that. */
#include "player/draw/lighting.h"
#include "player/draw/player_parts.h"

#include <string.h>

/* Directions that a frame adds to a sum that is not whole. */
enum { MOVING_DIRECTIONS = 4, RESTING_DIRECTIONS = 8 };

static const double backdrop[3] = {0.34, 0.335, 0.33};

/* ---- Shadows ---- */

double weft_player_shadow_detail(int width, int height)
{
    const double whole = 128;
    return fmin(1, (width > height ? width : height) / whole);
}

/* Longest shadow that the sum holds, in radii of the mesh: beyond, little is seen of the ground. And what of the
 * environment stands lower than this brings little to it. */
static const double furthest = 6, low_fill_rad = 66 * WEFT_PI / 180;

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
    if (shadow->count > 0 && is_same_light(shadow->light, light) &&
        shadow->whole >= weft_ground_shadow_directions(detail))
        return WEFT_OK;
    memcpy(shadow->light, light, sizeof shadow->light);
    return weft_ground_shadow_clear(shadow, ground_below(p), reach, detail, error);
}

static weft_code follow_light(weft_player *p, const weft_scene *scene, int part, double detail, weft_error *error)
{
    const weft_angles key = scene->light[0].direction;
    const double light[WEFT_GROUND_LIGHTS][3] = {{key.theta_rad, key.phi_rad, scene->key_size_rad},
                                                 {scene->environment_turn_rad}};
    double lowest_rad = part == 0 ? key.theta_rad + scene->key_size_rad : low_fill_rad;
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
        weft_ground_shadow_begin(shadow, light, program);
        weft_player_set_caster(p, scene, light, weft_player_sequence(p, shadow->count), program);
        weft_player_draw_mesh(p, true);
    }
    weft_ground_shadow_end(shadow);
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
    return sum_shadows(p, scene, whole->sampling.frame < 0 ? MOVING_DIRECTIONS : RESTING_DIRECTIONS,
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
    for (int i = 0; i < weft_lighting_held(&l); i++) {
        for (int c = 0; c < 3; c++)
            sum[i > 0 || l.scene_count == 0][c] += l.irradiance[i][c] * fmaxf(l.direction[i][2], 0);
    }
    glUniform3fv(weft_gl_uniform(program, "ground_light"), WEFT_GROUND_LIGHTS, sum[0]);
}

static void set_shadows(const weft_player *p, GLuint program, const weft_scene *scene)
{
    static const char *const name[WEFT_GROUND_LIGHTS] = {"key_hidden", "fill_hidden"};
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

/* Which program draws what, and what it is given. */
#include "player/draw/player_parts.h"

#include "player/draw/lighting.h"

enum { HURRIED_LIGHTS = 2 };

/* They take other texture units than lobes do. */
static bool uses_components(const weft_player *p, const weft_scene *scene)
{
    return scene->components > 0 && p->material.components.group_count > 0;
}

static int drawn_groups(const weft_player *p, const weft_scene *scene)
{
    int wanted = (scene->components + WEFT_COMPONENTS_GROUP - 1) / WEFT_COMPONENTS_GROUP,
        most = p->material.components.group_count;
    return wanted < most ? wanted : most;
}

void weft_player_bind_mode(const weft_player *p, const weft_scene *scene, weft_mode mode, GLuint program)
{
    switch (mode) {
    case WEFT_MODE_RAW:
        weft_raw_texture_bind(&p->raw, program);
        break;
    case WEFT_MODE_COMPRESSED:
        weft_material_texture_bind(&p->material, program, uses_components(p, scene));
        if (scene->show_extrapolation && p->material.seen.maps)
            weft_seen_texture_bind(&p->material.seen, program, uses_components(p, scene) ? 0 : 5);
        glUniform1fv(glGetUniformLocation(program, "lobe_share"), WEFT_SCENE_MAX_LOBES,
                     (const GLfloat[]){scene->lobe[0], scene->lobe[1], scene->lobe[2]});
        weft_gl_set_float(program, "view_table_share", scene->view_table);
        weft_gl_set_float(program, "light_table_share", scene->light_table);
        weft_gl_set_float(program, "table_steps", (1 << scene->table_bits) - 1);
        break;
    default:
        if (weft_player_has_threads(p))
            weft_thread_texture_bind(&p->threads, program);
        else
            weft_weave_texture_bind(&p->weave, program, (unsigned)scene->noise_seed);
        break;
    }
}

/* All lights of an environment through all neighbours of every pixel would take seconds. */
static bool is_stochastic(const weft_player *p, const weft_scene *scene, weft_sampling sampling)
{
    if (scene->filter == WEFT_FILTER_AUTO)
        return sampling.hurry || (scene->environment && p->environment);
    return scene->filter == WEFT_FILTER_STOCHASTIC;
}

weft_program_kind weft_player_kind(const weft_player *p, const weft_scene *scene, const weft_pane *pane)
{
    weft_program_kind kind = {
        .mode = pane->mode,
        .stochastic = is_stochastic(p, scene, pane->sampling),
        .shadows = weft_scene_has_shadows(scene),
        .one_light = weft_lighting_count(scene, p->environment) == 1,
    };
    bool has_many = scene->environment && p->environment && p->environment->region_count > HURRIED_LIGHTS;
    /* Where a light is tinted it has to be the same in neighbouring pixels. */
    if (pane->sampling.hurry && has_many && !scene->show_extrapolation)
        kind.chosen_lights = HURRIED_LIGHTS;
    kind.threads = pane->mode == WEFT_MODE_ANALYTIC && weft_player_has_threads(p);
    kind.noise = pane->mode == WEFT_MODE_ANALYTIC && scene->noise_seed != 0 && p->weave.has_noise;
    if (pane->mode == WEFT_MODE_RAW) {
        kind.opacity = !p->raw.opaque;
        kind.relief = scene->relief && p->raw.relief.height;
    }
    if (pane->mode == WEFT_MODE_COMPRESSED) {
        kind.lobe_count = p->material.lobe_count;
        kind.view_table = p->material.table.count > 0;
        kind.light_table = p->material.light_table.count > 0;
        kind.fewer_bits = scene->table_bits < 8;
        kind.pruned = scene->show_extrapolation && p->material.seen.maps;
        kind.component_groups = uses_components(p, scene) ? p->material.components.group_count : 0;
        kind.drawn_groups = drawn_groups(p, scene);
        kind.incidence_power = p->material.components.incidence_power;
        kind.opacity = kind.component_groups > 0 && !p->material.opaque;
        kind.relief = kind.component_groups > 0 && scene->relief && p->material.relief.height;
    }
    return kind;
}

bool weft_player_is_opaque(const weft_player *p, weft_mode mode)
{
    return mode == WEFT_MODE_ANALYTIC || (mode == WEFT_MODE_RAW ? p->raw.opaque : p->material.opaque);
}

weft_program_kind weft_player_casting_kind(const weft_player *p, const weft_scene *scene, weft_mode mode, bool is_soft)
{
    const weft_pane pane = {.mode = mode};
    weft_program_kind kind = weft_player_kind(p, scene, &pane);
    kind.casts = kind.opacity = kind.one_light = true;
    kind.shadows = kind.pruned = kind.fewer_bits = false;
    kind.chosen_lights = 0;
    kind.stochastic = is_soft;
    kind.relief = kind.relief && !is_soft;
    kind.drawn_groups = kind.component_groups > 0;
    return kind;
}

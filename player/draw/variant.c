/* Which program draws what, and what it is given. */
#include "player/draw/player_parts.h"

#include "player/draw/lighting.h"

enum { INTERACTIVE_LIGHTS = 2 };

/* They take other texture units than lobes do. */
static bool uses_components(const weft_player *p, const weft_scene *scene)
{
    return weft_player_drawn_components(p, scene) > 0;
}

void weft_player_bind_mode(const weft_player *p, const weft_scene *scene, weft_mode mode, GLuint program)
{
    switch (mode) {
    case WEFT_MODE_RAW:
        weft_raw_texture_bind(&p->raw, program);
        break;
    case WEFT_MODE_COMPRESSED:
        weft_material_texture_bind(&p->material, program, uses_components(p, scene));
        if (scene->show_extrapolation && p->material.visibility.maps)
            weft_visibility_texture_bind(&p->material.visibility, program, uses_components(p, scene) ? 0 : 5);
        if (uses_components(p, scene))
            break;
        glUniform1fv(weft_gl_uniform(program, "lobe_share"), WEFT_SCENE_MAX_LOBES,
                     (const GLfloat[]){scene->lobe[0], scene->lobe[1], scene->lobe[2]});
        weft_gl_set_float(program, "view_table_share", scene->view_table);
        weft_gl_set_float(program, "light_table_share", scene->light_table);
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
        return sampling.interactive || (scene->environment && p->environment);
    return scene->filter == WEFT_FILTER_STOCHASTIC;
}

weft_variant weft_player_variant(const weft_player *p, const weft_scene *scene, const weft_pane *pane)
{
    weft_variant variant = {
        .mode = pane->mode,
        .stochastic = is_stochastic(p, scene, pane->sampling),
        .shadows = weft_scene_has_shadows(scene),
        .one_light = weft_lighting_count(scene, p->environment) == 1,
    };
    bool has_many = scene->environment && p->environment && p->environment->region_count > INTERACTIVE_LIGHTS;
    /* Where a light is tinted it has to be the same in neighbouring pixels. */
    if (pane->sampling.interactive && has_many && !scene->show_extrapolation)
        variant.chosen_lights = INTERACTIVE_LIGHTS;
    variant.threads = pane->mode == WEFT_MODE_ANALYTIC && weft_player_has_threads(p);
    variant.noise = pane->mode == WEFT_MODE_ANALYTIC && scene->noise_seed != 0 && p->weave.has_noise;
    variant.staples = pane->mode == WEFT_MODE_ANALYTIC && !variant.threads && p->weave.has_staples;
    variant.filaments = pane->mode == WEFT_MODE_ANALYTIC && !variant.threads && p->weave.has_filaments;
    if (pane->mode == WEFT_MODE_RAW) {
        variant.opacity = !p->raw.opaque;
        variant.relief = scene->relief && p->raw.relief.height;
    }
    if (pane->mode == WEFT_MODE_COMPRESSED) {
        variant.lobe_count = p->material.lobe_count;
        variant.view_table = p->material.table.count > 0;
        variant.light_table = p->material.light_table.count > 0;
        variant.pruned = scene->show_extrapolation && p->material.visibility.maps;
        variant.component_groups = uses_components(p, scene) ? p->material.components.group_count : 0;
        variant.drawn_groups = weft_player_drawn_components(p, scene) / WEFT_COMPONENTS_GROUP;
        variant.over_half_vector = p->material.components.over_half_vector;
        variant.kriged = p->material.components.kriged;
        variant.opacity = variant.component_groups > 0 && !p->material.opaque;
        variant.relief = variant.component_groups > 0 && scene->relief && p->material.relief.height;
    }
    return variant;
}

bool weft_player_is_opaque(const weft_player *p, weft_mode mode)
{
    return mode == WEFT_MODE_ANALYTIC || (mode == WEFT_MODE_RAW ? p->raw.opaque : p->material.opaque);
}

weft_variant weft_player_casting_variant(const weft_player *p, const weft_scene *scene, weft_mode mode, bool is_soft)
{
    const weft_pane pane = {.mode = mode};
    weft_variant variant = weft_player_variant(p, scene, &pane);
    variant.casts = variant.opacity = variant.one_light = true;
    variant.shadows = variant.pruned = false;
    variant.chosen_lights = 0;
    variant.stochastic = is_soft;
    variant.relief = variant.relief && !is_soft;
    variant.drawn_groups = variant.component_groups > 0;
    return variant;
}

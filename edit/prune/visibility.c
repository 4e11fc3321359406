#include "edit/prune/visibility.h"

#include "edit/prune/visibility_bounds.h"

#include <stdlib.h>
#include <string.h>

static const double widest_span = 0.1; /* radians, or shares of the distance */

enum { MOST_HALVINGS = 12, MOST_QUARTERS = 7, QUARTERS_FOR_AXES = 2 };

/* One search. */
typedef struct search {
    const weft_prune_scene *scene;
    weft_visibility *visibility;
    weft_vec3 centre;
    double radius;
    double level_bias;
    double border[2];  /* of texels that heights bring into a pixel, in materials */
    weft_patch *patch; /* [patch_count] the triangles that have an area */
    int patch_count;
} search;

/* ---- Levels ---- */

/* The levels that a pixel interpolates between. */
static void levels_of(const search *s, double low, double high, int *first, int *last)
{
    const weft_scene *scene = &s->scene->scene;
    if (scene->level_choice == WEFT_LEVEL_NONE)
        low = high = 0;
    if (scene->level_choice == WEFT_LEVEL_FIXED)
        low = high = scene->level;
    if (scene->level_choice == WEFT_LEVEL_NEAREST) {
        low = floor(low + 0.5);
        high = floor(high + 0.5);
    }
    int coarsest = s->visibility->level_count - 1;
    *first = (int)floor(weft_clamp(low, 0, coarsest));
    *last = (int)ceil(weft_clamp(high, 0, coarsest));
}

/* ---- One patch in one span ---- */

static void mark_side(search *s, const weft_camera_span *span, const weft_patch_bounds *bounds, bool behind)
{
    weft_direction_cap view = behind ? weft_cap_behind(&bounds->view) : bounds->view;
    if (s->scene->scene.environment)
        weft_visibility_mark_view(s->visibility, &view);
    for (int i = 0; i < span->light_count && !s->scene->scene.environment; i++) {
        weft_direction_cap light = behind ? weft_cap_behind(&bounds->light[i]) : bounds->light[i];
        weft_visibility_mark_pair(s->visibility, &view, &light);
    }
}

/* The back of the cloth is mirrored in u. */
static void mark_place(search *s, const weft_patch *p, const weft_patch_bounds *bounds, bool behind)
{
    weft_visibility_box box = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, {s->border[0], s->border[1]}};
    int first, last;
    for (int i = 0; i < 3; i++) {
        const double place[2] = {behind ? -p->corner[i].u : p->corner[i].u, p->corner[i].v};
        for (int axis = 0; axis < 2; axis++) {
            box.low[axis] = fmin(box.low[axis], place[axis]);
            box.high[axis] = fmax(box.high[axis], place[axis]);
        }
    }
    double low = bounds->level_low + s->level_bias, high = bounds->level_high + s->level_bias;
    s->visibility->level_low = fmin(s->visibility->level_low, low);
    s->visibility->level_high = fmax(s->visibility->level_high, high);
    levels_of(s, low, high, &first, &last);
    weft_visibility_mark_texels(s->visibility, &box, first, last);
}

static void visit(search *s, const weft_camera_span *span, const weft_patch *p, int quarters)
{
    weft_patch_bounds bounds = weft_patch_bounds_of(p, span);
    if (!bounds.visible)
        return;
    int most = bounds.is_large ? MOST_QUARTERS : bounds.is_bent ? QUARTERS_FOR_AXES : 0;
    if (quarters < most) {
        for (int part = 0; part < 4; part++) {
            const weft_patch quarter = weft_patch_quarter(p, part);
            visit(s, span, &quarter, quarters + 1);
        }
        return;
    }
    const bool side[2] = {bounds.front, bounds.back};
    for (int behind = 0; behind < 2; behind++) {
        if (!side[behind])
            continue;
        mark_side(s, span, &bounds, behind);
        mark_place(s, p, &bounds, behind);
    }
}

/* ---- The path ---- */

static void visit_span(search *s, const weft_scene *low, const weft_scene *high)
{
    const weft_prune_scene *scene = s->scene;
    const weft_camera_span span = weft_camera_span_of(low, high, s->centre, s->radius, scene->width, scene->height);
    for (int i = 0; i < s->patch_count; i++)
        visit(s, &span, &s->patch[i], 0);
    s->visibility->span_count++;
}

static void visit_times(search *s, double from_s, double to_s, int halvings)
{
    weft_scene low = s->scene->scene, high = low;
    if (s->scene->path)
        weft_path_span(s->scene->path, from_s, to_s, &low, &high);
    if (weft_camera_span_width(&low, &high) > widest_span && halvings < MOST_HALVINGS) {
        double half_s = from_s + (to_s - from_s) / 2;
        visit_times(s, from_s, half_s, halvings + 1);
        visit_times(s, half_s, to_s, halvings + 1);
        return;
    }
    visit_span(s, &low, &high);
}

static void visit_path(search *s, const weft_progress *progress)
{
    const weft_path *path = s->scene->path;
    int steps = path && path->key_count > 1 ? path->key_count - 1 : 1;
    for (int key = 0; key < steps; key++) {
        weft_progress_report(progress, "finding what is seen", key, steps);
        double from_s = path ? path->time_s[key] : 0;
        visit_times(s, from_s, path && path->key_count > 1 ? path->time_s[key + 1] : from_s, 0);
    }
    weft_progress_report(progress, "finding what is seen", steps, steps);
}

/* ---- Before ---- */

static weft_patch_corner corner_of(const weft_vertex *v, const double repeat[2])
{
    return (weft_patch_corner){weft_vec3_of(v->position[0], v->position[1], v->position[2]),
                               weft_vec3_of(v->normal[0], v->normal[1], v->normal[2]),
                               weft_vec3_of(v->tangent[0], v->tangent[1], v->tangent[2]),
                               v->tangent[3],
                               v->coordinate[0] * repeat[0],
                               v->coordinate[1] * repeat[1]};
}

/* Small pictures are drawn with coarser triangles: both kinds count. */
static weft_code cut_mesh(search *s, const weft_material *material, weft_error *error)
{
    const weft_mesh *mesh = s->scene->mesh;
    int width = material->level[0].width, height = material->level[0].height;
    size_t count = (size_t)mesh->triangle_count + (size_t)mesh->coarse_count;
    const double repeat[2] = {s->scene->scene.repeat, s->scene->scene.repeat * width / height};
    bool has_texture = false;
    s->patch = calloc(count, sizeof *s->patch);
    if (!s->patch)
        return weft_fail_memory(error, "triangles", count * sizeof *s->patch);
    for (size_t i = 0; i < count; i++) {
        weft_patch *patch = &s->patch[s->patch_count];
        for (int c = 0; c < 3; c++)
            patch->corner[c] = corner_of(&mesh->vertex[mesh->index[i][c]], repeat);
        s->patch_count += weft_patch_set_plane(patch, width, height);
        has_texture = has_texture || patch->largest_stretch > 0;
    }
    return has_texture ? WEFT_OK
                       : weft_fail(error, WEFT_BAD_INPUT,
                                   "all texture coordinates of the mesh are alike: no material lies on it");
}

/* Lines of sight through heights end at most so far aside (docs/reference/weft-format.md, 9): both the view and the
 * stored views lean up to c = 0.2. */
static void find_border(search *s, const weft_material *material)
{
    const weft_material_heights *heights = material->heights;
    for (int axis = 0; heights && axis < 2; axis++)
        s->border[axis] =
            10 * fmax(fabs((double)heights->low_mm), fabs((double)heights->high_mm)) / heights->size_mm[axis];
}

static weft_code allocate(const weft_material *material, weft_visibility *visibility, weft_error *error)
{
    size_t pairs = (size_t)WEFT_VISIBILITY_PAIR_CELLS * WEFT_VISIBILITY_PAIR_CELLS;
    *visibility =
        (weft_visibility){.level_count = material->level_count, .level_low = INFINITY, .level_high = -INFINITY};
    for (int i = 0; i < 9; i++) {
        visibility->product[i / 3][i % 3][0] = INFINITY;
        visibility->product[i / 3][i % 3][1] = -INFINITY;
    }
    visibility->pair = calloc(pairs, 1);
    if (!visibility->pair)
        return weft_fail_memory(error, "pairs of directions", pairs);
    for (int k = 0; k < material->level_count; k++) {
        visibility->width[k] = material->level[k].width;
        visibility->height[k] = material->level[k].height;
        size_t texels = (size_t)visibility->width[k] * (size_t)visibility->height[k];
        visibility->texel[k] = calloc(texels, 1);
        if (!visibility->texel[k])
            return weft_fail_memory(error, "texels that are seen", texels);
    }
    return WEFT_OK;
}

static weft_code find(search *s, const weft_material *material, const weft_progress *progress, weft_error *error)
{
    float centre[3], radius;
    WEFT_TRY(allocate(material, s->visibility, error));
    weft_mesh_bounds(s->scene->mesh, centre, &radius);
    s->centre = weft_vec3_of(centre[0], centre[1], centre[2]);
    s->radius = radius;
    s->level_bias = -log2(s->scene->samples);
    find_border(s, material);
    WEFT_TRY(cut_mesh(s, material, error));
    visit_path(s, progress);
    if (s->scene->scene.environment)
        weft_visibility_light_all(s->visibility);
    return s->visibility->level_low < INFINITY
               ? WEFT_OK
               : weft_fail(error, WEFT_BAD_INPUT,
                           "nothing of the mesh is ever in the picture: check the camera and its path");
}

weft_code weft_visibility_find(const weft_prune_scene *scene, const weft_material *material,
                               const weft_progress *progress, weft_visibility *visibility, weft_error *error)
{
    search s = {.scene = scene, .visibility = visibility};
    weft_code code = find(&s, material, progress, error);
    free(s.patch);
    if (code != WEFT_OK)
        weft_visibility_free(visibility);
    return code;
}

void weft_visibility_free(weft_visibility *visibility)
{
    for (int k = 0; k < visibility->level_count; k++)
        free(visibility->texel[k]);
    free(visibility->pair);
    *visibility = (weft_visibility){0};
}

#include "geometry/drape/draped_cloth.h"

#include "geometry/drape/draped_scene.h"
#include "geometry/light/path_step.h"
#include "geometry/light/sample_sequence.h"
#include "geometry/yarn/fibre.h"

#include <stdlib.h>

struct weft_draped_cloth {
    const weft_stitch *stitch;
    const weft_tile_mesh *mesh;
    weft_draped_scene *scene;
};

weft_code weft_draped_cloth_create(const weft_stitch *stitch, const weft_tile_mesh *mesh,
                                   const weft_base_surface *surface, weft_draped_cloth **result, weft_error *error)
{
    *result = NULL;
    weft_draped_cloth *cloth = calloc(1, sizeof *cloth);
    if (!cloth)
        return weft_fail_memory(error, "draped cloth", sizeof *cloth);
    cloth->stitch = stitch;
    cloth->mesh = mesh;
    weft_code code = weft_draped_scene_create(mesh, surface, WEFT_DRAPED_MAX_TRIANGLES, &cloth->scene, error);
    if (code != WEFT_OK) {
        weft_draped_cloth_free(cloth);
        return code;
    }
    *result = cloth;
    return WEFT_OK;
}

void weft_draped_cloth_free(weft_draped_cloth *cloth)
{
    if (!cloth)
        return;
    weft_draped_scene_free(cloth->scene);
    free(cloth);
}

int weft_draped_cloth_triangle_count(const weft_draped_cloth *cloth)
{
    return weft_draped_scene_triangle_count(cloth->scene);
}

/* A vertex of a path and what reached it of the light that leaves by the camera's ray. */
typedef struct draped_vertex {
    weft_draped_hit hit;
    weft_fibre_view seen;
    weft_rgb throughput;
    bool is_near; /* all rays so far were within reach */
} draped_vertex;

/* Next vertex along a ray; false where there is none or a yarn is seen from inside. */
static bool find_vertex(const weft_draped_cloth *cloth, weft_vec3 from, weft_vec3 direction, draped_vertex *vertex)
{
    if (!weft_draped_scene_trace(cloth->scene, from, direction, &vertex->hit) ||
        weft_dot(vertex->hit.normal, direction) >= 0)
        return false;
    const weft_fibre *fibre = &cloth->stitch->yarn[vertex->hit.yarn].fibre;
    vertex->seen = weft_fibre_seen_from(fibre, vertex->hit.tangent, vertex->hit.normal, weft_scale(direction, -1));
    return true;
}

static weft_vec3 above(const weft_draped_cloth *cloth, const weft_draped_hit *hit)
{
    return weft_path_ray_start(cloth->mesh, hit->at, hit->normal);
}

static void add_light(const weft_draped_cloth *cloth, const draped_vertex *vertex, const weft_draped_light *light,
                      weft_draped_radiance *radiance)
{
    weft_real cosine = weft_dot(vertex->hit.normal, light->direction);
    if (!(cosine > 0))
        return;
    weft_real obstacle = weft_draped_scene_distance(cloth->scene, above(cloth, &vertex->hit), light->direction);
    weft_rgb f = weft_fibre_brdf(&vertex->seen, light->direction), t = vertex->throughput;
    weft_real arriving = (weft_real)WEFT_PI * cosine;
    const float sent[3] = {(float)(t.r * f.r * arriving), (float)(t.g * f.g * arriving), (float)(t.b * f.b * arriving)};
    for (int c = 0; c < 3; c++) {
        if (isinf(obstacle))
            radiance->all[c] += sent[c];
        if (vertex->is_near && obstacle > light->reach_mm)
            radiance->near[c] += sent[c];
    }
}

/* Moves the path to its next vertex; false where it ends. */
static bool bounce(const weft_draped_cloth *cloth, draped_vertex *vertex, weft_real reach_mm, uint64_t key,
                   uint32_t index)
{
    double point[2];
    weft_sequence_point(key, index, point);
    weft_vec3 direction = weft_path_cosine_direction(vertex->hit.normal, vertex->hit.tangent, point);
    if (!weft_path_reflect(weft_fibre_brdf(&vertex->seen, direction), &vertex->throughput))
        return false;
    if (!find_vertex(cloth, above(cloth, &vertex->hit), direction, vertex))
        return false;
    vertex->is_near &= vertex->hit.distance <= reach_mm;
    return true;
}

bool weft_draped_cloth_path(const weft_draped_cloth *cloth, weft_vec3 origin, weft_vec3 direction,
                            const weft_draped_light *light, uint64_t key, uint32_t index,
                            weft_draped_radiance *radiance)
{
    draped_vertex vertex = {.throughput = {1, 1, 1}, .is_near = true};
    if (!find_vertex(cloth, origin, direction, &vertex))
        return !isinf(weft_draped_scene_distance(cloth->scene, origin, direction));
    add_light(cloth, &vertex, light, radiance);
    for (int i = 0; i < light->bounces; i++) {
        if (!bounce(cloth, &vertex, light->reach_mm, weft_sequence_key(key, (uint64_t)i), index))
            break;
        add_light(cloth, &vertex, light, radiance);
    }
    return true;
}

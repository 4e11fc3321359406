#include "geometry/light/light_path.h"

#include "btf/direction/frame.h"
#include "geometry/light/sample_sequence.h"

static weft_vec3 vertex_vector(const float *from)
{
    return weft_vec3_of(from[0], from[1], from[2]);
}

weft_vec3 weft_path_above(const weft_path_scene *scene, weft_vec3 at, weft_vec3 normal)
{
    return weft_path_ray_start(weft_ray_scene_mesh(scene->rays), at, normal);
}

static weft_vec3 interpolate(const weft_tile_mesh *mesh, const weft_ray_hit *hit, float (*attribute)[3])
{
    weft_vec3 sum = {0};
    for (int i = 0; i < 3; i++)
        sum = weft_add(sum, weft_scale(vertex_vector(attribute[mesh->triangle[hit->triangle][i]]), hit->weight[i]));
    return sum;
}

static int yarn_at(const weft_tile_mesh *mesh, const weft_ray_hit *hit)
{
    int largest = hit->weight[1] > hit->weight[0] ? 1 : 0;
    largest = hit->weight[2] > hit->weight[largest] ? 2 : largest;
    return mesh->yarn[mesh->triangle[hit->triangle][largest]];
}

/* Next vertex along a ray. */
static weft_path_end find_vertex(const weft_path_scene *scene, weft_vec3 from, weft_vec3 direction,
                                 weft_path_vertex *vertex)
{
    const weft_tile_mesh *mesh = weft_ray_scene_mesh(scene->rays);
    if (!weft_ray_scene_trace(scene->rays, from, direction, &vertex->hit))
        return WEFT_PATH_LEFT;
    if (weft_dot(vertex->hit.normal, direction) >= 0)
        return WEFT_PATH_LOST;
    weft_frame frame = weft_frame_of_vectors(vertex->hit.normal, interpolate(mesh, &vertex->hit, mesh->tangent));
    vertex->tangent = frame.tangent;
    vertex->yarn = yarn_at(mesh, &vertex->hit);
    const weft_fibre *fibre = &scene->stitch->yarn[vertex->yarn].fibre;
    vertex->seen = weft_fibre_seen_from(fibre, frame.tangent, frame.normal, weft_scale(direction, -1));
    return WEFT_PATH_GOES_ON;
}

weft_path_end weft_path_bounce(const weft_path_scene *scene, weft_path_vertex *vertex, weft_rgb *throughput,
                               uint64_t key, uint32_t index)
{
    double point[2];
    weft_sequence_point(key, index, point);
    weft_vec3 direction = weft_path_cosine_direction(vertex->hit.normal, vertex->tangent, point);
    if (!weft_path_reflect(weft_fibre_brdf(&vertex->seen, direction), throughput))
        return WEFT_PATH_LOST;
    return find_vertex(scene, weft_path_above(scene, vertex->hit.at, vertex->hit.normal), direction, vertex);
}

/* The point on the view ray just above the cloth. */
static weft_vec3 ray_start(const weft_path_scene *scene, weft_vec3 place, weft_vec3 view)
{
    const weft_tile_mesh *mesh = weft_ray_scene_mesh(scene->rays);
    weft_real rise = (weft_real)mesh->top + (weft_real)mesh->cell / 2 - place.z;
    return weft_add(place, weft_scale(view, rise / view.z));
}

bool weft_path_begin(const weft_path_scene *scene, weft_vec3 place, weft_vec3 view, weft_path_vertex *vertex)
{
    weft_vec3 start = ray_start(scene, place, view);
    return find_vertex(scene, start, weft_scale(view, -1), vertex) == WEFT_PATH_GOES_ON;
}

weft_vec3 weft_path_surface_normal(const weft_path_scene *scene, const weft_path_vertex *vertex)
{
    const weft_tile_mesh *mesh = weft_ray_scene_mesh(scene->rays);
    return weft_unit(interpolate(mesh, &vertex->hit, mesh->normal));
}

/* ---- Steps that do not depend on where rays are traced ---- */

/* Rays start this far above the surface, in cells of the grid. */
#define RAY_OFFSET 1e-3

/* A path that carries less than this part of the light is over. */
#define NEGLIGIBLE 1e-4

weft_vec3 weft_path_ray_start(const weft_tile_mesh *mesh, weft_vec3 at, weft_vec3 normal)
{
    return weft_add(at, weft_scale(normal, (weft_real)RAY_OFFSET * (weft_real)mesh->cell));
}

weft_vec3 weft_path_cosine_direction(weft_vec3 normal, weft_vec3 tangent, const double point[2])
{
    weft_real radius = sqrt(point[0]), angle = 2 * (weft_real)WEFT_PI * point[1];
    weft_vec3 flat = weft_add(weft_scale(tangent, radius * cos(angle)),
                              weft_scale(weft_cross(normal, tangent), radius * sin(angle)));
    return weft_unit(weft_add(flat, weft_scale(normal, sqrt(1 - point[0]))));
}

bool weft_path_reflect(weft_rgb f, weft_rgb *throughput)
{
    throughput->r *= f.r * (weft_real)WEFT_PI;
    throughput->g *= f.g * (weft_real)WEFT_PI;
    throughput->b *= f.b * (weft_real)WEFT_PI;
    return fmax(throughput->r, fmax(throughput->g, throughput->b)) > (weft_real)NEGLIGIBLE;
}

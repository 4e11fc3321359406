#include "geometry/illumination.h"

#include "btf/material.h"
#include "geometry/fibre.h"
#include "geometry/ray_scene.h"
#include "geometry/sample_sequence.h"
#include "reflectance/lafortune.h"

#include <stdlib.h>
#include <string.h>

/* Rays start this far above the surface, in cells of the grid. */
#define RAY_OFFSET 1e-3

/* A path that carries less than this part of the light is over. */
#define NEGLIGIBLE 1e-4

struct weft_illumination {
    const weft_stitch *stitch;
    ray_scene *scene;
    weft_illumination_options options;
    int light_count;
    weft_vec3 *light;
    uint8_t
        *lit; /* [triangle_count][light_count] 1 where the middle of a triangle sees a light; NULL when not needed */
};

/* How a path went on from a vertex. */
typedef enum path_end {
    PATH_GOES_ON, /* to another vertex */
    PATH_LEFT,    /* the cloth */
    PATH_LOST     /* it carries nothing any more, or slipped inside a yarn through a crease */
} path_end;

/* A vertex of a path. */
typedef struct path_vertex {
    ray_hit hit;
    weft_vec3 tangent;
    const weft_fibre *fibre;
    weft_fibre_view seen;
} path_vertex;

static weft_vec3 vertex_vector(const float *from)
{
    return weft_vec3_of(from[0], from[1], from[2]);
}

static weft_vec3 above(const weft_tile_mesh *mesh, weft_vec3 at, weft_vec3 normal)
{
    return weft_add(at, weft_scale(normal, (weft_real)RAY_OFFSET * (weft_real)mesh->cell));
}

/* Which lights lie on the outer side of a surface. */
static void mark_lights_above(const weft_illumination *illumination, weft_vec3 normal, uint8_t *above_surface)
{
    for (int i = 0; i < illumination->light_count; i++)
        above_surface[i] = weft_dot(normal, illumination->light[i]) > 0;
}

/* Which lights are seen from just above a place of the surface. */
static void find_lights(const weft_illumination *illumination, weft_vec3 at, weft_vec3 normal, uint8_t *lit)
{
    uint8_t wanted[WEFT_ILLUMINATION_MAX_LIGHTS];
    mark_lights_above(illumination, normal, wanted);
    weft_vec3 from = above(ray_scene_mesh(illumination->scene), at, normal);
    ray_scene_lit(illumination->scene, from, illumination->light, illumination->light_count, wanted, lit);
}

static weft_code find_visibility(weft_illumination *illumination, weft_error *error)
{
    const weft_tile_mesh *mesh = ray_scene_mesh(illumination->scene);
    size_t lights = (size_t)illumination->light_count, size = lights * (size_t)mesh->triangle_count;
    illumination->lit = malloc(size);
    if (!illumination->lit)
        return weft_fail_memory(error, "visibility of the lights", size);
#pragma omp parallel for schedule(dynamic, 64)
    for (int i = 0; i < mesh->triangle_count; i++) {
        ray_hit middle = ray_scene_middle(illumination->scene, i);
        find_lights(illumination, middle.at, middle.normal, illumination->lit + (size_t)i * lights);
    }
    return WEFT_OK;
}

static weft_code prepare(weft_illumination *illumination, const weft_tile_mesh *mesh, const weft_vec3 *light,
                         weft_error *error)
{
    size_t size = (size_t)illumination->light_count * sizeof *light;
    illumination->light = malloc(size);
    if (!illumination->light)
        return weft_fail_memory(error, "lights", size);
    memcpy(illumination->light, light, size);
    WEFT_TRY(ray_scene_create(mesh, &illumination->scene, error));
    if (illumination->options.bounces > 0 && !illumination->options.exact)
        return find_visibility(illumination, error);
    return WEFT_OK;
}

weft_code weft_illumination_create(const weft_stitch *stitch, const weft_tile_mesh *mesh, const weft_vec3 *light,
                                   int light_count, const weft_illumination_options *options,
                                   weft_illumination **result, weft_error *error)
{
    *result = NULL;
    if (light_count < 1 || light_count > WEFT_ILLUMINATION_MAX_LIGHTS)
        return weft_fail(error, WEFT_BAD_USAGE, "%d lights: 1 to %d can be simulated", light_count,
                         WEFT_ILLUMINATION_MAX_LIGHTS);
    if (options->bounces < 0 || options->bounces > WEFT_ILLUMINATION_MAX_BOUNCES)
        return weft_fail(error, WEFT_BAD_USAGE, "%d bounces: 0 to %d can be simulated", options->bounces,
                         WEFT_ILLUMINATION_MAX_BOUNCES);
    weft_illumination *illumination = calloc(1, sizeof *illumination);
    if (!illumination)
        return weft_fail_memory(error, "illumination", sizeof *illumination);
    illumination->stitch = stitch;
    illumination->options = *options;
    illumination->light_count = light_count;
    weft_code code = prepare(illumination, mesh, light, error);
    if (code != WEFT_OK) {
        weft_illumination_free(illumination);
        return code;
    }
    *result = illumination;
    return WEFT_OK;
}

void weft_illumination_free(weft_illumination *illumination)
{
    if (!illumination)
        return;
    ray_scene_free(illumination->scene);
    free(illumination->light);
    free(illumination->lit);
    free(illumination);
}

static weft_vec3 interpolate(const weft_tile_mesh *mesh, const ray_hit *hit, float (*attribute)[3])
{
    weft_vec3 sum = {0};
    for (int i = 0; i < 3; i++)
        sum = weft_add(sum, weft_scale(vertex_vector(attribute[mesh->triangle[hit->triangle][i]]), hit->weight[i]));
    return sum;
}

static int yarn_at(const weft_tile_mesh *mesh, const ray_hit *hit)
{
    int largest = hit->weight[1] > hit->weight[0] ? 1 : 0;
    largest = hit->weight[2] > hit->weight[largest] ? 2 : largest;
    return mesh->yarn[mesh->triangle[hit->triangle][largest]];
}

/* Next vertex along a ray. */
static path_end find_vertex(const weft_illumination *illumination, weft_vec3 from, weft_vec3 direction,
                            path_vertex *vertex)
{
    const weft_tile_mesh *mesh = ray_scene_mesh(illumination->scene);
    if (!ray_scene_trace(illumination->scene, from, direction, &vertex->hit))
        return PATH_LEFT;
    if (weft_dot(vertex->hit.normal, direction) >= 0)
        return PATH_LOST;
    weft_frame frame = weft_frame_of_vectors(vertex->hit.normal, interpolate(mesh, &vertex->hit, mesh->tangent));
    vertex->tangent = frame.tangent;
    vertex->fibre = &illumination->stitch->yarn[yarn_at(mesh, &vertex->hit)].fibre;
    vertex->seen = weft_fibre_seen_from(vertex->fibre, frame.tangent, frame.normal, weft_scale(direction, -1));
    return PATH_GOES_ON;
}

static void add_light(const weft_illumination *illumination, const path_vertex *vertex, int light, weft_rgb throughput,
                      float radiance[3])
{
    weft_vec3 direction = illumination->light[light];
    weft_rgb f = weft_fibre_brdf(&vertex->seen, direction);
    weft_real arriving = (weft_real)WEFT_PI * weft_dot(vertex->hit.normal, direction);
    radiance[0] += (float)(throughput.r * f.r * arriving);
    radiance[1] += (float)(throughput.g * f.g * arriving);
    radiance[2] += (float)(throughput.b * f.b * arriving);
}

/* Light straight from the lights: by shadow rays, or `roughly`, by what the middle of the triangle sees. */
static void add_lights(const weft_illumination *illumination, const path_vertex *vertex, weft_rgb throughput,
                       bool roughly, float (*radiance)[3])
{
    uint8_t found[WEFT_ILLUMINATION_MAX_LIGHTS];
    const uint8_t *lit = found;
    if (roughly)
        lit = illumination->lit + (size_t)vertex->hit.triangle * (size_t)illumination->light_count;
    else
        find_lights(illumination, vertex->hit.at, vertex->hit.normal, found);
    for (int i = 0; i < illumination->light_count; i++)
        if (lit[i])
            add_light(illumination, vertex, i, throughput, radiance[i]);
}

/* A direction whose density is the cosine to the normal over pi. */
static weft_vec3 cosine_direction(const path_vertex *vertex, const double point[2])
{
    weft_real radius = sqrt(point[0]), angle = 2 * (weft_real)WEFT_PI * point[1];
    weft_vec3 bitangent = weft_cross(vertex->hit.normal, vertex->tangent);
    weft_vec3 flat =
        weft_add(weft_scale(vertex->tangent, radius * cos(angle)), weft_scale(bitangent, radius * sin(angle)));
    return weft_unit(weft_add(flat, weft_scale(vertex->hit.normal, sqrt(1 - point[0]))));
}

/* Moves the path to its next vertex. */
static path_end bounce(const weft_illumination *illumination, path_vertex *vertex, weft_rgb *throughput, uint64_t key,
                       uint32_t index)
{
    double point[2];
    sequence_point(key, index, point);
    weft_vec3 direction = cosine_direction(vertex, point);
    weft_rgb f = weft_fibre_brdf(&vertex->seen, direction);
    throughput->r *= f.r * (weft_real)WEFT_PI;
    throughput->g *= f.g * (weft_real)WEFT_PI;
    throughput->b *= f.b * (weft_real)WEFT_PI;
    if (!(fmax(throughput->r, fmax(throughput->g, throughput->b)) > NEGLIGIBLE))
        return PATH_LOST;
    weft_vec3 from = above(ray_scene_mesh(illumination->scene), vertex->hit.at, vertex->hit.normal);
    return find_vertex(illumination, from, direction, vertex);
}

/* The point on the view ray just above the cloth. */
static weft_vec3 ray_start(const weft_illumination *illumination, weft_vec3 place, weft_vec3 view)
{
    const weft_tile_mesh *mesh = ray_scene_mesh(illumination->scene);
    weft_real rise = (weft_real)mesh->top + (weft_real)mesh->cell / 2 - place.z;
    return weft_add(place, weft_scale(view, rise / view.z));
}

static void add_uniform_light(const weft_illumination *illumination, weft_rgb throughput, float (*radiance)[3])
{
    if (!illumination->options.uniform_light)
        return;
    float *sum = radiance[illumination->light_count];
    sum[0] += (float)throughput.r;
    sum[1] += (float)throughput.g;
    sum[2] += (float)throughput.b;
}

/* All vertices of a path after its first. The uniform light is met one ray after the last bounce. */
static void follow(const weft_illumination *illumination, path_vertex *vertex, uint64_t key, uint32_t index,
                   float (*radiance)[3])
{
    weft_rgb throughput = {1, 1, 1};
    int rays = illumination->options.bounces + illumination->options.uniform_light;
    for (int i = 0; i < rays; i++) {
        path_end end = bounce(illumination, vertex, &throughput, sequence_key(key, (uint64_t)i), index);
        if (end == PATH_LEFT)
            add_uniform_light(illumination, throughput, radiance);
        if (end != PATH_GOES_ON)
            return;
        if (i < illumination->options.bounces)
            add_lights(illumination, vertex, throughput, illumination->lit != NULL, radiance);
    }
}

bool weft_illumination_path(const weft_illumination *illumination, weft_vec3 place, weft_vec3 view, uint64_t key,
                            uint32_t index, float (*radiance)[3], weft_first_hit *first)
{
    path_vertex vertex;
    weft_vec3 start = ray_start(illumination, place, view);
    if (find_vertex(illumination, start, weft_scale(view, -1), &vertex) != PATH_GOES_ON)
        return false;
    if (first) {
        const weft_tile_mesh *mesh = ray_scene_mesh(illumination->scene);
        *first = (weft_first_hit){vertex.hit.at, weft_unit(interpolate(mesh, &vertex.hit, mesh->normal)),
                                  vertex.tangent, yarn_at(mesh, &vertex.hit)};
    }
    add_lights(illumination, &vertex, (weft_rgb){1, 1, 1}, false, radiance);
    follow(illumination, &vertex, key, index, radiance);
    return true;
}

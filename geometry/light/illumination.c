#include "geometry/light/illumination.h"

#include "geometry/light/light_path.h"
#include "geometry/light/sample_sequence.h"

#include <stdlib.h>
#include <string.h>

struct weft_illumination {
    weft_path_scene paths;
    weft_illumination_options options;
    int light_count;
    weft_vec3 *light;
    /* [triangle_count][light_count] 1 where the middle of a triangle sees a light; NULL when not needed. */
    uint8_t *lit;
};

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
    weft_vec3 from = weft_path_above(&illumination->paths, at, normal);
    weft_ray_scene_lit(illumination->paths.rays, from, illumination->light, illumination->light_count, wanted, lit);
}

static weft_code find_visibility(weft_illumination *illumination, weft_error *error)
{
    const weft_tile_mesh *mesh = weft_ray_scene_mesh(illumination->paths.rays);
    size_t lights = (size_t)illumination->light_count, size = lights * (size_t)mesh->triangle_count;
    illumination->lit = malloc(size);
    if (!illumination->lit)
        return weft_fail_memory(error, "visibility of the lights", size);
#pragma omp parallel for schedule(dynamic, 64)
    for (int i = 0; i < mesh->triangle_count; i++) {
        weft_ray_hit middle = weft_ray_scene_middle(illumination->paths.rays, i);
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
    WEFT_TRY(weft_ray_scene_create(mesh, &illumination->paths.rays, error));
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
    illumination->paths.stitch = stitch;
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
    weft_ray_scene_free(illumination->paths.rays);
    free(illumination->light);
    free(illumination->lit);
    free(illumination);
}

static void add_light(const weft_illumination *illumination, const weft_path_vertex *vertex, int light,
                      weft_rgb throughput, float radiance[3])
{
    weft_vec3 direction = illumination->light[light];
    weft_rgb f = weft_fibre_brdf(&vertex->seen, direction);
    weft_real arriving = (weft_real)WEFT_PI * weft_dot(vertex->hit.normal, direction);
    radiance[0] += (float)(throughput.r * f.r * arriving);
    radiance[1] += (float)(throughput.g * f.g * arriving);
    radiance[2] += (float)(throughput.b * f.b * arriving);
}

/* Light straight from the lights: by shadow rays, or `roughly`, by what the middle of the triangle sees. */
static void add_lights(const weft_illumination *illumination, const weft_path_vertex *vertex, weft_rgb throughput,
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
static void follow(const weft_illumination *illumination, weft_path_vertex *vertex, uint64_t key, uint32_t index,
                   float (*radiance)[3])
{
    weft_rgb throughput = {1, 1, 1};
    int rays = illumination->options.bounces + illumination->options.uniform_light;
    for (int i = 0; i < rays; i++) {
        weft_path_end end =
            weft_path_bounce(&illumination->paths, vertex, &throughput, weft_sequence_key(key, (uint64_t)i), index);
        if (end == WEFT_PATH_LEFT)
            add_uniform_light(illumination, throughput, radiance);
        if (end != WEFT_PATH_GOES_ON)
            return;
        if (i < illumination->options.bounces)
            add_lights(illumination, vertex, throughput, illumination->lit != NULL, radiance);
    }
}

bool weft_illumination_path(const weft_illumination *illumination, weft_vec3 place, weft_vec3 view, uint64_t key,
                            uint32_t index, float (*radiance)[3], weft_first_hit *first)
{
    weft_path_vertex vertex;
    if (!weft_path_begin(&illumination->paths, place, view, &vertex))
        return false;
    if (first)
        *first = (weft_first_hit){vertex.hit.at, weft_path_surface_normal(&illumination->paths, &vertex),
                                  vertex.tangent, vertex.yarn};
    add_lights(illumination, &vertex, (weft_rgb){1, 1, 1}, false, radiance);
    follow(illumination, &vertex, key, index, radiance);
    return true;
}

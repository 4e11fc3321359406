#include "geometry/light/stitch_sample.h"

#include "geometry/light/light_path.h"
#include "geometry/light/sample_sequence.h"

#include <stdlib.h>

struct weft_stitch_sample {
    weft_stitch stitch;
    weft_tile_mesh mesh;
    weft_path_scene paths;
    int bounces;
};

static weft_code prepare(weft_stitch_sample *sample, const char *path, weft_error *error)
{
    WEFT_TRY(weft_stitch_read(path, &sample->stitch, error));
    WEFT_TRY(weft_tile_mesh_create(&sample->stitch, 0, path, &sample->mesh, error));
    sample->paths.stitch = &sample->stitch;
    return weft_ray_scene_create(&sample->mesh, &sample->paths.rays, error);
}

weft_code weft_stitch_sample_read(const char *path, int bounces, weft_stitch_sample **result, weft_error *error)
{
    *result = NULL;
    weft_stitch_sample *sample = calloc(1, sizeof *sample);
    if (!sample)
        return weft_fail_memory(error, "sample", sizeof *sample);
    sample->bounces = bounces < WEFT_STITCH_SAMPLE_MAX_BOUNCES ? bounces : WEFT_STITCH_SAMPLE_MAX_BOUNCES;
    weft_code code = prepare(sample, path, error);
    if (code == WEFT_OK)
        *result = sample;
    else
        weft_stitch_sample_free(sample);
    return code;
}

void weft_stitch_sample_free(weft_stitch_sample *sample)
{
    if (!sample)
        return;
    weft_ray_scene_free(sample->paths.rays);
    weft_tile_mesh_free(&sample->mesh);
    weft_stitch_free(&sample->stitch);
    free(sample);
}

const weft_stitch *weft_stitch_sample_stitch(const weft_stitch_sample *sample)
{
    return &sample->stitch;
}

int weft_stitch_sample_bounces(const weft_stitch_sample *sample)
{
    return sample->bounces;
}

static void put_vector(weft_vec3 from, float to[3])
{
    to[0] = (float)from.x;
    to[1] = (float)from.y;
    to[2] = (float)from.z;
}

static weft_vec3 vector_of(const float from[3])
{
    return weft_vec3_of((weft_real)from[0], (weft_real)from[1], (weft_real)from[2]);
}

static void keep(const weft_stitch_sample *sample, const weft_path_vertex *vertex, weft_rgb throughput,
                 weft_seen_vertex *kept)
{
    const weft_fibre_view *seen = &vertex->seen;
    weft_vec3 along = weft_scale(seen->along, seen->view.x), across = weft_scale(seen->across, seen->view.y);
    weft_vec3 below_plane =
        weft_vec3_of(vertex->hit.at.x, vertex->hit.at.y, vertex->hit.at.z - (weft_real)sample->mesh.top);
    put_vector(below_plane, kept->at);
    put_vector(vertex->hit.normal, kept->normal);
    put_vector(vertex->tangent, kept->tangent);
    put_vector(weft_add(weft_add(along, across), weft_scale(seen->out, seen->view.z)), kept->view);
    put_vector(weft_vec3_of(throughput.r, throughput.g, throughput.b), kept->throughput);
    kept->yarn = vertex->yarn;
}

int weft_stitch_sample_see(const weft_stitch_sample *sample, weft_real x_mm, weft_real y_mm, weft_vec3 view,
                           uint64_t key, uint32_t index, weft_seen_vertex *vertex)
{
    weft_path_vertex now;
    weft_rgb throughput = {1, 1, 1};
    int count = 0;
    if (!weft_path_begin(&sample->paths, weft_vec3_of(x_mm, y_mm, (weft_real)sample->mesh.top), view, &now))
        return 0;
    keep(sample, &now, throughput, &vertex[count++]);
    while (count <= sample->bounces &&
           weft_path_bounce(&sample->paths, &now, &throughput, weft_sequence_key(key, (uint64_t)count), index) ==
               WEFT_PATH_GOES_ON)
        keep(sample, &now, throughput, &vertex[count++]);
    return count;
}

static bool is_lit(const weft_stitch_sample *sample, const weft_seen_vertex *vertex, weft_vec3 normal, weft_vec3 light)
{
    const uint8_t wanted = 1;
    uint8_t lit;
    weft_vec3 at = vector_of(vertex->at);
    at.z += (weft_real)sample->mesh.top;
    weft_ray_scene_lit(sample->paths.rays, weft_path_above(&sample->paths, at, normal), &light, 1, &wanted, &lit);
    return lit;
}

weft_rgb weft_stitch_sample_light(const weft_stitch_sample *sample, const weft_seen_vertex *vertex, int count,
                                  weft_vec3 light)
{
    weft_rgb sum = {0, 0, 0};
    for (int i = 0; i < count; i++) {
        const weft_seen_vertex *v = &vertex[i];
        weft_vec3 normal = vector_of(v->normal);
        weft_real arriving = (weft_real)WEFT_PI * weft_dot(normal, light);
        if (!(arriving > 0) || !is_lit(sample, v, normal, light))
            continue;
        weft_fibre_view seen = weft_fibre_seen_from(&sample->stitch.yarn[v->yarn].fibre, vector_of(v->tangent), normal,
                                                    vector_of(v->view));
        weft_rgb f = weft_fibre_brdf(&seen, light);
        sum.r += (weft_real)v->throughput[0] * f.r * arriving;
        sum.g += (weft_real)v->throughput[1] * f.g * arriving;
        sum.b += (weft_real)v->throughput[2] * f.b * arriving;
    }
    return sum;
}

#include "geometry/drape/draped_cloth.h"

#include "btf/direction/frame.h"
#include "geometry/light/light_path.h"
#include "geometry/light/sample_sequence.h"
#include "geometry/yarn/fibre.h"

#include <embree3/rtcore.h>
#include <stdlib.h>
#include <string.h>

struct weft_draped_cloth {
    const weft_stitch *stitch;
    const weft_tile_mesh *mesh;
    int vertex_count, triangle_count;
    float (*position)[3], (*tangent)[3]; /* [vertex_count + 1]: Embree reads 16 bytes at a time */
    uint32_t (*triangle)[3];
    RTCDevice device;
    RTCScene rays;
};

/* Tiles that the flat cloth may touch. */
typedef struct tile_range {
    int left, bottom, columns, rows;
} tile_range;

static weft_code find_tiles(const weft_tile_mesh *mesh, const weft_base_map *map, tile_range *tiles, weft_error *error)
{
    weft_real width = (weft_real)mesh->width, height = (weft_real)mesh->height, slack = (weft_real)1e-6;
    weft_real left = floor(map->low_x / width + slack), right = ceil(map->high_x / width - slack);
    weft_real bottom = floor(map->low_y / height + slack), top = ceil(map->high_y / height - slack);
    weft_real count = (right - left) * (top - bottom);
    if (!(count * (weft_real)mesh->triangle_count <= (weft_real)WEFT_DRAPED_MAX_TRIANGLES))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "%.0f tiles of %d triangles are more than the %d triangles there may be", (double)count,
                         mesh->triangle_count, WEFT_DRAPED_MAX_TRIANGLES);
    *tiles = (tile_range){(int)left, (int)bottom, (int)(right - left), (int)(top - bottom)};
    return WEFT_OK;
}

static void store(weft_vec3 from, float to[3])
{
    to[0] = (float)from.x;
    to[1] = (float)from.y;
    to[2] = (float)from.z;
}

/* Lays one vertex of a tile over the surface; false beyond its hem. */
static bool lay_vertex(weft_draped_cloth *cloth, const weft_base_map *map, int tile_x, int tile_y, int from, int to)
{
    const weft_tile_mesh *mesh = cloth->mesh;
    const float *p = mesh->position[from], *t = mesh->tangent[from];
    weft_base_place place;
    if (!weft_base_map_find(map, (weft_real)tile_x * (weft_real)mesh->width + (weft_real)p[0],
                            (weft_real)tile_y * (weft_real)mesh->height + (weft_real)p[1], &place))
        return false;
    weft_vec3 fibre = weft_add(weft_scale(place.along_x, (weft_real)t[0]), weft_scale(place.along_y, (weft_real)t[1]));
    fibre = weft_unit(weft_add(fibre, weft_scale(place.normal, (weft_real)t[2])));
    store(weft_add(place.at, weft_scale(place.normal, (weft_real)(p[2] - mesh->top) - map->surface->plane_mm)),
          cloth->position[to]);
    store(fibre, cloth->tangent[to]);
    return true;
}

/* Lays one tile; `is_on` [mesh->vertex_count] is scratch. */
static void lay_tile(weft_draped_cloth *cloth, const weft_base_map *map, int tile_x, int tile_y, bool *is_on)
{
    const weft_tile_mesh *mesh = cloth->mesh;
    int first = cloth->vertex_count;
    for (int i = 0; i < mesh->vertex_count; i++)
        is_on[i] = lay_vertex(cloth, map, tile_x, tile_y, i, first + i);
    cloth->vertex_count += mesh->vertex_count;
    for (int i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *corner = mesh->triangle[i];
        if (!is_on[corner[0]] || !is_on[corner[1]] || !is_on[corner[2]])
            continue;
        for (int k = 0; k < 3; k++)
            cloth->triangle[cloth->triangle_count][k] = (uint32_t)first + corner[k];
        cloth->triangle_count++;
    }
}

static weft_code allocate(weft_draped_cloth *cloth, size_t tiles, weft_error *error)
{
    size_t vertices = tiles * (size_t)cloth->mesh->vertex_count + 1;
    size_t triangles = tiles * (size_t)cloth->mesh->triangle_count;
    cloth->position = calloc(vertices, sizeof *cloth->position);
    cloth->tangent = calloc(vertices, sizeof *cloth->tangent);
    cloth->triangle = malloc(triangles * sizeof *cloth->triangle);
    if (cloth->position && cloth->tangent && cloth->triangle)
        return WEFT_OK;
    return weft_fail_memory(error, "draped cloth", (2 * vertices + triangles) * sizeof *cloth->position);
}

static weft_code lay_tiles(weft_draped_cloth *cloth, const weft_base_map *map, weft_error *error)
{
    tile_range tiles;
    WEFT_TRY(find_tiles(cloth->mesh, map, &tiles, error));
    WEFT_TRY(allocate(cloth, (size_t)tiles.columns * (size_t)tiles.rows, error));
    bool *is_on = malloc((size_t)cloth->mesh->vertex_count * sizeof *is_on);
    if (!is_on)
        return weft_fail_memory(error, "vertices of a tile", (size_t)cloth->mesh->vertex_count * sizeof *is_on);
    for (int row = 0; row < tiles.rows; row++)
        for (int column = 0; column < tiles.columns; column++)
            lay_tile(cloth, map, tiles.left + column, tiles.bottom + row, is_on);
    free(is_on);
    return WEFT_OK;
}

/* Embree reads the arrays of the cloth where they are. */
static weft_code build_tree(weft_draped_cloth *cloth, weft_error *error)
{
    /* One thread, so that the tree, and which of two triangles a ray through their edge meets, is always the same. */
    cloth->device = rtcNewDevice("threads=1");
    RTCGeometry geometry = cloth->device ? rtcNewGeometry(cloth->device, RTC_GEOMETRY_TYPE_TRIANGLE) : NULL;
    cloth->rays = cloth->device ? rtcNewScene(cloth->device) : NULL;
    if (!geometry || !cloth->rays) {
        rtcReleaseGeometry(geometry);
        return weft_fail(error, WEFT_SYSTEM, "Embree cannot start (its error %d)",
                         (int)rtcGetDeviceError(cloth->device));
    }
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, cloth->position, 0,
                               sizeof *cloth->position, (size_t)cloth->vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, cloth->triangle, 0,
                               sizeof *cloth->triangle, (size_t)cloth->triangle_count);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(cloth->rays, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(cloth->rays, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    rtcCommitScene(cloth->rays);
    enum RTCError code = rtcGetDeviceError(cloth->device);
    return code == RTC_ERROR_NONE ? WEFT_OK
                                  : weft_fail(error, WEFT_SYSTEM,
                                              "Embree cannot build its tree of %d triangles (its "
                                              "error %d)",
                                              cloth->triangle_count, (int)code);
}

weft_code weft_draped_cloth_create(const weft_stitch *stitch, const weft_tile_mesh *mesh,
                                   const weft_base_surface *surface, weft_draped_cloth **result, weft_error *error)
{
    weft_base_map map;
    *result = NULL;
    WEFT_TRY(weft_base_map_create(surface, &map, error));
    weft_draped_cloth *cloth = calloc(1, sizeof *cloth);
    weft_code code = cloth ? WEFT_OK : weft_fail_memory(error, "draped cloth", sizeof *cloth);
    if (code == WEFT_OK) {
        cloth->stitch = stitch;
        cloth->mesh = mesh;
        code = lay_tiles(cloth, &map, error);
    }
    weft_base_map_free(&map);
    if (code == WEFT_OK)
        code = build_tree(cloth, error);
    if (code == WEFT_OK)
        *result = cloth;
    else
        weft_draped_cloth_free(cloth);
    return code;
}

void weft_draped_cloth_free(weft_draped_cloth *cloth)
{
    if (!cloth)
        return;
    if (cloth->rays)
        rtcReleaseScene(cloth->rays);
    if (cloth->device)
        rtcReleaseDevice(cloth->device);
    free(cloth->position);
    free(cloth->tangent);
    free(cloth->triangle);
    free(cloth);
}

int weft_draped_cloth_triangle_count(const weft_draped_cloth *cloth)
{
    return cloth->triangle_count;
}

/* ---- Rays ---- */

/* Where a ray met the cloth. Lengths in mm. */
typedef struct draped_hit {
    weft_vec3 at, normal, tangent; /* normal of the triangle, outward; direction of the fibres across it; unit */
    int yarn;
    weft_real distance; /* along the ray */
} draped_hit;

static bool find_nearest(const weft_draped_cloth *cloth, weft_vec3 origin, weft_vec3 direction, struct RTCRayHit *found)
{
    struct RTCIntersectContext context;
    *found = (struct RTCRayHit){.ray = {.org_x = (float)origin.x,
                                        .org_y = (float)origin.y,
                                        .org_z = (float)origin.z,
                                        .dir_x = (float)direction.x,
                                        .dir_y = (float)direction.y,
                                        .dir_z = (float)direction.z,
                                        .tfar = INFINITY,
                                        .mask = UINT32_MAX},
                                .hit.geomID = RTC_INVALID_GEOMETRY_ID};
    rtcInitIntersectContext(&context);
    rtcIntersect1(cloth->rays, &context, found);
    return found->hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

static weft_vec3 vector_of(const float from[3])
{
    return weft_vec3_of((weft_real)from[0], (weft_real)from[1], (weft_real)from[2]);
}

/* The nearest triangle along a unit direction, from the inside, too; false where there is none. */
static bool trace(const weft_draped_cloth *cloth, weft_vec3 origin, weft_vec3 direction, draped_hit *hit)
{
    struct RTCRayHit found;
    if (!find_nearest(cloth, origin, direction, &found))
        return false;
    const uint32_t *corner = cloth->triangle[found.hit.primID];
    weft_real u = (weft_real)found.hit.u, v = (weft_real)found.hit.v;
    const weft_real weight[3] = {1 - u - v, u, v};
    weft_vec3 place[3], tangent = {0};
    int nearest = 0;
    *hit = (draped_hit){.distance = (weft_real)found.ray.tfar};
    for (int i = 0; i < 3; i++) {
        place[i] = vector_of(cloth->position[corner[i]]);
        hit->at = weft_add(hit->at, weft_scale(place[i], weight[i]));
        tangent = weft_add(tangent, weft_scale(vector_of(cloth->tangent[corner[i]]), weight[i]));
        nearest = weight[i] > weight[nearest] ? i : nearest;
    }
    hit->normal = weft_unit(weft_cross(weft_subtract(place[1], place[0]), weft_subtract(place[2], place[0])));
    hit->tangent = weft_frame_of_vectors(hit->normal, tangent).tangent;
    hit->yarn = cloth->mesh->yarn[corner[nearest] % (uint32_t)cloth->mesh->vertex_count];
    return true;
}

/* How far it is to the nearest triangle; INFINITY where there is none. */
static weft_real distance_to(const weft_draped_cloth *cloth, weft_vec3 origin, weft_vec3 direction)
{
    struct RTCRayHit found;
    return find_nearest(cloth, origin, direction, &found) ? (weft_real)found.ray.tfar : INFINITY;
}

/* ---- Paths ---- */

/* A vertex of a path and what reached it of the light that leaves by the camera's ray. */
typedef struct draped_vertex {
    draped_hit hit;
    weft_fibre_view seen;
    weft_rgb throughput;
    bool is_near; /* all rays so far were within reach */
} draped_vertex;

/* Next vertex along a ray; false where there is none or a yarn is seen from inside. */
static bool find_vertex(const weft_draped_cloth *cloth, weft_vec3 from, weft_vec3 direction, draped_vertex *vertex)
{
    if (!trace(cloth, from, direction, &vertex->hit) || weft_dot(vertex->hit.normal, direction) >= 0)
        return false;
    const weft_fibre *fibre = &cloth->stitch->yarn[vertex->hit.yarn].fibre;
    vertex->seen = weft_fibre_seen_from(fibre, vertex->hit.tangent, vertex->hit.normal, weft_scale(direction, -1));
    return true;
}

static weft_vec3 above(const weft_draped_cloth *cloth, const draped_hit *hit)
{
    return weft_path_ray_start(cloth->mesh, hit->at, hit->normal);
}

static void add_light(const weft_draped_cloth *cloth, const draped_vertex *vertex, const weft_draped_light *light,
                      weft_draped_radiance *radiance)
{
    weft_real cosine = weft_dot(vertex->hit.normal, light->direction);
    if (!(cosine > 0))
        return;
    weft_real obstacle = distance_to(cloth, above(cloth, &vertex->hit), light->direction);
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
        return !isinf(distance_to(cloth, origin, direction));
    add_light(cloth, &vertex, light, radiance);
    for (int i = 0; i < light->bounces; i++) {
        if (!bounce(cloth, &vertex, light->reach_mm, weft_sequence_key(key, (uint64_t)i), index))
            break;
        add_light(cloth, &vertex, light, radiance);
    }
    return true;
}

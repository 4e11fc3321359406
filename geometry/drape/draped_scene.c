#include "geometry/drape/draped_scene.h"

#include "btf/direction/frame.h"

#include <embree3/rtcore.h>
#include <stdlib.h>
#include <string.h>

struct weft_draped_scene {
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

static weft_code find_tiles(const weft_tile_mesh *mesh, const weft_base_map *map, int most, tile_range *tiles,
                            weft_error *error)
{
    weft_real width = (weft_real)mesh->width, height = (weft_real)mesh->height, slack = (weft_real)1e-6;
    weft_real left = floor(map->low_x / width + slack), right = ceil(map->high_x / width - slack);
    weft_real bottom = floor(map->low_y / height + slack), top = ceil(map->high_y / height - slack);
    weft_real count = (right - left) * (top - bottom);
    if (!(count * (weft_real)mesh->triangle_count <= (weft_real)most))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "%.0f tiles of %d triangles are more than the %d triangles there may be", (double)count,
                         mesh->triangle_count, most);
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
static bool lay_vertex(weft_draped_scene *scene, const weft_base_map *map, int tile_x, int tile_y, int from, int to)
{
    const weft_tile_mesh *mesh = scene->mesh;
    const float *p = mesh->position[from], *t = mesh->tangent[from];
    weft_base_place place;
    if (!weft_base_map_find(map, (weft_real)tile_x * (weft_real)mesh->width + (weft_real)p[0],
                            (weft_real)tile_y * (weft_real)mesh->height + (weft_real)p[1], &place))
        return false;
    weft_vec3 fibre = weft_add(weft_scale(place.along_x, (weft_real)t[0]), weft_scale(place.along_y, (weft_real)t[1]));
    fibre = weft_unit(weft_add(fibre, weft_scale(place.normal, (weft_real)t[2])));
    store(weft_add(place.at, weft_scale(place.normal, (weft_real)(p[2] - mesh->top) - map->surface->plane_mm)),
          scene->position[to]);
    store(fibre, scene->tangent[to]);
    return true;
}

/* Lays one tile; `is_on` [mesh->vertex_count] is scratch. */
static void lay_tile(weft_draped_scene *scene, const weft_base_map *map, int tile_x, int tile_y, bool *is_on)
{
    const weft_tile_mesh *mesh = scene->mesh;
    int first = scene->vertex_count;
    for (int i = 0; i < mesh->vertex_count; i++)
        is_on[i] = lay_vertex(scene, map, tile_x, tile_y, i, first + i);
    scene->vertex_count += mesh->vertex_count;
    for (int i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *corner = mesh->triangle[i];
        if (!is_on[corner[0]] || !is_on[corner[1]] || !is_on[corner[2]])
            continue;
        for (int k = 0; k < 3; k++)
            scene->triangle[scene->triangle_count][k] = (uint32_t)first + corner[k];
        scene->triangle_count++;
    }
}

static weft_code allocate(weft_draped_scene *scene, size_t tiles, weft_error *error)
{
    size_t vertices = tiles * (size_t)scene->mesh->vertex_count + 1;
    size_t triangles = tiles * (size_t)scene->mesh->triangle_count;
    scene->position = calloc(vertices, sizeof *scene->position);
    scene->tangent = calloc(vertices, sizeof *scene->tangent);
    scene->triangle = malloc(triangles * sizeof *scene->triangle);
    if (scene->position && scene->tangent && scene->triangle)
        return WEFT_OK;
    return weft_fail_memory(error, "draped cloth", (2 * vertices + triangles) * sizeof *scene->position);
}

static weft_code lay_tiles(weft_draped_scene *scene, const weft_base_map *map, int most, weft_error *error)
{
    tile_range tiles;
    WEFT_TRY(find_tiles(scene->mesh, map, most, &tiles, error));
    WEFT_TRY(allocate(scene, (size_t)tiles.columns * (size_t)tiles.rows, error));
    bool *is_on = malloc((size_t)scene->mesh->vertex_count * sizeof *is_on);
    if (!is_on)
        return weft_fail_memory(error, "vertices of a tile", (size_t)scene->mesh->vertex_count * sizeof *is_on);
    for (int row = 0; row < tiles.rows; row++)
        for (int column = 0; column < tiles.columns; column++)
            lay_tile(scene, map, tiles.left + column, tiles.bottom + row, is_on);
    free(is_on);
    return WEFT_OK;
}

/* Embree reads the arrays of the scene where they are. */
static weft_code build_tree(weft_draped_scene *scene, weft_error *error)
{
    /* One thread, so that the tree, and which of two triangles a ray through their edge meets, is always the same. */
    scene->device = rtcNewDevice("threads=1");
    RTCGeometry geometry = scene->device ? rtcNewGeometry(scene->device, RTC_GEOMETRY_TYPE_TRIANGLE) : NULL;
    scene->rays = scene->device ? rtcNewScene(scene->device) : NULL;
    if (!geometry || !scene->rays) {
        rtcReleaseGeometry(geometry);
        return weft_fail(error, WEFT_SYSTEM, "Embree cannot start (its error %d)",
                         (int)rtcGetDeviceError(scene->device));
    }
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, scene->position, 0,
                               sizeof *scene->position, (size_t)scene->vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, scene->triangle, 0,
                               sizeof *scene->triangle, (size_t)scene->triangle_count);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene->rays, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene->rays, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    rtcCommitScene(scene->rays);
    enum RTCError code = rtcGetDeviceError(scene->device);
    return code == RTC_ERROR_NONE ? WEFT_OK
                                  : weft_fail(error, WEFT_SYSTEM,
                                              "Embree cannot build its tree of %d triangles (its "
                                              "error %d)",
                                              scene->triangle_count, (int)code);
}

weft_code weft_draped_scene_create(const weft_tile_mesh *mesh, const weft_base_surface *surface, int most,
                                   weft_draped_scene **result, weft_error *error)
{
    weft_base_map map;
    *result = NULL;
    WEFT_TRY(weft_base_map_create(surface, &map, error));
    weft_draped_scene *scene = calloc(1, sizeof *scene);
    weft_code code = scene ? WEFT_OK : weft_fail_memory(error, "draped cloth", sizeof *scene);
    if (code == WEFT_OK) {
        scene->mesh = mesh;
        code = lay_tiles(scene, &map, most, error);
    }
    weft_base_map_free(&map);
    if (code == WEFT_OK)
        code = build_tree(scene, error);
    if (code == WEFT_OK)
        *result = scene;
    else
        weft_draped_scene_free(scene);
    return code;
}

void weft_draped_scene_free(weft_draped_scene *scene)
{
    if (!scene)
        return;
    if (scene->rays)
        rtcReleaseScene(scene->rays);
    if (scene->device)
        rtcReleaseDevice(scene->device);
    free(scene->position);
    free(scene->tangent);
    free(scene->triangle);
    free(scene);
}

int weft_draped_scene_triangle_count(const weft_draped_scene *scene)
{
    return scene->triangle_count;
}

/* ---- Rays ---- */

static bool find_nearest(const weft_draped_scene *scene, weft_vec3 origin, weft_vec3 direction, struct RTCRayHit *found)
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
    rtcIntersect1(scene->rays, &context, found);
    return found->hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

static weft_vec3 vector_of(const float from[3])
{
    return weft_vec3_of((weft_real)from[0], (weft_real)from[1], (weft_real)from[2]);
}

bool weft_draped_scene_trace(const weft_draped_scene *scene, weft_vec3 origin, weft_vec3 direction,
                             weft_draped_hit *hit)
{
    struct RTCRayHit found;
    if (!find_nearest(scene, origin, direction, &found))
        return false;
    const uint32_t *corner = scene->triangle[found.hit.primID];
    weft_real u = (weft_real)found.hit.u, v = (weft_real)found.hit.v;
    const weft_real weight[3] = {1 - u - v, u, v};
    weft_vec3 place[3], tangent = {0};
    int nearest = 0;
    *hit = (weft_draped_hit){.distance = (weft_real)found.ray.tfar};
    for (int i = 0; i < 3; i++) {
        place[i] = vector_of(scene->position[corner[i]]);
        hit->at = weft_add(hit->at, weft_scale(place[i], weight[i]));
        tangent = weft_add(tangent, weft_scale(vector_of(scene->tangent[corner[i]]), weight[i]));
        nearest = weight[i] > weight[nearest] ? i : nearest;
    }
    hit->normal = weft_unit(weft_cross(weft_subtract(place[1], place[0]), weft_subtract(place[2], place[0])));
    hit->tangent = weft_frame_of_vectors(hit->normal, tangent).tangent;
    hit->yarn = scene->mesh->yarn[corner[nearest] % (uint32_t)scene->mesh->vertex_count];
    return true;
}

weft_real weft_draped_scene_distance(const weft_draped_scene *scene, weft_vec3 origin, weft_vec3 direction)
{
    struct RTCRayHit found;
    return find_nearest(scene, origin, direction, &found) ? (weft_real)found.ray.tfar : INFINITY;
}

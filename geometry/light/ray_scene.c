#include "geometry/light/ray_scene.h"

#include <embree3/rtcore.h>
#include <stdlib.h>

enum {
    RING = 1,        /* tiles instanced on each side of the middle one */
    MAX_BLOCKS = 64, /* a ray that stays in the cloth for longer runs on between the yarns: it has left */
    PACKET = 16
};

struct weft_ray_scene {
    const weft_tile_mesh *mesh;
    RTCDevice device;
    RTCScene tile, block;
    weft_real low, high; /* z beyond which there is no cloth */
};

static weft_code embree_failure(RTCDevice device, const char *what, weft_error *error)
{
    enum RTCError code = rtcGetDeviceError(device);
    return weft_fail(error, WEFT_SYSTEM, "Embree cannot %s (its error %d)", what, (int)code);
}

/* The triangles of one tile, shared with the mesh. */
static weft_code build_tile(weft_ray_scene *scene, weft_error *error)
{
    const weft_tile_mesh *mesh = scene->mesh;
    RTCGeometry geometry = rtcNewGeometry(scene->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *position = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                              (size_t)mesh->vertex_count);
    uint32_t *triangle = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                 3 * sizeof(uint32_t), (size_t)mesh->triangle_count);
    scene->tile = rtcNewScene(scene->device);
    if (!position || !triangle || !scene->tile) {
        rtcReleaseGeometry(geometry);
        return embree_failure(scene->device, "hold the triangles", error);
    }
    for (int i = 0; i < 3 * mesh->vertex_count; i++)
        position[i] = mesh->position[i / 3][i % 3];
    for (int i = 0; i < 3 * mesh->triangle_count; i++)
        triangle[i] = mesh->triangle[i / 3][i % 3];
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene->tile, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene->tile, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene->tile);
    return WEFT_OK;
}

static weft_code add_instance(weft_ray_scene *scene, int tile_x, int tile_y, weft_error *error)
{
    RTCGeometry instance = rtcNewGeometry(scene->device, RTC_GEOMETRY_TYPE_INSTANCE);
    if (!instance)
        return embree_failure(scene->device, "repeat the tile", error);
    const float transform[12] = {
        1, 0, 0, 0, 1, 0, 0, 0, 1, (float)tile_x * scene->mesh->width, (float)tile_y * scene->mesh->height, 0};
    rtcSetGeometryInstancedScene(instance, scene->tile);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform);
    rtcCommitGeometry(instance);
    rtcAttachGeometry(scene->block, instance);
    rtcReleaseGeometry(instance);
    return WEFT_OK;
}

static weft_code build_block(weft_ray_scene *scene, weft_error *error)
{
    scene->block = rtcNewScene(scene->device);
    if (!scene->block)
        return embree_failure(scene->device, "make a scene", error);
    for (int y = -RING; y <= RING; y++)
        for (int x = -RING; x <= RING; x++)
            WEFT_TRY(add_instance(scene, x, y, error));
    rtcSetSceneFlags(scene->block, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene->block);
    if (rtcGetDeviceError(scene->device) != RTC_ERROR_NONE)
        return weft_fail(error, WEFT_SYSTEM, "Embree cannot build its tree of %d triangles",
                         scene->mesh->triangle_count);
    return WEFT_OK;
}

weft_code weft_ray_scene_create(const weft_tile_mesh *mesh, weft_ray_scene **result, weft_error *error)
{
    weft_ray_scene *scene = calloc(1, sizeof *scene);
    *result = NULL;
    if (!scene)
        return weft_fail_memory(error, "scene", sizeof *scene);
    scene->mesh = mesh;
    scene->low = (weft_real)mesh->bottom - (weft_real)mesh->cell;
    scene->high = (weft_real)mesh->top + (weft_real)mesh->cell;
    /* One thread: threads of the caller trace, and a tree of one tile is built in no time. */
    scene->device = rtcNewDevice("threads=1");
    weft_code code = scene->device ? build_tile(scene, error) : embree_failure(NULL, "start", error);
    if (code == WEFT_OK)
        code = build_block(scene, error);
    if (code != WEFT_OK) {
        weft_ray_scene_free(scene);
        return code;
    }
    *result = scene;
    return WEFT_OK;
}

void weft_ray_scene_free(weft_ray_scene *scene)
{
    if (!scene)
        return;
    if (scene->block)
        rtcReleaseScene(scene->block);
    if (scene->tile)
        rtcReleaseScene(scene->tile);
    if (scene->device)
        rtcReleaseDevice(scene->device);
    free(scene);
}

const weft_tile_mesh *weft_ray_scene_mesh(const weft_ray_scene *scene)
{
    return scene->mesh;
}

static weft_real wrap(weft_real x, weft_real period)
{
    return x - period * floor(x / period);
}

static weft_vec3 wrap_place(const weft_ray_scene *scene, weft_vec3 place)
{
    return weft_vec3_of(wrap(place.x, (weft_real)scene->mesh->width), wrap(place.y, (weft_real)scene->mesh->height),
                        place.z);
}

/* How far a ray from the middle tile may go along one axis before it leaves the block. */
static weft_real block_exit(weft_real from, weft_real direction, weft_real tile)
{
    if (direction == 0)
        return INFINITY;
    return ((direction > 0 ? (1 + RING) * tile : -RING * tile) - from) / direction;
}

/* How far to follow a ray from the middle tile; *leaves where it is out of the cloth after that. */
static weft_real reach(const weft_ray_scene *scene, weft_vec3 origin, weft_vec3 direction, bool *leaves)
{
    weft_real sideways = fmin(block_exit(origin.x, direction.x, (weft_real)scene->mesh->width),
                              block_exit(origin.y, direction.y, (weft_real)scene->mesh->height));
    weft_real border = direction.z > 0 ? scene->high : scene->low;
    weft_real vertically = direction.z != 0 ? (border - origin.z) / direction.z : INFINITY;
    *leaves = vertically <= sideways;
    return fmax(*leaves ? vertically : sideways, 0);
}

static struct RTCRay ray_of(weft_vec3 origin, weft_vec3 direction, weft_real far)
{
    return (struct RTCRay){.org_x = (float)origin.x,
                           .org_y = (float)origin.y,
                           .org_z = (float)origin.z,
                           .dir_x = (float)direction.x,
                           .dir_y = (float)direction.y,
                           .dir_z = (float)direction.z,
                           .tfar = (float)far,
                           .mask = UINT32_MAX};
}

static weft_vec3 vertex(const weft_tile_mesh *mesh, int triangle, int corner)
{
    const float *at = mesh->position[mesh->triangle[triangle][corner]];
    return weft_vec3_of(at[0], at[1], at[2]);
}

static weft_ray_hit describe_hit(const weft_ray_scene *scene, int triangle, weft_real u, weft_real v,
                                 weft_real distance)
{
    weft_vec3 a = vertex(scene->mesh, triangle, 0), b = vertex(scene->mesh, triangle, 1);
    weft_vec3 c = vertex(scene->mesh, triangle, 2);
    weft_ray_hit hit = {.triangle = triangle, .weight = {1 - u - v, u, v}, .distance = distance};
    hit.at = weft_add(weft_scale(a, hit.weight[0]), weft_add(weft_scale(b, u), weft_scale(c, v)));
    hit.normal = weft_unit(weft_cross(weft_subtract(b, a), weft_subtract(c, a)));
    return hit;
}

weft_ray_hit weft_ray_scene_middle(const weft_ray_scene *scene, int triangle)
{
    return describe_hit(scene, triangle, (weft_real)1 / 3, (weft_real)1 / 3, 0);
}

bool weft_ray_scene_trace(const weft_ray_scene *scene, weft_vec3 origin, weft_vec3 direction, weft_ray_hit *hit)
{
    weft_real travelled = 0;
    for (int block = 0; block < MAX_BLOCKS; block++) {
        bool leaves;
        origin = wrap_place(scene, origin);
        weft_real far = reach(scene, origin, direction, &leaves);
        struct RTCRayHit found = {.ray = ray_of(origin, direction, far), .hit.geomID = RTC_INVALID_GEOMETRY_ID};
        struct RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene->block, &context, &found);
        if (found.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
            *hit = describe_hit(scene, (int)found.hit.primID, found.hit.u, found.hit.v, travelled + found.ray.tfar);
            return true;
        }
        if (leaves)
            return false;
        travelled += far;
        origin = weft_add(origin, weft_scale(direction, far));
    }
    return false;
}

/* Goes on with a shadow ray that left the block but not the cloth. */
static bool lit_further(const weft_ray_scene *scene, weft_vec3 origin, weft_vec3 direction)
{
    weft_ray_hit hit;
    return !weft_ray_scene_trace(scene, origin, direction, &hit);
}

typedef struct shadow_packet {
    struct RTCRay16 ray;
    int valid[PACKET], light[PACKET];
    weft_real far[PACKET];
    bool leaves[PACKET];
    int count;
} shadow_packet;

static void add_to_packet(const weft_ray_scene *scene, shadow_packet *packet, weft_vec3 origin, weft_vec3 direction,
                          int light)
{
    int i = packet->count++;
    packet->valid[i] = -1;
    packet->light[i] = light;
    packet->far[i] = reach(scene, origin, direction, &packet->leaves[i]);
    packet->ray.org_x[i] = (float)origin.x;
    packet->ray.org_y[i] = (float)origin.y;
    packet->ray.org_z[i] = (float)origin.z;
    packet->ray.dir_x[i] = (float)direction.x;
    packet->ray.dir_y[i] = (float)direction.y;
    packet->ray.dir_z[i] = (float)direction.z;
    packet->ray.tfar[i] = (float)packet->far[i];
    packet->ray.tnear[i] = packet->ray.time[i] = 0;
    packet->ray.mask[i] = UINT32_MAX;
    packet->ray.flags[i] = packet->ray.id[i] = 0;
}

static void trace_packet(const weft_ray_scene *scene, shadow_packet *packet, weft_vec3 origin, const weft_vec3 *light,
                         uint8_t *lit)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (int i = packet->count; i < PACKET; i++)
        packet->valid[i] = 0;
    rtcOccluded16(packet->valid, scene->block, &context, &packet->ray);
    for (int i = 0; i < packet->count; i++) {
        weft_vec3 direction = light[packet->light[i]];
        bool open = packet->ray.tfar[i] >= 0;
        if (open && !packet->leaves[i])
            open = lit_further(scene, weft_add(origin, weft_scale(direction, packet->far[i])), direction);
        lit[packet->light[i]] = open;
    }
    packet->count = 0;
}

void weft_ray_scene_lit(const weft_ray_scene *scene, weft_vec3 place, const weft_vec3 *light, int light_count,
                        const uint8_t *wanted, uint8_t *lit)
{
    _Alignas(64) shadow_packet packet = {0};
    weft_vec3 origin = wrap_place(scene, place);
    for (int i = 0; i < light_count; i++) {
        lit[i] = 0;
        if (!wanted[i])
            continue;
        add_to_packet(scene, &packet, origin, light[i], i);
        if (packet.count == PACKET)
            trace_packet(scene, &packet, origin, light, lit);
    }
    if (packet.count > 0)
        trace_packet(scene, &packet, origin, light, lit);
}

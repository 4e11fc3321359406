#include "bench/faultless_btf.h"

#include "bench/measure.h"
#include "geometry/light/sample_sequence.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <stddef.h>

enum { MOST_COMPONENTS = 8 };

typedef struct btf {
    const weft_stitch_sample *sample;
    const weft_mesh *mesh;
    RTCDevice device;
    RTCScene rays;
    double mm_per_unit, plane_mm;
    weft_vec3 light, eye; /* world, mesh units */
    weft_orbit_axes ray;
    double exposure;
} btf;

/* Where a ray meets the drape: the place of the flat stitch, and the axes of the cloth there. */
typedef struct meeting {
    weft_vec3 at, axis[3];
    double x_mm, y_mm;
} meeting;

static weft_vec3 mean_of(const weft_mesh *mesh, const uint32_t *corner, const float weight[3], size_t offset)
{
    weft_vec3 sum = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        const float *from = (const float *)((const char *)&mesh->vertex[corner[i]] + offset);
        sum = weft_add(sum, weft_scale(weft_vec3_of(from[0], from[1], from[2]), weight[i]));
    }
    return sum;
}

static bool meet(const btf *b, weft_vec3 origin, weft_vec3 direction, meeting *m)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    struct RTCRayHit r = {.ray = {.org_x = (float)origin.x,
                                  .org_y = (float)origin.y,
                                  .org_z = (float)origin.z,
                                  .dir_x = (float)direction.x,
                                  .dir_y = (float)direction.y,
                                  .dir_z = (float)direction.z,
                                  .tfar = INFINITY,
                                  .mask = ~0u},
                          .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    rtcIntersect1(b->rays, &context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    const uint32_t *corner = b->mesh->index[r.hit.primID];
    const float weight[3] = {1 - r.hit.u - r.hit.v, r.hit.u, r.hit.v};
    weft_vec3 n = weft_unit(mean_of(b->mesh, corner, weight, offsetof(weft_vertex, normal)));
    weft_vec3 t = mean_of(b->mesh, corner, weight, offsetof(weft_vertex, tangent));
    t = weft_unit(weft_subtract(t, weft_scale(n, weft_dot(n, t))));
    weft_vec3 facet = weft_vec3_of(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z);
    double side = weft_dot(facet, direction) < 0 ? 1 : -1, u = 0, v = 0;
    for (int i = 0; i < 3; i++) {
        u += (double)(weight[i] * b->mesh->vertex[corner[i]].coordinate[0]);
        v += (double)(weight[i] * b->mesh->vertex[corner[i]].coordinate[1]);
    }
    n = weft_scale(n, side);
    t = weft_scale(t, side);
    *m = (meeting){weft_add(origin, weft_scale(direction, r.ray.tfar)),
                   {t, weft_cross(n, t), n},
                   side * u * b->mm_per_unit,
                   v * b->mm_per_unit};
    return true;
}

static weft_vec3 in_axes(const meeting *m, weft_vec3 d)
{
    d = weft_vec3_of(weft_dot(d, m->axis[0]), weft_dot(d, m->axis[1]), weft_dot(d, m->axis[2]));
    return weft_unit(weft_vec3_of(d.x, d.y, fmax(d.z, 0.02)));
}

static int see(const btf *b, const meeting *m, weft_vec3 toward, uint64_t key, uint32_t index, weft_seen_vertex *vertex)
{
    weft_vec3 view = in_axes(m, toward);
    double up = -b->plane_mm / view.z;
    return weft_stitch_sample_see(b->sample, m->x_mm + up * view.x, m->y_mm + up * view.y, view, key, index, vertex);
}

/* A little off the surface, or through it. */
static weft_vec3 beyond(weft_vec3 at, weft_vec3 direction)
{
    return weft_add(at, weft_scale(direction, 1e-4));
}

static bool is_lit(const btf *b, const meeting *m, uint64_t key, uint32_t index)
{
    meeting next = *m;
    weft_vec3 from = weft_add(m->at, weft_scale(m->axis[2], 0.004));
    for (int i = 0; i < MOST_COMPONENTS; i++) {
        weft_seen_vertex vertex[1 + WEFT_STITCH_SAMPLE_MAX_BOUNCES];
        if (!meet(b, from, b->light, &next))
            return true;
        /* What meets the light from behind is the same cloth. */
        if (see(b, &next, weft_scale(b->light, weft_dot(next.axis[2], b->light) < 0 ? -1 : 1), key, index, vertex) > 0)
            return false;
        from = beyond(next.at, b->light);
    }
    return false;
}

/* One path; false where it passes all cloth. */
static bool follow(const btf *b, weft_vec3 direction, uint64_t key, uint32_t index, double sum[3])
{
    weft_vec3 from = b->eye;
    for (int i = 0; i < MOST_COMPONENTS; i++) {
        weft_seen_vertex vertex[1 + WEFT_STITCH_SAMPLE_MAX_BOUNCES];
        meeting m;
        if (!meet(b, from, direction, &m))
            return false;
        int count = see(b, &m, weft_scale(direction, -1), key, index, vertex);
        if (count > 0) {
            if (!(weft_dot(b->light, m.axis[2]) > 0) || !is_lit(b, &m, key, index))
                return true;
            weft_rgb value = weft_stitch_sample_light(b->sample, vertex, count, in_axes(&m, b->light));
            sum[0] += b->exposure * value.r;
            sum[1] += b->exposure * value.g;
            sum[2] += b->exposure * value.b;
            return true;
        }
        from = beyond(m.at, direction);
    }
    return true;
}

static void draw_pixel(const btf *b, int x, int y, int paths, const weft_image *background, weft_image *image)
{
    uint64_t key = weft_sequence_key(77, (uint64_t)y * (uint64_t)image->width + (uint64_t)x);
    double sum[3] = {0};
    size_t pixel = 3 * ((size_t)y * (size_t)image->width + (size_t)x);
    for (uint32_t i = 0; i < (uint32_t)paths; i++) {
        double point[2];
        weft_sequence_point(weft_sequence_key(key, 99999), i, point);
        weft_vec3 d =
            weft_add(weft_scale(b->ray.right, x + point[0]), weft_scale(b->ray.up, image->height - y - 1 + point[1]));
        if (!follow(b, weft_unit(weft_subtract(d, b->ray.backward)), key, i, sum))
            for (int c = 0; c < 3; c++)
                sum[c] += (double)background->pixels[pixel + (size_t)c];
    }
    for (size_t c = 0; c < 3; c++)
        image->pixels[pixel + c] = (float)(sum[c] / paths);
}

static void build(btf *b)
{
    b->device = rtcNewDevice("threads=1");
    RTCGeometry geometry = rtcNewGeometry(b->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float(*position)[3] = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                  sizeof *position, (size_t)b->mesh->vertex_count);
    uint32_t(*index)[3] = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof *index,
                                                  (size_t)b->mesh->triangle_count);
    for (int i = 0; i < 3 * b->mesh->vertex_count; i++)
        position[i / 3][i % 3] = b->mesh->vertex[i / 3].position[i % 3];
    for (int i = 0; i < 3 * b->mesh->triangle_count; i++)
        index[i / 3][i % 3] = b->mesh->index[i / 3][i % 3];
    rtcCommitGeometry(geometry);
    b->rays = rtcNewScene(b->device);
    rtcAttachGeometry(b->rays, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(b->rays, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(b->rays);
}

weft_image faultless_btf_draw(const faultless_btf *of, const weft_scene *scene, int paths, const weft_image *background)
{
    btf b = {.sample = of->sample, .mesh = of->mesh, .mm_per_unit = of->mm_per_unit, .plane_mm = of->plane_mm};
    weft_error error = {0};
    weft_image image;
    float centre[3], radius;
    weft_mesh_bounds(b.mesh, centre, &radius);
    b.light = weft_direction_of_angles(scene->light[0].direction);
    b.eye = weft_orbit_eye(&scene->orbit, weft_vec3_of(centre[0], centre[1], centre[2]), (double)radius);
    b.ray = weft_orbit_rays(&scene->orbit, background->width, background->height, 0, 0);
    b.exposure = scene->exposure;
    build(&b);
    bench_stop_on("bench_drape_bound", weft_image_create(background->width, background->height, &image, &error),
                  &error);
#pragma omp parallel for schedule(dynamic, 1)
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++)
            draw_pixel(&b, x, y, paths, background, &image);
    rtcReleaseScene(b.rays);
    rtcReleaseDevice(b.device);
    return image;
}

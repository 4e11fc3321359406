/* What bounds a BTF on the drape, by pictures of the geometry of a stitch (docs/notes/traced-truth.md): the noise of
 * the truth itself, as another seed tells; a BTF without fault, which is asked of the flat stitch for every place,
 * light and view by itself; and what the player makes of a dataset with more samples a pixel or on the finest level
 * alone. Usage: bench_drape_bound STITCH DATASET.btf.h5 [PATHS [SIDE]] */
#include "geometry/drape/draped_cloth.h"
#include "geometry/light/sample_sequence.h"
#include "geometry/light/stitch_sample.h"
#include "player/draw/player.h"
#include "player/gl/context.h"
#include "study/truth/comparison.h"
#include "study/truth/trace.h"

#include <embree3/rtcore.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double most_triangles = 12e6;

enum { BOUNCES = 3, MOST_LAYERS = 8 };

static void stop_on(weft_code code, const weft_error *error)
{
    if (code == WEFT_OK)
        return;
    fprintf(stderr, "bench_drape_bound: %s\n", error->message);
    exit((int)code);
}

/* ---- The scene: the first of weft compare --truth ---- */

static weft_scene make_scene(void)
{
    weft_scene scene = weft_scene_default();
    scene.light[0].direction = (weft_angles){weft_rad_of_deg(40), weft_rad_of_deg(-130)};
    scene.orbit.azimuth_rad = weft_rad_of_deg(-70);
    scene.orbit.elevation_rad = weft_rad_of_deg(28);
    scene.repeat = WEFT_TRUTH_REPEAT;
    scene.labels = false;
    scene.pane[0] = WEFT_MODE_RAW;
    scene.shadows = true;
    return scene;
}

/* As coarse as weft compare --truth has it where the drape would have too many triangles. */
static int cells_of(const weft_stitch *stitch, const char *path)
{
    weft_error error = {0};
    weft_tile_mesh tile;
    stop_on(weft_tile_mesh_create(stitch, 0, path, &tile, &error), &error);
    double tiles = WEFT_TRUTH_REPEAT * ceil(WEFT_TRUTH_REPEAT * stitch->width / stitch->height);
    double share = most_triangles / (tiles * tile.triangle_count);
    weft_tile_mesh_free(&tile);
    return share >= 1 ? 0 : (int)(stitch->resolution * sqrt(share));
}

static double plane_of(const weft_dataset_layout *layout)
{
    json_t *provenance = json_loads(layout->provenance, 0, NULL);
    double moved = json_number_value(json_object_get(json_object_get(provenance, "relief"), "moved_mm"));
    double below = json_number_value(json_object_get(provenance, "plane_below_top_mm"));
    json_decref(provenance);
    return moved - below;
}

/* ---- A BTF without fault ---- */

static bool is_sheared;

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
    weft_vec3 dual[2]; /* gradients of the place along u and v: those of a cloth that is neither stretched nor sheared
                          are its axes */
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
    weft_vec3 edge[2];
    double du[2], dv[2];
    const weft_vertex *c0 = &b->mesh->vertex[corner[0]];
    for (int i = 0; i < 2; i++) {
        const weft_vertex *c = &b->mesh->vertex[corner[i + 1]];
        edge[i] = weft_vec3_of(c->position[0] - c0->position[0], c->position[1] - c0->position[1],
                               c->position[2] - c0->position[2]);
        du[i] = c->coordinate[0] - c0->coordinate[0];
        dv[i] = c->coordinate[1] - c0->coordinate[1];
    }
    double det = du[0] * dv[1] - du[1] * dv[0];
    weft_vec3 pu = weft_scale(weft_subtract(weft_scale(edge[0], dv[1]), weft_scale(edge[1], dv[0])), 1 / det);
    weft_vec3 pv = weft_scale(weft_subtract(weft_scale(edge[1], du[0]), weft_scale(edge[0], du[1])), 1 / det);
    double volume = weft_dot(n, weft_cross(pu, pv));
    weft_vec3 dual_u = weft_scale(weft_cross(pv, n), 1 / volume), dual_v = weft_scale(weft_cross(n, pu), 1 / volume);
    n = weft_scale(n, side);
    t = weft_scale(t, side);
    *m = (meeting){weft_add(origin, weft_scale(direction, r.ray.tfar)),
                   {t, weft_cross(n, t), n},
                   side * u * b->mm_per_unit,
                   v * b->mm_per_unit,
                   {weft_scale(dual_u, side), dual_v}};
    return true;
}

static weft_vec3 in_axes(const meeting *m, weft_vec3 d)
{
    if (is_sheared)
        d = weft_vec3_of(weft_dot(d, m->dual[0]), weft_dot(d, m->dual[1]), weft_dot(d, m->axis[2]));
    else
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
    for (int i = 0; i < MOST_LAYERS; i++) {
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
    for (int i = 0; i < MOST_LAYERS; i++) {
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
    uint64_t key = weft_sequence_key(77, (uint64_t)(y * image->width + x));
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

static weft_image draw_faultless(btf b, const weft_scene *scene, int paths, const weft_image *background)
{
    weft_error error = {0};
    weft_image image;
    float centre[3], radius;
    weft_mesh_bounds(b.mesh, centre, &radius);
    b.light = weft_direction_of_angles(scene->light[0].direction);
    b.eye = weft_orbit_eye(&scene->orbit, weft_vec3_of(centre[0], centre[1], centre[2]), (double)radius);
    b.ray = weft_orbit_rays(&scene->orbit, background->width, background->height, 0, 0);
    b.exposure = scene->exposure;
    build(&b);
    stop_on(weft_image_create(background->width, background->height, &image, &error), &error);
#pragma omp parallel for schedule(dynamic, 1)
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++)
            draw_pixel(&b, x, y, paths, background, &image);
    rtcReleaseScene(b.rays);
    rtcReleaseDevice(b.device);
    return image;
}

/* ---- Pictures ---- */

typedef struct stage {
    weft_player *player;
    weft_surface_sample *surface;
    weft_image truth;
    int side;
} stage;

static weft_image draw(const stage *s, const weft_scene *scene, int samples)
{
    weft_error error = {0};
    weft_image image;
    stop_on(weft_player_picture(s->player, scene, s->side, s->side, samples, NULL, &image, &error), &error);
    return image;
}

static void report(const stage *s, const char *what, weft_image *image)
{
    weft_error error = {0};
    weft_truth_error e;
    stop_on(weft_truth_error_of(&s->truth, image, s->surface, &e, &error), &error);
    printf("%-40s %.4f, of blocks %.4f\n", what, e.error.relative_rmse, e.block_relative_rmse);
    fflush(stdout);
    if (getenv("PICTURES")) {
        char path[512];
        snprintf(path, sizeof path, "%s%s.exr", getenv("PICTURES"), what);
        stop_on(weft_image_write(path, image, what, &error), &error);
    }
    weft_image_free(image);
}

static void report_raw(const stage *s, weft_scene scene)
{
    static const int samples[] = {3, 6};
    for (int i = 0; i < 8; i++) {
        char what[80];
        scene.relief = i / 2 % 2 == 0;
        scene.level_choice = i < 4 ? WEFT_LEVEL_TRILINEAR : WEFT_LEVEL_NONE;
        snprintf(what, sizeof what, "raw %s, %s, %d x %d samples", i / 2 % 2 ? "flat" : "through heights",
                 i < 4 ? "levels" : "finest level", samples[i % 2], samples[i % 2]);
        weft_image image = draw(s, &scene, samples[i % 2]);
        report(s, what, &image);
    }
}

static weft_image draw_background(const weft_scene *scene, stage *s)
{
    weft_error error = {0};
    weft_mesh nothing;
    stop_on(weft_mesh_allocate(3, 1, &nothing, &error), &error);
    for (int i = 0; i < 3; i++)
        nothing.vertex[i] = (weft_vertex){.position = {(float)i, 0, 0}, .normal = {0, 0, 1}, .tangent = {1, 0, 0, 1}};
    for (uint32_t i = 0; i < 3; i++)
        nothing.index[0][i] = i;
    stop_on(weft_player_set_mesh(s->player, &nothing, &error), &error);
    weft_mesh_free(&nothing);
    return draw(s, scene, 1);
}

static weft_image trace(const weft_draped_cloth *cloth, const weft_mesh *mesh, double mm_per_unit,
                        const weft_scene *scene, int paths, uint64_t seed, const weft_image *background)
{
    weft_error error = {0};
    weft_traced traced;
    const weft_trace_options options = {background->width, background->height, paths, BOUNCES, 1, seed};
    stop_on(weft_trace(cloth, mesh, mm_per_unit, scene, &options, background, NULL, &traced, &error), &error);
    weft_image_free(&traced.near);
    printf("truth of seed %d: standard error %.4f\n", (int)seed, traced.noise);
    return traced.all;
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    int paths = argc > 3 ? atoi(argv[3]) : WEFT_TRUTH_DEFAULT_PATHS;
    stage s = {.side = argc > 4 ? atoi(argv[4]) : 400};
    weft_scene scene = make_scene();
    weft_dataset *dataset;
    weft_stitch stitch;
    weft_stitch_sample *sample;
    weft_tile_mesh tile;
    weft_mesh drape;
    weft_truth_base base;
    weft_draped_cloth *cloth;
    weft_headless *headless;
    int skipped;
    if (argc < 3) {
        fprintf(stderr, "usage: bench_drape_bound STITCH DATASET.btf.h5 [PATHS [SIDE]]\n");
        return WEFT_BAD_USAGE;
    }
    stop_on(weft_dataset_open(argv[2], &dataset, &error), &error);
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    stop_on(weft_stitch_read(argv[1], &stitch, &error), &error);
    stop_on(weft_stitch_sample_read(argv[1], BOUNCES, &sample, &error), &error);
    stop_on(weft_tile_mesh_create(&stitch, cells_of(&stitch, argv[1]), argv[1], &tile, &error), &error);
    stop_on(weft_mesh_drape(&drape, &error), &error);
    stop_on(weft_truth_base_create(&drape, WEFT_TRUTH_REPEAT, stitch.width, &base, &error), &error);
    base.surface.plane_mm = (weft_real)plane_of(layout);
    stop_on(weft_headless_create(WEFT_GL_CORE, &headless, &error), &error);
    stop_on(weft_player_create(&s.player, &error), &error);
    stop_on(weft_player_set_dataset(s.player, dataset, NULL, &skipped, &error), &error);
    weft_image background = draw_background(&scene, &s);
    double shown = (double)layout->width / layout->height, is = stitch.width / stitch.height;
    btf b = {.sample = sample, .mesh = &drape, .mm_per_unit = base.mm_per_unit, .plane_mm = base.surface.plane_mm};
    stop_on(weft_draped_cloth_create(&stitch, &tile, &base.surface, &cloth, &error), &error);
    s.truth = trace(cloth, &drape, base.mm_per_unit, &scene, paths, 1, &background);
    weft_image other = trace(cloth, &drape, base.mm_per_unit, &scene, paths, 2, &background);
    weft_image faultless = draw_faultless(b, &scene, paths, &background);
    is_sheared = true;
    weft_image sheared = draw_faultless(b, &scene, paths, &background);
    for (int i = 0; i < drape.vertex_count; i++)
        drape.vertex[i].coordinate[1] *= (float)(is / shown);
    stop_on(weft_player_set_mesh(s.player, &drape, &error), &error);
    stop_on(weft_player_read_surface(s.player, &scene, WEFT_MODE_RAW, s.side, s.side, &s.surface, &error), &error);
    if (getenv("PICTURES")) {
        char path[512];
        snprintf(path, sizeof path, "%struth.exr", getenv("PICTURES"));
        stop_on(weft_image_write(path, &s.truth, "truth", &error), &error);
    }
    report(&s, "the truth of another seed", &other);
    report(&s, "a BTF without fault", &faultless);
    report(&s, "the same, sheared", &sheared);
    report_raw(&s, scene);
    return 0;
}

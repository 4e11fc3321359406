#include "capture/synthetic/scene.h"

#include "capture/virtual/random.h"

/* A block of pixels is treated alike. */
enum {
    BLOCK = 8,
    EDGE_RAYS = 24,
    CONTENT_RAYS = 12,
    SOLID_RAYS = 48,
    SHADOW_RAYS = 64,
    FIRST_RAYS = 12,
    GLINT_RAYS = 400
};

/* The filter before a sensor splits every ray into four, so far apart (pixels). */
static const double split = 0.35;

/* Where a mirror shows the lamp: so bright that few rays would be many times too bright or too dark. Pixels. */
typedef struct glint {
    double x, y, radius;
} glint;

typedef struct view {
    const weft_synthetic_lens *lens;
    const weft_synthetic_scene *scene;
    weft_vec3 eye, right, down, forward;
    uint64_t seed;
    float *radiance;
    glint glint[WEFT_SYNTHETIC_SOLIDS];
    int glint_count;
} view;

/* How a block of pixels is to be drawn. */
typedef struct block_kind {
    bool traced;                   /* something may stand before the plane, or the rays miss it */
    weft_synthetic_solids before;  /* what may stand there */
    weft_synthetic_solids shading; /* what may hide the lamp */
    double reach;                  /* half of the square of the plane that a pixel sees at most, mm */
} block_kind;

static weft_vec3 turn(const view *v, weft_vec3 d)
{
    return weft_add(weft_add(weft_scale(v->right, d.x), weft_scale(v->down, d.y)), weft_scale(v->forward, d.z));
}

/* ---- Rays ---- */

static double fraction(double x)
{
    return x - floor(x);
}

/* Sample `index` of a pixel: the sequence of the generalised golden ratio (Roberts 2018) in six dimensions - pixel,
 * pupil and lamp - begun elsewhere in every pixel. */
static void sample_of(uint64_t bits, int index, double sample[6])
{
    static const double step[6] = {0.898654, 0.807579, 0.725735, 0.652184, 0.586088, 0.526690};
    for (int k = 0; k < 6; k++) {
        sample[k] = fraction((double)(bits >> 32) * 0x1p-32 + (index + 1) * step[k]);
        bits = bits * 6364136223846793005u + 1442695040888963407u;
    }
}

/* The ray of a sample, in the frame of the sheet. */
static bool ray_of(const view *v, int x, int y, const double sample[6], int index, weft_synthetic_ray *ray)
{
    double pupil[2];
    double at_x = x - 0.5 + sample[0] + (index & 1 ? split : -split);
    double at_y = y - 0.5 + sample[1] + (index & 2 ? split : -split);
    weft_synthetic_disc(sample[2], sample[3], pupil);
    if (!weft_synthetic_lens_ray(v->lens, at_x, at_y, pupil, ray))
        return false;
    ray->from = weft_add(v->eye, turn(v, ray->from));
    ray->along = turn(v, ray->along);
    return true;
}

static weft_rgb look_along(const view *v, const weft_synthetic_ray *ray, const weft_synthetic_chance *chance,
                           const block_kind *kind)
{
    if (kind->traced)
        return weft_synthetic_scene_look(v->scene, ray->from, ray->along, chance, kind->before, kind->shading);
    weft_vec3 point = weft_add(ray->from, weft_scale(ray->along, -ray->from.z / ray->along.z));
    point.z = 0;
    return weft_synthetic_scene_shade(v->scene, point, weft_scale(ray->along, -1), chance, kind->shading);
}

/* Whether the first rays of a pixel agree so well that more would say the same. */
static bool is_settled(const double *green, int count)
{
    double low = green[0], high = green[0];
    for (int i = 1; i < count; i++) {
        low = fmin(low, green[i]);
        high = fmax(high, green[i]);
    }
    return high - low <= 0.02 * high;
}

/* The mean of `ray_count` rays, or of the first ones where those agree and `may_settle`. */
static weft_rgb trace_pixel(const view *v, int x, int y, int ray_count, bool may_settle, const block_kind *kind)
{
    uint64_t pixel = (uint64_t)y * (uint64_t)v->lens->width + (uint64_t)x;
    uint64_t bits = weft_random_bits(v->seed, WEFT_RANDOM_PIXEL, pixel);
    weft_rgb total = {0, 0, 0};
    double green[FIRST_RAYS];
    int traced = 0;
    while (traced < ray_count && !(may_settle && traced == FIRST_RAYS && is_settled(green, FIRST_RAYS))) {
        double sample[6];
        weft_synthetic_ray ray;
        weft_rgb seen = {0, 0, 0};
        sample_of(bits, traced, sample);
        if (ray_of(v, x, y, sample, traced, &ray)) {
            weft_synthetic_chance chance = {{sample[4], sample[5]}, bits, (uint32_t)traced};
            seen = look_along(v, &ray, &chance, kind);
        }
        if (traced < FIRST_RAYS)
            green[traced] = seen.g;
        total = weft_rgb_add(total, seen);
        traced++;
    }
    return weft_rgb_scale(total, weft_synthetic_lens_obliquity(v->lens, x, y) / traced);
}

/* ---- Glints ---- */

/* The place on a ball that mirrors the lamp to the eye: its normal halves the angle. A few rounds settle it. */
static weft_vec3 mirror_place(const weft_synthetic_solid *ball, weft_vec3 lamp, weft_vec3 eye)
{
    weft_vec3 at = ball->a;
    for (int i = 0; i < 30; i++) {
        weft_vec3 to_lamp = weft_unit(weft_subtract(lamp, at)), to_eye = weft_unit(weft_subtract(eye, at));
        at = weft_add(ball->a, weft_scale(weft_unit(weft_add(to_lamp, to_eye)), ball->radius_mm));
    }
    return at;
}

/* Its blur, twice the width of the lamp in a convex mirror, and room for more. */
static void add_glint(view *v, const weft_synthetic_solid *ball)
{
    weft_vec3 place = mirror_place(ball, v->scene->lamp.at, v->eye), d = weft_subtract(place, v->eye);
    double depth = weft_dot(d, v->forward), pixel[2];
    double per_mm = v->lens->image_distance_mm / depth * v->lens->width / v->lens->sensor_width_mm;
    double away = weft_length(weft_subtract(v->scene->lamp.at, place));
    double size = ball->radius_mm * v->scene->lamp.radius_mm / away;
    double blur = v->lens->pupil_radius_mm * fabs(depth / v->lens->focus_mm - 1);
    weft_vec3 camera = {weft_dot(d, v->right), weft_dot(d, v->down), depth};
    if (v->glint_count < WEFT_SYNTHETIC_SOLIDS && weft_synthetic_lens_project(v->lens, camera, pixel))
        v->glint[v->glint_count++] = (glint){pixel[0], pixel[1], 3 + 1.2 * per_mm * (size + blur)};
}

static bool in_glint(const view *v, int x, int y)
{
    for (int i = 0; i < v->glint_count; i++) {
        if (hypot(x - v->glint[i].x, y - v->glint[i].y) < v->glint[i].radius)
            return true;
    }
    return false;
}

/* ---- Pixels ---- */

/* Where the middle of a pixel and of the pupil see the plane. */
static bool meet_plane(const view *v, double x, double y, weft_vec3 *point)
{
    double slope[2];
    weft_synthetic_lens_slopes(v->lens, x, y, slope);
    weft_vec3 along = turn(v, weft_vec3_of(slope[0], slope[1], 1));
    double t = -v->eye.z / along.z;
    *point = weft_vec3_of(v->eye.x + t * along.x, v->eye.y + t * along.y, 0);
    return along.z < 0;
}

static weft_rgb draw_pixel(const view *v, int x, int y, const block_kind *kind)
{
    weft_vec3 point;
    if (kind->traced)
        return in_glint(v, x, y) ? trace_pixel(v, x, y, GLINT_RAYS, false, kind)
                                 : trace_pixel(v, x, y, SOLID_RAYS, true, kind);
    meet_plane(v, x, y, &point);
    if (!weft_synthetic_sheet_is_even(v->scene->sheet, point.x, point.y, kind->reach))
        return trace_pixel(v, x, y, EDGE_RAYS, true, kind);
    if (weft_synthetic_sheet_reflectance(v->scene->sheet, point.x, point.y) < 0)
        return trace_pixel(v, x, y, CONTENT_RAYS, true, kind);
    if (kind->shading)
        return trace_pixel(v, x, y, SHADOW_RAYS, true, kind);
    weft_vec3 toward_eye = weft_unit(weft_subtract(v->eye, point));
    weft_rgb seen = weft_synthetic_scene_shade(v->scene, point, toward_eye, &(weft_synthetic_chance){{0, 0}, 0, 0}, 0);
    return weft_rgb_scale(seen, weft_synthetic_lens_vignetting(v->lens, x, y));
}

/* ---- Blocks ---- */

/* How far apart on the plane the rays of a pixel lie at most: its size, and its blur, both stretched by the slant. */
static double reach_of(const view *v, weft_vec3 point, double pixel_mm)
{
    weft_vec3 d = weft_subtract(point, v->eye);
    double depth = weft_dot(d, v->forward), slant = weft_length(d) / v->eye.z;
    double blur = v->lens->pupil_radius_mm * fabs(depth / v->lens->focus_mm - 1);
    return 1.1 * (pixel_mm * (0.5 + split) * 1.5 + blur * slant);
}

static block_kind kind_of_block(const view *v, int x0, int y0, int x1, int y1)
{
    weft_vec3 corner[4], middle = {0, 0, 0};
    double radius = 0, side = 0;
    for (int i = 0; i < 4; i++) {
        if (!meet_plane(v, i == 1 || i == 2 ? x1 : x0, i < 2 ? y0 : y1, &corner[i]) || corner[i].z != 0)
            return (block_kind){
                .traced = true, .before = WEFT_SYNTHETIC_ALL_SOLIDS, .shading = WEFT_SYNTHETIC_ALL_SOLIDS};
        middle = weft_add(middle, weft_scale(corner[i], 0.25));
    }
    block_kind kind = {0};
    for (int i = 0; i < 4; i++) {
        radius = fmax(radius, weft_length(weft_subtract(corner[i], middle)));
        side = fmax(side, weft_length(weft_subtract(corner[i], corner[(i + 1) % 4])));
    }
    for (int i = 0; i < 4; i++)
        kind.reach = fmax(kind.reach, reach_of(v, corner[i], side / BLOCK));
    double around = 1.2 * radius + 2 * kind.reach;
    kind.before = weft_synthetic_scene_between(v->scene, middle, around, v->eye, v->lens->pupil_radius_mm);
    kind.shading = weft_synthetic_scene_between(v->scene, middle, around, v->scene->lamp.at, v->scene->lamp.radius_mm);
    kind.traced = kind.before != 0;
    return kind;
}

static void draw_block(const view *v, int x0, int y0)
{
    int x1 = x0 + BLOCK < v->lens->width ? x0 + BLOCK : v->lens->width;
    int y1 = y0 + BLOCK < v->lens->height ? y0 + BLOCK : v->lens->height;
    block_kind kind = kind_of_block(v, x0 - 1, y0 - 1, x0 + BLOCK, y0 + BLOCK);
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++) {
            weft_rgb seen = draw_pixel(v, x, y, &kind);
            float *pixel = v->radiance + 3 * ((size_t)y * (size_t)v->lens->width + (size_t)x);
            pixel[0] = (float)seen.r;
            pixel[1] = (float)seen.g;
            pixel[2] = (float)seen.b;
        }
    }
}

void weft_synthetic_render(const weft_synthetic_lens *lens, const weft_pose *pose, const weft_synthetic_scene *scene,
                           uint64_t seed, float *radiance)
{
    const double(*r)[3] = pose->rotation;
    view v = {.lens = lens,
              .scene = scene,
              .eye = weft_pose_camera_position(pose),
              .right = {r[0][0], r[0][1], r[0][2]},
              .down = {r[1][0], r[1][1], r[1][2]},
              .forward = {r[2][0], r[2][1], r[2][2]},
              .seed = seed,
              .radiance = radiance};
    for (int i = 0; i < scene->solid_count; i++) {
        if (scene->solid[i].is_mirror)
            add_glint(&v, &scene->solid[i]);
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (int y = 0; y < lens->height; y += BLOCK) {
        for (int x = 0; x < lens->width; x += BLOCK)
            draw_block(&v, x, y);
    }
}

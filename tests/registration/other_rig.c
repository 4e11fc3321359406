#include "other_rig.h"

#include "base/atomic_file.h"
#include "base/picture/image.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { size = 416, fine = 4, fine_size = size * fine, kernel_reach = 2 * fine, kernel_side = 2 * kernel_reach + 1 };
enum { declared_black = 64, full_scale = 4095, kernel_count = 9 };

static const double opening_mm = 32, camera_mm = 520, light_mm = 700, focal_px = 1900, pi = 3.14159265358979323846;

/* Degrees: theta, phi. */
static const double view_deg[OTHER_RIG_VIEWS][2] = {{0, 0}, {30, 40}, {45, 160}, {60, 250}, {75, 10}, {70, 320}};
static const double light_deg[OTHER_RIG_LIGHTS][2] = {{12, 75}, {68, 330}};

other_rig other_rig_off(void)
{
    return (other_rig){1, 0.6, 1.003, {-0.5, 12}, {2e-4, -3e-4}, 4, 0.5, 0.5, 4, 0.001, 0.5};
}

other_rig other_rig_true(void)
{
    return (other_rig){0, 0, 1, {0, 0}, {0, 0}, 0, 1, 0.5, 0, 0, 0};
}

double other_rig_tilt_deg(int view)
{
    return view_deg[view][0];
}

/* ---- Chance: splitmix64 (Steele et al. 2014) ---- */

static uint64_t next(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* Irwin and Hall's: a sum of twelve has unit variance. */
static double bell(uint64_t *state)
{
    double sum = -6;
    for (int i = 0; i < 12; i++)
        sum += (double)(next(state) >> 11) / 9007199254740992.0;
    return sum;
}

/* ---- Space ---- */

typedef struct place {
    double x, y, z;
} place;

static place towards(const double deg[2])
{
    double theta = deg[0] * pi / 180, phi = deg[1] * pi / 180;
    return (place){sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
}

static double inner(place a, place b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static place along(place from, place direction, double distance)
{
    return (place){from.x + distance * direction.x, from.y + distance * direction.y, from.z + distance * direction.z};
}

/* `p` turned about the axes of the plate, one after the other. */
static place tumbled(place p, const double rad[3])
{
    p = (place){p.x, p.y * cos(rad[0]) - p.z * sin(rad[0]), p.y * sin(rad[0]) + p.z * cos(rad[0])};
    p = (place){p.x * cos(rad[1]) + p.z * sin(rad[1]), p.y, p.z * cos(rad[1]) - p.x * sin(rad[1])};
    return (place){p.x * cos(rad[2]) - p.y * sin(rad[2]), p.x * sin(rad[2]) + p.y * cos(rad[2]), p.z};
}

/* A camera in space: where it is, and its axes in the frame of the plate. */
typedef struct eye {
    place centre, right, down, forward;
} eye;

/* Its zenith is up; the mounting is 0.3 degrees and 0.3 mm off, a view a tenth of that. */
static eye eye_of(int view)
{
    double theta = view_deg[view][0] * pi / 180, phi = view_deg[view][1] * pi / 180, turn[3], shift[3];
    uint64_t state = 77u + (uint64_t)view;
    for (int axis = 0; axis < 3; axis++) {
        turn[axis] = (0.3 * (axis - 1) + 0.03 * bell(&state)) * pi / 180;
        shift[axis] = 0.3 * (1 - axis) + 0.05 * bell(&state);
    }
    place out = towards(view_deg[view]);
    eye e = {.down = {cos(theta) * cos(phi), cos(theta) * sin(phi), -sin(theta)}, .right = {-sin(phi), cos(phi), 0}};
    e.centre = tumbled(along((place){shift[0], shift[1], shift[2]}, out, camera_mm), turn);
    e.forward = tumbled(along((place){0, 0, 0}, out, -1), turn);
    e.down = tumbled(e.down, turn);
    e.right = tumbled(e.right, turn);
    return e;
}

/* ---- The bent plate ---- */

/* A point of the surface: on the paper before it was bent (mm of paper), in space, and the normal. */
typedef struct spot {
    double u, v;
    place at, normal;
} spot;

static double bend_radius(const other_rig *rig, double rim_mm)
{
    return (rim_mm * rim_mm + rig->bow_mm * rig->bow_mm) / (2 * rig->bow_mm);
}

static double rim_mm(void)
{
    const weft_target target = weft_target_for_opening(opening_mm);
    return weft_target_radius_mm(&target);
}

/* The place of the paper point u, v: `across` is measured along the arc. */
static spot bent(const other_rig *rig, double u, double v)
{
    spot s = {u, v, {u, v, 0}, {0, 0, 1}};
    if (rig->bow_mm == 0)
        return s;
    double c = cos(rig->bow_rad), d = sin(rig->bow_rad), radius = bend_radius(rig, rim_mm());
    double angle = (c * u + d * v) / radius, lengthwise = c * v - d * u, across = radius * sin(angle);
    s.at = (place){c * across - d * lengthwise, d * across + c * lengthwise, radius * (cos(angle) - 1)};
    s.normal = (place){c * sin(angle), d * sin(angle), cos(angle)};
    return s;
}

/* Where a ray meets the plate, by the quadratic equation of the cylinder. */
static spot met(const other_rig *rig, place from, place direction)
{
    if (rig->bow_mm == 0) {
        place at = along(from, direction, -from.z / direction.z);
        return (spot){at.x, at.y, at, {0, 0, 1}};
    }
    double c = cos(rig->bow_rad), d = sin(rig->bow_rad), radius = bend_radius(rig, rim_mm());
    double s0 = c * from.x + d * from.y, s1 = c * direction.x + d * direction.y, z0 = from.z + radius, z1 = direction.z;
    double a = s1 * s1 + z1 * z1, b = s0 * s1 + z0 * z1, k = s0 * s0 + z0 * z0 - radius * radius;
    double root = b * b - a * k;
    spot s = {1e9, 1e9, {0, 0, 0}, {0, 0, 1}};
    if (root < 0)
        return s;
    s.at = along(from, direction, (-b - sqrt(root)) / a);
    double angle = atan2(c * s.at.x + d * s.at.y, s.at.z + radius), arc = radius * angle;
    double lengthwise = c * s.at.y - d * s.at.x;
    return (spot){
        c * arc - d * lengthwise, d * arc + c * lengthwise, s.at, {c * sin(angle), d * sin(angle), cos(angle)}};
}

/* ---- The lens ---- */

static double true_focal(const other_rig *rig)
{
    return focal_px * (1 + rig->focal_error);
}

static double true_centre(const other_rig *rig)
{
    return (size - 1) / 2.0 + rig->principal_px;
}

/* Undistorted normalised coordinates of a pixel. */
static void undistort(const other_rig *rig, double px, double py, double ray[2])
{
    double x = (px - true_centre(rig)) / true_focal(rig), y = (py - true_centre(rig)) / true_focal(rig);
    double r2 = x * x + y * y, factor = 1 / (1 + r2 * (rig->division[0] + r2 * rig->division[1]));
    const double *p = rig->decentring;
    ray[0] = x * factor + 2 * p[0] * x * y + p[1] * (r2 + 2 * x * x);
    ray[1] = y * factor + 2 * p[1] * x * y + p[0] * (r2 + 2 * y * y);
}

static place ray_of(const eye *e, const double ray[2])
{
    return along(along(e->forward, e->right, ray[0]), e->down, ray[1]);
}

weft_pixel other_rig_pixel(const other_rig *rig, int view, double x_mm, double y_mm)
{
    eye e = eye_of(view);
    spot s = bent(rig, x_mm * rig->print_scale, y_mm * rig->print_scale);
    place seen = along(s.at, e.centre, -1);
    double depth = inner(seen, e.forward), x = inner(seen, e.right) / depth, y = inner(seen, e.down) / depth, ray[2];
    weft_pixel pixel = {true_centre(rig) + true_focal(rig) * x, true_centre(rig) + true_focal(rig) * y};
    for (int i = 0; i < 30; i++) {
        undistort(rig, pixel.x, pixel.y, ray);
        pixel.x += true_focal(rig) * (x - ray[0]);
        pixel.y += true_focal(rig) * (y - ray[1]);
    }
    return pixel;
}

/* cos^4 of the angle at which an element far behind the pupil takes the light of a ray. */
static double light_loss(const other_rig *rig, double px, double py)
{
    double x = (px - true_centre(rig)) / true_focal(rig), y = (py - true_centre(rig)) / true_focal(rig);
    double cosine2 = 1 / (1 + rig->wide * rig->wide * (x * x + y * y));
    return cosine2 * cosine2;
}

/* ---- What is on the plate ---- */

/* Reflectance of the cloth at a drawn place. Its waves are 4 mm long and more. */
static void pattern(double x, double y, double rgb[3])
{
    double warp = sin(2 * pi * (x + 0.2 * y) / 5), weft = cos(2 * pi * (y - 0.1 * x) / 4);
    rgb[0] = 0.30 + 0.10 * warp * weft + 0.04 * warp;
    rgb[1] = 0.25 + 0.08 * warp - 0.05 * weft;
    rgb[2] = 0.20 + 0.07 * weft * weft + 0.03 * warp;
}

/* How much more or less than a diffuser's the cloth reflects from the light to the view of a shot. */
static double gloss(int shot)
{
    place l = towards(light_deg[shot % OTHER_RIG_LIGHTS]), v = towards(view_deg[shot / OTHER_RIG_LIGHTS]);
    place between = along(l, v, 1);
    return 0.8 + 0.5 * pow(between.z / sqrt(inner(between, between)), 6);
}

void other_rig_reflectance(int shot, int column, int row, int texels, double rgb[3])
{
    enum { grid = 8 };
    double pitch = opening_mm / texels, cosine = towards(light_deg[shot % OTHER_RIG_LIGHTS]).z;
    memset(rgb, 0, 3 * sizeof *rgb);
    for (int i = 0; i < grid * grid; i++) {
        double here[3], x = column + (i % grid + 0.5) / grid, y = row + ((double)(i / grid) + 0.5) / grid;
        pattern(x * pitch - opening_mm / 2, opening_mm / 2 - y * pitch, here);
        for (int c = 0; c < 3; c++)
            rgb[c] += here[c] * gloss(shot) * cosine / (grid * grid);
    }
}

/* ---- A view ---- */

/* The fine picture of one view, and what a pixel sees in its middle. [..][0] is the print, [..][1..3] the cloth. */
typedef struct sight {
    float (*albedo)[4], (*seen)[4]; /* [fine_size][fine_size], [size][size] */
    spot *middle;                   /* [size][size] */
    float *depth;                   /* [size][size] distance over that in focus */
} sight;

static void draw_spot(const other_rig *rig, const weft_target *target, const spot *s, float albedo[4])
{
    double x = s->u / rig->print_scale, y = s->v / rig->print_scale, rgb[3];
    memset(albedo, 0, 4 * sizeof *albedo);
    if (weft_target_region_at(target, x, y) != WEFT_TARGET_OPENING) {
        albedo[0] = (float)weft_target_reflectance(target, x, y);
        return;
    }
    pattern(x, y, rgb);
    for (int c = 0; c < 3; c++)
        albedo[1 + c] = (float)rgb[c];
}

static void draw_fine(const other_rig *rig, const eye *e, sight *picture)
{
    weft_target target = weft_target_for_opening(opening_mm);
    target.paper_reflectance += 0.06;
    target.ink_reflectance += 0.03;
#pragma omp parallel for schedule(dynamic, 16)
    for (int row = 0; row < fine_size; row++) {
        for (int column = 0; column < fine_size; column++) {
            double ray[2];
            undistort(rig, (column + 0.5) / fine - 0.5, (row + 0.5) / fine - 0.5, ray);
            spot s = met(rig, e->centre, ray_of(e, ray));
            draw_spot(rig, &target, &s, picture->albedo[(long)row * fine_size + column]);
        }
    }
    for (int i = 0; i < size * size; i++) {
        double ray[2];
        undistort(rig, i % size, i / size, ray);
        place direction = ray_of(e, ray);
        picture->middle[i] = met(rig, e->centre, direction);
        picture->depth[i] = (float)(inner(along(picture->middle[i].at, e->centre, -1), e->forward) / camera_mm);
    }
}

/* Whether a point lies in the regular hexagon of circumradius 1. */
static bool in_hexagon(double x, double y)
{
    const double apothem = sqrt(3) / 2;
    return fabs(y) <= apothem && fabs(x) * apothem + fabs(y) / 2 <= apothem;
}

/* The square of a pixel spread by a hexagon of the given circumradius (pixels), on the fine grid. Sums to 1. */
static void spread(const other_rig *rig, double circumradius, float kernel[kernel_side][kernel_side])
{
    enum { part = 8 };
    double hexagon[kernel_side][kernel_side] = {{0}}, sum = 0;
    int half = (int)(rig->fill * fine / 2 + 0.25), even = (int)(rig->fill * fine + 0.25) % 2 == 0;
    for (int i = 0; i < part * kernel_side; i++) {
        for (int j = 0; j < part * kernel_side; j++) {
            double x = ((i + 0.5) / part - 0.5 - kernel_reach) / fine,
                   y = ((j + 0.5) / part - 0.5 - kernel_reach) / fine;
            hexagon[j / part][i / part] += in_hexagon(x / circumradius, y / circumradius);
        }
    }
    /* The middle of a pixel lies half a step before a point of the fine grid: so does that of the kernel. */
    assert_true(even);
    for (int y = half; y < kernel_side - half; y++) {
        for (int x = half; x < kernel_side - half; x++) {
            kernel[y][x] = 0;
            for (int i = -half; i < half; i++) {
                for (int j = -half; j < half; j++)
                    kernel[y][x] += (float)hexagon[y + j + 1][x + i + 1];
            }
            sum += (double)kernel[y][x];
        }
    }
    for (int y = 0; y < kernel_side; y++) {
        for (int x = 0; x < kernel_side; x++)
            kernel[y][x] = y < half || x < half || y >= kernel_side - half || x >= kernel_side - half
                               ? 0
                               : kernel[y][x] / (float)sum;
    }
}

/* The fine picture through lens and pixels. What is out of focus is spread wider, in steps of a quarter. */
static void integrate(const other_rig *rig, sight *picture)
{
    static float kernel[kernel_count][kernel_side][kernel_side];
    for (int i = 0; i < kernel_count; i++)
        spread(rig, rig->aperture_px * (0.5 + 0.25 * i), kernel[i]);
#pragma omp parallel for schedule(dynamic, 8)
    for (int row = 0; row < size; row++) {
        for (int column = 0; column < size; column++) {
            long at = (long)row * size + column;
            double blur = 0.5 + fabs(1 - 1 / (double)picture->depth[at]) / 0.04;
            int which = (int)fmin(kernel_count - 1, fmax(0, (blur - 0.5) / 0.25 + 0.5));
            memset(picture->seen[at], 0, sizeof *picture->seen);
            for (int y = 0; y < kernel_side; y++) {
                int v = row * fine + fine / 2 + y - kernel_reach;
                for (int x = 0; v >= 0 && v < fine_size && x < kernel_side; x++) {
                    int u = column * fine + fine / 2 + x - kernel_reach;
                    float weight = u >= 0 && u < fine_size ? kernel[which][y][x] : 0;
                    for (int c = 0; weight > 0 && c < 4; c++)
                        picture->seen[at][c] += weight * picture->albedo[(long)v * fine_size + u][c];
                }
            }
        }
    }
}

/* ---- Photographs ---- */

static void expose(const other_rig *rig, const sight *picture, int shot, double exposure_s, uint16_t *raw)
{
    const double gain[3] = {3300, 4100, 2900}, read_noise = 1.5, well = 15;
    uint64_t state = 0x51ed27u + 1000003u * (uint64_t)shot;
    double lamp = 1 + 0.003 * bell(&state), factor = gloss(shot), off[2];
    for (int i = 0; i < 2; i++)
        off[i] = light_deg[shot % OTHER_RIG_LIGHTS][i] + 0.05 * bell(&state);
    place from = along((place){0, 0, 0}, towards(off), light_mm);
    for (int i = 0; i < size * size; i++) {
        place beam = along(from, picture->middle[i].at, -1);
        double distance2 = inner(beam, beam), cosine = inner(beam, picture->middle[i].normal) / sqrt(distance2);
        double light = lamp * exposure_s * fmax(0, cosine) * light_mm * light_mm / distance2;
        light *= light_loss(rig, i % size, i / size);
        for (int c = 0; c < 3; c++) {
            double signal = gain[c] * light * ((double)picture->seen[i][0] + factor * (double)picture->seen[i][1 + c]);
            signal += bell(&state) * sqrt(read_noise * read_noise + fmax(0, signal) / well);
            signal += declared_black + rig->black_off + 0.5;
            raw[3 * i + c] = (uint16_t)fmin(full_scale, fmax(0, signal));
        }
    }
}

static weft_angles angles_of(const double deg[2])
{
    return (weft_angles){deg[0] * pi / 180, deg[1] * pi / 180};
}

static weft_session describe(const other_rig *rig, const char *folder)
{
    weft_session s = {.folder = strdup(folder), .rig = strdup("other"), .sample = strdup("waves")};
    s.rig_settings = strdup("{}");
    s.camera = (weft_camera){.width = size,
                             .height = size,
                             .fx = focal_px,
                             .fy = focal_px,
                             .cx = (size - 1) / 2.0,
                             .cy = (size - 1) / 2.0,
                             .k1 = rig->division[0]};
    s.camera_distance_mm = camera_mm;
    s.light_distance_mm = light_mm;
    s.bits = 12;
    s.black_level = declared_black;
    s.target = weft_target_for_opening(opening_mm);
    s.shot_count = OTHER_RIG_SHOTS;
    s.shot = calloc(OTHER_RIG_SHOTS, sizeof *s.shot);
    s.record = calloc(OTHER_RIG_SHOTS, sizeof *s.record);
    for (int i = 0; i < OTHER_RIG_SHOTS; i++) {
        weft_angles light = angles_of(light_deg[i % OTHER_RIG_LIGHTS]);
        s.shot[i] = (weft_shot){light, angles_of(view_deg[i / OTHER_RIG_LIGHTS]), light};
    }
    return s;
}

static void take_view(const other_rig *rig, weft_session *session, int view, sight *picture)
{
    eye e = eye_of(view);
    uint16_t *raw = malloc(sizeof *raw * size * size * 3);
    assert_non_null(raw);
    draw_fine(rig, &e, picture);
    integrate(rig, picture);
    for (int light = 0; light < OTHER_RIG_LIGHTS; light++) {
        int shot = view * OTHER_RIG_LIGHTS + light;
        char path[512], parent[512];
        weft_shot_record record = {.taken = true,
                                   .viewpoint = view,
                                   .exposure_s = 0.9 / sqrt(towards(light_deg[light]).z),
                                   .bytes = 1,
                                   .crc32 = 1};
        expose(rig, picture, shot, record.exposure_s, raw);
        weft_session_photograph_path(session, shot, path, sizeof path);
        snprintf(parent, sizeof parent, "%s", path);
        *strrchr(parent, '/') = 0;
        assert_int_equal(weft_make_folder(parent, NULL), WEFT_OK);
        assert_int_equal(weft_photograph_write(path, size, size, 12, raw, NULL), WEFT_OK);
        assert_int_equal(weft_session_append(session, shot, &record, NULL), WEFT_OK);
    }
    free(raw);
}

void other_rig_take(const other_rig *rig, const char *folder)
{
    weft_session session = describe(rig, folder);
    sight picture = {malloc((size_t)fine_size * fine_size * sizeof(float[4])),
                     malloc((size_t)size * size * sizeof(float[4])), malloc((size_t)size * size * sizeof(spot)),
                     malloc((size_t)size * size * sizeof(float))};
    assert_true(picture.albedo && picture.seen && picture.middle && picture.depth);
    assert_int_equal(weft_make_folder(folder, NULL), WEFT_OK);
    assert_int_equal(weft_session_create(&session, NULL), WEFT_OK);
    for (int view = 0; view < OTHER_RIG_VIEWS; view++)
        take_view(rig, &session, view, &picture);
    free(picture.albedo);
    free(picture.seen);
    free(picture.middle);
    free(picture.depth);
    weft_session_free(&session);
}

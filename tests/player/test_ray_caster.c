/* Pictures of a plane against a ray caster that is made from docs/reference/scene.md and conventions.md alone: camera,
 * texture coordinates, mip levels, axes and their handedness, lobes, lights, layouts, holes and sRGB. What is expected
 * is never computed by the player, nor by the evaluators in C. */
#include "stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 160, HEIGHT = 120 };

/* ---- The ray caster ---- */

/* How the cloth lies on the square |x|, |y| <= 1/2 of z = 0: u = 1/2 + u_x x + u_y y, and v alike. */
typedef struct laying {
    const char *name;
    double u_x, u_y, v_x, v_y;
} laying;

static const laying lays[] = {{"as it is", 1, 0, 0, 1},
                              {"u mirrored", -1, 0, 0, 1},
                              {"v mirrored", 1, 0, 0, -1},
                              {"axes exchanged", 0, 1, 1, 0},
                              {"turned by a quarter", 0, 1, -1, 0}};
enum { LAYS = sizeof lays / sizeof *lays };

typedef struct view_point {
    double azimuth_deg, elevation_deg, distance;
} view_point;

typedef struct caster {
    weft_vec3 eye, right, up, forward; /* right and up are as long as half the picture at unit distance */
    int width, height;
} caster;

/* What a ray meets. */
typedef struct meeting {
    bool hit, behind; /* the back of the plane */
    weft_vec3 place;
    double u, v;       /* of the mesh */
    weft_vec3 axis[3]; /* along u, along v, toward the eye */
} meeting;

static caster caster_of(view_point from, int width, int height)
{
    const double radius = sqrt(0.5), half = tan(weft_rad_of_deg(15));
    double a = weft_rad_of_deg(from.azimuth_deg), e = weft_rad_of_deg(from.elevation_deg);
    weft_vec3 outward = weft_vec3_of(cos(e) * cos(a), cos(e) * sin(a), sin(e));
    weft_vec3 right = weft_vec3_of(-sin(a), cos(a), 0), up = weft_cross(outward, right);
    int smaller = width < height ? width : height;
    return (caster){weft_scale(outward, radius * from.distance),
                    weft_scale(right, half * width / smaller),
                    weft_scale(up, half * height / smaller),
                    weft_scale(outward, -1),
                    width,
                    height};
}

/* Pixel (0, 0) is at the top left; (x, y) are its middle plus what is added. */
static meeting cast(const caster *c, const laying *lay, double x, double y)
{
    double across = 2 * (x + 0.5) / c->width - 1, upward = 1 - 2 * (y + 0.5) / c->height;
    weft_vec3 ray = weft_add(c->forward, weft_add(weft_scale(c->right, across), weft_scale(c->up, upward)));
    double length = -c->eye.z / ray.z;
    weft_vec3 p = weft_add(c->eye, weft_scale(ray, length));
    double side = c->eye.z > 0 ? 1 : -1;
    meeting m = {.hit = length > 0 && fabs(p.x) < 0.5 && fabs(p.y) < 0.5,
                 .behind = side < 0,
                 .place = p,
                 .u = 0.5 + lay->u_x * p.x + lay->u_y * p.y,
                 .v = 0.5 + lay->v_x * p.x + lay->v_y * p.y,
                 .axis = {weft_vec3_of(side * lay->u_x, side * lay->u_y, 0), weft_vec3_of(lay->v_x, lay->v_y, 0),
                          weft_vec3_of(0, 0, side)}};
    m.u *= side; /* the back is mirrored in u */
    return m;
}

/* Whether a pixel and its neighbours are on the plane (or all beside it). */
static bool all_around(const caster *c, int x, int y, bool hit)
{
    for (int i = 0; i < 9; i++) {
        if (cast(c, &lays[0], x - 1 + i % 3, y - 1 + i / 3).hit != hit)
            return false;
    }
    return true;
}

static weft_vec3 local(const weft_vec3 axis[3], weft_vec3 d)
{
    return weft_vec3_of(weft_dot(axis[0], d), weft_dot(axis[1], d), weft_dot(axis[2], d));
}

static weft_vec3 world_direction(weft_angles at)
{
    return weft_vec3_of(sin(at.theta_rad) * cos(at.phi_rad), sin(at.theta_rad) * sin(at.phi_rad), cos(at.theta_rad));
}

/* ---- Scenes ---- */

static weft_scene scene_from(view_point from)
{
    weft_scene scene = weft_scene_default();
    scene.orbit =
        (weft_orbit){weft_rad_of_deg(from.azimuth_deg), weft_rad_of_deg(from.elevation_deg), from.distance, 0, 0};
    scene.light[0] = (weft_light){{weft_rad_of_deg(from.elevation_deg > 0 ? 35 : 145), weft_rad_of_deg(20)}, {1, 1, 1}};
    scene.pane[0] = WEFT_MODE_COMPRESSED;
    scene.labels = false;
    scene.repeat = 1;
    scene.filter = WEFT_FILTER_EXACT;
    return scene;
}

static void spread(stage *s, const laying *lay)
{
    weft_mesh mesh;
    weft_error error = {0};
    expect_ok(weft_mesh_plane(&mesh, &error), &error);
    for (int i = 0; i < mesh.vertex_count; i++) {
        weft_vertex *at = &mesh.vertex[i];
        double x = (double)at->position[0], y = (double)at->position[1];
        at->coordinate[0] = (float)(0.5 + lay->u_x * x + lay->u_y * y);
        at->coordinate[1] = (float)(0.5 + lay->v_x * x + lay->v_y * y);
    }
    expect_ok(weft_mesh_compute_tangents(&mesh, &error), &error);
    expect_ok(weft_player_set_mesh(s->player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
}

static void show(stage *s, const weft_material *material)
{
    weft_error error = {0};
    expect_ok(weft_player_set_material(s->player, material, &error), &error);
}

static weft_image draw(stage *s, const weft_scene *scene, int samples)
{
    weft_image image;
    weft_error error = {0};
    expect_ok(weft_player_picture(s->player, scene, WIDTH, HEIGHT, samples, NULL, &image, &error), &error);
    return image;
}

/* Irradiance over pi of light `i`, cosine included, in one channel. */
static double irradiance(const weft_scene *scene, const meeting *m, int i, int channel)
{
    double cosine = weft_dot(m->axis[2], world_direction(scene->light[i].direction));
    return scene->exposure * scene->light[i].irradiance[channel] * fmax(cosine, 0);
}

/* ---- Materials ---- */

static weft_material make_material(int width, int height, int lobes, int views)
{
    weft_material material;
    weft_error error = {0};
    expect_ok(weft_material_create(width, height, lobes, views, 0, true, &material, &error), &error);
    material.texel_pitch_mm = 0.5;
    return material;
}

static void paint(weft_material_level *level, int texel, double r, double g, double b)
{
    const double rgb[3] = {r, g, b};
    for (int c = 0; c < 3; c++)
        level->diffuse[4 * texel + c] = weft_half_of_float((float)rgb[c]);
}

/* Matt, with another grey in every level. */
static double grey_of_level(double level)
{
    return (level + 1) / 16;
}

static weft_material make_staircase(int size)
{
    weft_material material = make_material(size, size, 0, 0);
    for (int k = 0; k < material.level_count; k++) {
        weft_material_level *level = &material.level[k];
        for (int i = 0; i < level->width * level->height; i++)
            paint(level, i, grey_of_level(k), 0, 0);
    }
    return material;
}

/* Matt, no two texels alike, multiples of 1/32. */
static double patch(int x, int y, int channel)
{
    return ((7 * x + 11 * y + 5 * channel + x * y) % 31 + 1) / 32.0;
}

static weft_material make_patchwork(int width, int height)
{
    weft_material material = make_material(width, height, 0, 0);
    for (int i = 0; i < width * height; i++) {
        int x = i % width, y = i / width;
        paint(&material.level[0], i, patch(x, y, 0), patch(x, y, 1), patch(x, y, 2));
    }
    return material;
}

/* ---- Mip levels ---- */

/* log2 of the longer side of the pixel in texels of a square material; of so many frames on each side, how wide it is
 * beside that, or the longer side over their number. */
static double footprint_level(const caster *c, const laying *lay, int x, int y, double texels, int frames)
{
    meeting left = cast(c, lay, x - 0.5, y), right = cast(c, lay, x + 0.5, y);
    meeting above = cast(c, lay, x, y - 0.5), below = cast(c, lay, x, y + 0.5);
    double across[2] = {right.u - left.u, right.v - left.v}, down[2] = {below.u - above.u, below.v - above.v};
    double longer = fmax(hypot(across[0], across[1]), hypot(down[0], down[1]));
    double width = fabs(across[0] * down[1] - across[1] * down[0]) / longer;
    return log2(texels * fmax(width, longer / frames));
}

/* Whether `seen` is what the level of a pixel of this footprint may be. `frames` x `frames` in a pixel make it that
 * much smaller. Next to a step of the nearest level either side will do. */
static bool is_level(const weft_scene *scene, double footprint, int frames, int last, double seen)
{
    const double exact = 0.05;
    double low = footprint - log2(frames) - exact, high = low + 2 * exact;
    if (scene->level_choice == WEFT_LEVEL_NEAREST)
        low = floor(low + 0.5) - exact, high = floor(high + 0.5) + exact;
    if (scene->level_choice == WEFT_LEVEL_NONE)
        low = -exact, high = exact;
    if (scene->level_choice == WEFT_LEVEL_FIXED)
        low = scene->level - exact, high = scene->level + exact;
    return seen >= fmin(fmax(low, -exact), last - exact) && seen <= fmin(fmax(high, exact), last + exact);
}

static void expect_levels(stage *s, view_point from, const laying *lay, weft_scene scene, int frames, int *span)
{
    enum { SIZE = 64, LAST = 6 };
    caster c = caster_of(from, WIDTH, HEIGHT);
    weft_image image = draw(s, &scene, frames);
    double lowest = LAST, highest = 0;
    long pixels = 0, wrong = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        if (!all_around(&c, x, y, true))
            continue;
        meeting m = cast(&c, lay, x, y);
        double footprint = footprint_level(&c, lay, x, y, SIZE * scene.repeat, frames);
        double seen = 16 * (double)image.pixels[3 * i] / irradiance(&scene, &m, 0, 0) - 1;
        wrong += !is_level(&scene, footprint, frames, LAST, seen);
        lowest = fmin(lowest, seen);
        highest = fmax(highest, seen);
        pixels++;
    }
    assert_true(pixels > WIDTH * HEIGHT / 20);
    if (wrong > 0)
        fail_msg("choice %d, %d x %d frames: %ld of %ld pixels have another level", scene.level_choice, frames, frames,
                 wrong, pixels);
    *span = (int)lround(highest - lowest);
    weft_image_free(&image);
}

static void the_level_is_log2_of_the_longer_side_of_the_pixel(void **state)
{
    stage *s = *state;
    weft_material material = make_staircase(64);
    show(s, &material);
    int span;
    for (int i = 0; i < LAYS; i++) {
        spread(s, &lays[i]);
        const view_point from[] = {{-90, 90, 2}, {-90, 20, 1.6}, {30, 12, 2.5}};
        for (int k = 0; k < 3; k++) {
            weft_scene scene = scene_from(from[k]);
            scene.repeat = k == 1 ? 3.5 : 6;
            expect_levels(s, from[k], &lays[i], scene, 1, &span);
            assert_true(k == 0 ? span == 0 : span >= 1);
        }
    }
    weft_material_free(&material);
}

static void levels_are_rounded_fixed_or_left_out_as_asked(void **state)
{
    stage *s = *state;
    weft_material material = make_staircase(64);
    view_point from = {-90, 20, 1.6};
    int span;
    show(s, &material);
    spread(s, &lays[0]);
    weft_scene scene = scene_from(from);
    scene.repeat = 3.5;
    for (weft_level_choice choice = 0; choice < WEFT_LEVEL_CHOICE_COUNT; choice++) {
        scene.level_choice = choice;
        scene.level = 2.25;
        expect_levels(s, from, &lays[0], scene, 1, &span);
    }
    weft_material_free(&material);
}

/* 4.8 times as long as wide at 12 degrees: longer than three frames on a side see, and shorter than six do. */
static void frames_see_the_length_of_a_pixel_and_levels_its_width(void **state)
{
    stage *s = *state;
    weft_material material = make_staircase(64);
    const view_point from[] = {{-90, 90, 2}, {-90, 20, 1.6}, {30, 12, 2.5}};
    int span;
    show(s, &material);
    for (int i = 0; i < 3; i++) {
        weft_scene scene = scene_from(from[i]);
        scene.repeat = 12;
        spread(s, &lays[i]);
        expect_levels(s, from[i], &lays[i], scene, 3, &span);
        expect_levels(s, from[i], &lays[i], scene, 6, &span);
    }
    weft_material_free(&material);
}

/* ---- Frames in a pixel ---- */

/* Stripes of black and white, one of each across the material. */
static weft_material make_stripes(void)
{
    weft_material material = make_material(2, 2, 0, 0);
    for (int i = 0; i < 4; i++)
        paint(&material.level[0], i, i % 2, i % 2, i % 2);
    return material;
}

/* Three of them in a pixel: frames in three rows and columns would all see the same place of a stripe, another in each
 * pixel. */
static void no_two_frames_of_a_picture_lie_in_a_row(void **state)
{
    stage *s = *state;
    enum { FRAMES = 3, AS_IT_IS = 0, EXCHANGED = 3 };
    const view_point from = {-90, 90, 2};
    caster c = caster_of(from, WIDTH, HEIGHT);
    meeting at = cast(&c, &lays[AS_IT_IS], 80, 60), beside = cast(&c, &lays[AS_IT_IS], 81, 60);
    weft_scene scene = scene_from(from);
    weft_material material = make_stripes();
    scene.level_choice = WEFT_LEVEL_NONE;
    scene.repeat = (FRAMES + 0.04) / fabs(beside.u - at.u);
    show(s, &material);
    for (int i = AS_IT_IS; i <= EXCHANGED; i += EXCHANGED - AS_IT_IS) {
        double largest = 0;
        spread(s, &lays[i]);
        weft_image image = draw(s, &scene, FRAMES);
        for (int k = 0; k < WIDTH * HEIGHT; k++) {
            if (!all_around(&c, k % WIDTH, k / WIDTH, true))
                continue;
            meeting m = cast(&c, &lays[i], k % WIDTH, k / WIDTH);
            double grey = (double)image.pixels[3 * k] / irradiance(&scene, &m, 0, 0);
            largest = fmax(largest, fabs(grey - 0.5));
        }
        print_message("%s: %.3f from grey at most\n", lays[i].name, largest);
        assert_true(largest < 0.1);
        weft_image_free(&image);
    }
    weft_material_free(&material);
}

/* ---- Texture coordinates ---- */

/* Bilinear between the middles of texels; the material repeats. Row 0 is at the top: v near 1. */
static double woven(double u, double v, int width, int height, int channel)
{
    double x = u * width - 0.5, y = -v * height - 0.5, sum = 0;
    int left = (int)floor(x), top = (int)floor(y);
    for (int i = 0; i < 4; i++) {
        int column = left + i % 2, row = top + i / 2;
        double share = (i % 2 ? x - left : 1 - x + left) * (i / 2 ? y - top : 1 - y + top);
        sum += share * patch((column % width + width) % width, (row % height + height) % height, channel);
    }
    return sum;
}

static void texels_lie_where_u_and_v_say_on_both_sides(void **state)
{
    enum { COLUMNS = 6, ROWS = 4 };
    stage *s = *state;
    weft_material material = make_patchwork(COLUMNS, ROWS);
    show(s, &material);
    for (int i = 0; i < 2 * LAYS; i++) {
        const laying *lay = &lays[i / 2];
        view_point from = {-60, i % 2 ? -55 : 55, 2.2};
        caster c = caster_of(from, WIDTH, HEIGHT);
        weft_scene scene = scene_from(from);
        scene.level_choice = WEFT_LEVEL_NONE;
        scene.repeat = 1.3;
        scene.exposure = 1.5;
        spread(s, lay);
        weft_image image = draw(s, &scene, 1);
        double largest = 0;
        for (int k = 0; k < 3 * WIDTH * HEIGHT; k++) {
            int x = k / 3 % WIDTH, y = k / 3 / WIDTH;
            if (!all_around(&c, x, y, true))
                continue;
            meeting m = cast(&c, lay, x, y);
            /* Texels are square on the mesh. */
            double u = scene.repeat * m.u, v = scene.repeat * m.v * COLUMNS / ROWS;
            double expected = woven(u, v, COLUMNS, ROWS, k % 3) * irradiance(&scene, &m, 0, k % 3);
            largest = fmax(largest, fabs((double)image.pixels[k] - expected));
        }
        printf("%s, %s: %.5f off at most\n", lay->name, i % 2 ? "back" : "front", largest);
        assert_true(largest < 0.003);
        weft_image_free(&image);
    }
    weft_material_free(&material);
}

/* ---- Axes ---- */

static const double lobe[3][4] = {{-0.9, -0.3, 0.8, 3}, {0.7, -0.8, 0.6, 5}, {0.2, 0.9, 0.7, 2}};
static const double matt = 0.0625;

/* A tilted frame, written as docs/reference/weft-format.md has it: n_x, n_y, and the angle from x on the tangent plane.
 */
static void make_frame(weft_vec3 axis[3], int16_t code[3])
{
    const double azimuth = 0.6;
    code[0] = 6000, code[1] = -9000, code[2] = (int16_t)lround(azimuth / WEFT_PI * 32767);
    double x = code[0] / 32767.0, y = code[1] / 32767.0;
    weft_vec3 n = weft_vec3_of(x, y, sqrt(1 - x * x - y * y));
    weft_vec3 t = weft_unit(weft_subtract(weft_vec3_of(1, 0, 0), weft_scale(n, n.x)));
    axis[0] = weft_add(weft_scale(t, cos(azimuth)), weft_scale(weft_cross(n, t), sin(azimuth)));
    axis[1] = weft_cross(n, axis[0]);
    axis[2] = n;
}

static weft_material make_shiny(void)
{
    weft_material material = make_material(2, 2, 1, 0);
    for (int k = 0; k < material.level_count; k++) {
        weft_material_level *level = &material.level[k];
        int texels = level->width * level->height;
        weft_vec3 axis[3];
        for (int i = 0; i < texels; i++) {
            make_frame(axis, level->frame + 3 * i);
            paint(level, i, matt, matt, matt);
            for (int c = 0; c < 12; c++)
                level->lobe[4 * (c / 4 * texels + i) + c % 4] = weft_half_of_float((float)lobe[c / 4][c % 4]);
        }
    }
    return material;
}

/* rho + max(0, l' . diag(C) . v')^N with both directions first in the axes of the surface, then in those of the texel.
 */
static double shine(const meeting *m, weft_vec3 light, weft_vec3 view, int channel)
{
    weft_vec3 frame[3];
    int16_t code[3];
    make_frame(frame, code);
    weft_vec3 l = local(frame, local(m->axis, light)), v = local(frame, local(m->axis, view));
    const double *own = lobe[channel];
    double base = own[0] * l.x * v.x + own[1] * l.y * v.y + own[2] * l.z * v.z;
    return matt + (base > 0 ? pow(base, own[3]) : 0);
}

static double shine_in_all_lights(const weft_scene *scene, const caster *c, const meeting *m, int channel)
{
    double sum = 0;
    for (int i = 0; i < scene->light_count; i++)
        sum += irradiance(scene, m, i, channel) * shine(m, world_direction(scene->light[i].direction),
                                                        weft_unit(weft_subtract(c->eye, m->place)), channel);
    return sum;
}

static void expect_shine(stage *s, const laying *lay, view_point from, int lights)
{
    caster c = caster_of(from, WIDTH, HEIGHT);
    weft_scene scene = scene_from(from);
    scene.light_count = lights;
    scene.light[0].irradiance[1] = 0.5;
    scene.light[1] =
        (weft_light){{weft_rad_of_deg(from.elevation_deg > 0 ? 50 : 130), weft_rad_of_deg(250)}, {0.3, 0.9, 1.4}};
    weft_image image = draw(s, &scene, 1);
    double largest = 0, brightest = 0;
    for (int k = 0; k < 3 * WIDTH * HEIGHT; k++) {
        int x = k / 3 % WIDTH, y = k / 3 / WIDTH;
        if (!all_around(&c, x, y, true))
            continue;
        meeting m = cast(&c, lay, x, y);
        double expected = shine_in_all_lights(&scene, &c, &m, k % 3);
        largest = fmax(largest, fabs((double)image.pixels[k] - expected));
        brightest = fmax(brightest, expected);
    }
    assert_true(brightest > 0.15);
    assert_true(largest < 0.003);
    weft_image_free(&image);
}

static void axes_follow_u_and_v_whichever_hand_they_make(void **state)
{
    stage *s = *state;
    weft_material material = make_shiny();
    show(s, &material);
    for (int i = 0; i < 4 * LAYS; i++) {
        view_point from = {110, i % 2 ? -40 : 40, 2.5};
        spread(s, &lays[i / 4]);
        expect_shine(s, &lays[i / 4], from, 1 + i / 2 % 2);
    }
    weft_material_free(&material);
}

/* ---- Layouts ---- */

static const char *const dataset_path = "test_ray_caster.btf.h5";

static const double raw_value = 0.5, compressed_value = 0.25;

/* The same reflectance for all directions and texels. */
static void write_even_dataset(void)
{
    enum { SIZE = 2, DIRECTIONS = 19 };
    weft_error error = {0};
    weft_dataset_layout layout = {.width = SIZE,
                                  .height = SIZE,
                                  .image_count = DIRECTIONS * DIRECTIONS,
                                  .view_count = DIRECTIONS,
                                  .values = WEFT_REFLECTANCE,
                                  .texel_pitch_mm = 0.5};
    weft_dataset_writer *writer;
    weft_half samples[SIZE * SIZE * 3];
    uint8_t mask[SIZE * SIZE] = {0};
    expect_ok(weft_dataset_layout_allocate(&layout, &error), &error);
    for (int i = 0; i < layout.image_count; i++) {
        layout.light[i] = weft_direction_of_angles(weft_ubo81_angles(i % DIRECTIONS));
        layout.view[i / DIRECTIONS] = weft_direction_of_angles(weft_ubo81_angles(i / DIRECTIONS));
        layout.view_of_image[i] = i / DIRECTIONS;
    }
    for (int i = 0; i < SIZE * SIZE * 3; i++)
        samples[i] = weft_half_of_float((float)raw_value);
    expect_ok(weft_dataset_writer_create(dataset_path, &layout, &writer, &error), &error);
    for (int i = 0; i < layout.image_count; i++)
        expect_ok(weft_dataset_writer_put_image(writer, i, samples, mask, &error), &error);
    expect_ok(weft_dataset_writer_finish(writer, NULL, &error), &error);
    weft_dataset_layout_free(&layout);
}

static void show_two_models(stage *s)
{
    weft_error error = {0};
    weft_dataset *dataset;
    int skipped;
    weft_material material = make_material(1, 1, 0, 0);
    paint(&material.level[0], 0, compressed_value, compressed_value, compressed_value);
    show(s, &material);
    weft_material_free(&material);
    write_even_dataset();
    expect_ok(weft_dataset_open(dataset_path, &dataset, &error), &error);
    expect_ok(weft_player_set_dataset(s->player, dataset, NULL, &skipped, &error), &error);
    weft_dataset_close(dataset);
    unlink(dataset_path);
    spread(s, &lays[0]);
}

/* Pixels [left, right) hold `value` wherever a picture that begins at column `origin` has the plane, and nowhere else.
 */
static void expect_region(const weft_image *image, const weft_scene *scene, const caster *c, int origin, int left,
                          int right, double value)
{
    long inside = 0;
    for (int y = 1; y < HEIGHT - 1; y++) {
        for (int x = left; x < right; x++) {
            float seen = image->pixels[3 * (y * WIDTH + x)];
            meeting m = cast(c, &lays[0], x - origin, y);
            double expected = value * irradiance(scene, &m, 0, 0);
            if (all_around(c, x - origin, y, true)) {
                assert_float_equal((double)seen, expected, 0.002);
                inside++;
            } else if (all_around(c, x - origin, y, false)) {
                assert_true(fabs((double)seen - expected) > 0.02);
            }
        }
    }
    assert_true(inside > 500);
}

static void panes_and_wipes_show_each_mode_in_its_place(void **state)
{
    stage *s = *state;
    view_point from = {-80, 50, 2.6};
    weft_scene scene = scene_from(from);
    show_two_models(s);
    scene.pane_count = 2;
    scene.pane[0] = WEFT_MODE_COMPRESSED;
    scene.pane[1] = WEFT_MODE_RAW;
    scene.exposure = 2;
    weft_image panes = draw(s, &scene, 1);
    caster half = caster_of(from, WIDTH / 2, HEIGHT), whole = caster_of(from, WIDTH, HEIGHT);
    expect_region(&panes, &scene, &half, 0, 1, WIDTH / 2 - 1, compressed_value);
    expect_region(&panes, &scene, &half, WIDTH / 2, WIDTH / 2 + 1, WIDTH - 1, raw_value);
    scene.layout = WEFT_LAYOUT_WIPE;
    scene.divider = 0.4;
    weft_image wipe = draw(s, &scene, 1);
    expect_region(&wipe, &scene, &whole, 0, 1, 64, compressed_value);
    expect_region(&wipe, &scene, &whole, 0, 64, WIDTH - 1, raw_value);
    weft_image_free(&panes);
    weft_image_free(&wipe);
}

/* ---- Holes ---- */

static void through_holes_the_background_is_seen_and_nothing_is_taken_twice(void **state)
{
    stage *s = *state;
    view_point from = {-90, 90, 3};
    weft_scene scene = scene_from(from);
    weft_material material = make_material(1, 1, 0, 1);
    const double opacity = 51 / 255.0;
    paint(&material.level[0], 0, 0.25, 0.25, 0.25);
    material.view[0] = weft_vec3_of(0, 0, 1);
    memcpy(material.level[0].table, (uint8_t[4]){255, 255, 255, 51}, 4);
    show(s, &material);
    weft_material_free(&material);
    spread(s, &lays[0]);
    weft_image image = draw(s, &scene, 1);
    caster c = caster_of(from, WIDTH, HEIGHT);
    for (int y = HEIGHT / 4; y < HEIGHT * 3 / 4; y++) {
        /* The background is the same along a row. */
        double background = (double)image.pixels[3 * (y * WIDTH + 4)];
        meeting m = cast(&c, &lays[0], WIDTH / 2, y);
        double expected = 0.25 * irradiance(&scene, &m, 0, 0) + (1 - opacity) * background;
        assert_true(!cast(&c, &lays[0], 4, y).hit && background > 0.05);
        assert_float_equal((double)image.pixels[3 * (y * WIDTH + WIDTH / 2)], expected, 0.001);
    }
    weft_image_free(&image);
}

/* ---- The screen ---- */

/* IEC 61966-2-1. */
static double screen_of(double linear)
{
    linear = fmin(fmax(linear, 0), 1);
    return linear > 0.0031308 ? 1.055 * pow(linear, 1 / 2.4) - 0.055 : 12.92 * linear;
}

/* What the window would show, read back. */
static weft_image present(stage *s, const weft_scene *scene)
{
    weft_error error = {0};
    weft_canvas frame, screen;
    weft_image image;
    weft_sampling still = {.frame = 0};
    expect_ok(weft_canvas_create(WIDTH, HEIGHT, &frame, &error), &error);
    expect_ok(weft_canvas_create(WIDTH, HEIGHT, &screen, &error), &error);
    weft_canvas_begin_frame(&frame);
    expect_ok(weft_player_draw(s->player, scene, WIDTH, HEIGHT, still, &error), &error);
    weft_canvas_end_frame(&frame);
    weft_canvas_begin_frame(&screen);
    weft_canvas_present(&frame, scene, 0);
    weft_canvas_end_frame(&screen);
    expect_ok(weft_canvas_read(&screen, &image, &error), &error);
    weft_canvas_free(&frame);
    weft_canvas_free(&screen);
    return image;
}

static void the_screen_gets_srgb_from_both_twins(void **state)
{
    stage *s = *state;
    view_point from = {-60, 55, 2.2};
    weft_scene scene = scene_from(from);
    weft_material material = make_patchwork(6, 4);
    scene.level_choice = WEFT_LEVEL_NONE;
    show(s, &material);
    weft_material_free(&material);
    spread(s, &lays[0]);
    for (int dim = 0; dim < 2; dim++) {
        scene.exposure = dim ? 0.004 : 1.6;
        weft_image linear = draw(s, &scene, 1), picture = draw(s, &scene, 1), window = present(s, &scene);
        weft_scene_show(&scene, &picture);
        for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
            double expected = screen_of((double)linear.pixels[i]);
            assert_float_equal((double)picture.pixels[i], expected, 1e-4);
            assert_float_equal((double)window.pixels[i], expected, 1e-3);
        }
        weft_image_free(&linear);
        weft_image_free(&picture);
        weft_image_free(&window);
    }
}

int test_ray_caster(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_level_is_log2_of_the_longer_side_of_the_pixel),
        cmocka_unit_test(levels_are_rounded_fixed_or_left_out_as_asked),
        cmocka_unit_test(frames_see_the_length_of_a_pixel_and_levels_its_width),
        cmocka_unit_test(no_two_frames_of_a_picture_lie_in_a_row),
        cmocka_unit_test(texels_lie_where_u_and_v_say_on_both_sides),
        cmocka_unit_test(axes_follow_u_and_v_whichever_hand_they_make),
        cmocka_unit_test(panes_and_wipes_show_each_mode_in_its_place),
        cmocka_unit_test(through_holes_the_background_is_seen_and_nothing_is_taken_twice),
        cmocka_unit_test(the_screen_gets_srgb_from_both_twins),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}

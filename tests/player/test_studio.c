/* The light that a picture begins in: computed environments, shadows without acne, the ground. */
#include "base/numeric/statistics.h"
#include "player/draw/canvas.h"
#include "player/draw/ground_shadow.h"
#include "player/draw/lighting.h"
#include "player/draw/resting.h"
#include "player/scene/surroundings.h"
#include "stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 240, HEIGHT = 160, PIXELS = WIDTH * HEIGHT };

/* ---- Maps ---- */

static weft_image map_of(const char *name)
{
    weft_error error = {0};
    weft_image map;
    expect_ok(weft_surroundings_map(name, &map, &error), &error);
    return map;
}

static double green_at(const weft_image *map, double theta_deg, double phi_deg)
{
    int row = (int)(theta_deg / 180 * map->height), column = (int)((0.75 - phi_deg / 360) * map->width);
    column = (column % map->width + map->width) % map->width;
    return (double)map->pixels[3 * (row * map->width + column) + 1];
}

/* Over pi, on level ground: the mean of cos theta over bands of equal solid angle. */
static double irradiance_up(const weft_image *map)
{
    double sum = 0;
    for (int row = 0; row < map->height / 2; row++) {
        double top = WEFT_PI * row / map->height, bottom = WEFT_PI * (row + 1) / map->height, mean = 0;
        for (int x = 0; x < map->width; x++)
            mean += (double)map->pixels[3 * (row * map->width + x) + 1] / map->width;
        sum += mean * (pow(sin(bottom), 2) - pow(sin(top), 2));
    }
    return sum;
}

/* Moon and Spencer: three times as bright above as at the horizon; irradiance 7/9 pi of the zenith's radiance. */
static void the_overcast_sky_is_three_times_as_bright_above(void **state)
{
    (void)state;
    weft_image map = map_of("overcast");
    assert_float_equal(green_at(&map, 1, 0) / green_at(&map, 89, 0), 3, 0.15);
    assert_float_equal(irradiance_up(&map) / green_at(&map, 1, 0), 7.0 / 9, 0.02);
    assert_float_equal(green_at(&map, 60, 10), green_at(&map, 60, 200), 1e-6);
    weft_image_free(&map);
}

/* Brightest round the sun, as bright on either side of it, darkest about 90 degrees from it, brighter at the horizon.
 */
static void the_clear_sky_is_bright_round_its_sun(void **state)
{
    (void)state;
    weft_scene scene = weft_scene_default();
    weft_image map = map_of("sky");
    weft_surroundings_light("sky", &scene);
    double theta = weft_deg_of_rad(scene.light[0].direction.theta_rad),
           phi = weft_deg_of_rad(scene.light[0].direction.phi_rad);
    double beside = green_at(&map, theta, phi + 30), across = green_at(&map, 90 - theta, phi + 180);
    assert_true(green_at(&map, theta, phi) > 2 * beside && beside > 1.5 * across);
    assert_float_equal(green_at(&map, theta, phi - 30) / beside, 1, 0.05);
    assert_true(green_at(&map, 88, phi + 180) > 1.5 * across);
    weft_image_free(&map);
}

static void only_the_overcast_sky_has_no_key_light(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_image map;
    for (int i = 0; weft_surroundings_words[i]; i++) {
        weft_scene scene = weft_scene_default();
        weft_surroundings_light(weft_surroundings_words[i], &scene);
        assert_true(scene.environment && weft_surroundings_are(weft_surroundings_words[i]));
        assert_int_equal(scene.light_count, i == 1 ? 0 : 1);
    }
    assert_false(weft_surroundings_are("studio.hdr"));
    assert_int_equal(weft_surroundings_map("beach", &map, &error), WEFT_BAD_USAGE);
}

/* ---- Lights of a frame ---- */

static void the_key_light_fills_its_disc_and_starts_in_the_middle(void **state)
{
    (void)state;
    enum { FRAMES = 200 };
    weft_scene scene = weft_scene_default();
    scene.key_size_rad = weft_rad_of_deg(9);
    weft_vec3 middle = weft_direction_of_angles(scene.light[0].direction), sum = weft_vec3_of(0, 0, 0);
    double widest = 0, square = 0;
    for (int i = 0; i < FRAMES; i++) {
        weft_lighting lighting = weft_lighting_of(&scene, NULL, i);
        const float *d = lighting.direction[0];
        weft_vec3 at = weft_vec3_of((weft_real)d[0], (weft_real)d[1], (weft_real)d[2]);
        double angle = acos(fmin((double)weft_dot(at, middle), 1));
        assert_true(i > 0 || angle < 1e-3);
        widest = fmax(widest, angle);
        square += angle * angle / FRAMES;
        sum = weft_add(sum, at);
    }
    assert_true(widest < weft_rad_of_deg(9.1) && widest > weft_rad_of_deg(8.5));
    assert_float_equal(square, pow(weft_rad_of_deg(9), 2) / 2, 0.05 * square); /* of an even disc */
    assert_true(weft_dot(weft_unit(sum), middle) > cos(weft_rad_of_deg(0.3)));
}

/* 16 frames, which half a second has time for, leave no more than one of 64 shadows to a band. */
static void the_shadows_of_the_key_light_come_from_all_of_its_disc(void **state)
{
    (void)state;
    enum { FRAMES = 16, ALL = FRAMES * WEFT_KEY_PLACES };
    weft_scene scene = weft_scene_default();
    weft_vec3 middle = weft_direction_of_angles(scene.light[0].direction), at[ALL];
    assert_int_equal(weft_lighting_of(&scene, NULL, 3).key_count, 1);
    scene.key_size_rad = weft_rad_of_deg(9);
    assert_int_equal(weft_lighting_of(&scene, NULL, -1).key_count, 1);
    for (int frame = 0; frame < FRAMES; frame++) {
        weft_lighting lighting = weft_lighting_of(&scene, NULL, frame);
        assert_int_equal(lighting.key_count, WEFT_KEY_PLACES);
        memcpy(at + frame * WEFT_KEY_PLACES, lighting.key, sizeof lighting.key);
    }
    double square = 0;
    for (int i = 0; i < ALL; i++) {
        square += pow(acos(fmin((double)weft_dot(at[i], middle), 1)), 2) / ALL;
        for (int k = 0; k < i; k++)
            assert_true(acos(fmin((double)weft_dot(at[i], at[k]), 1)) > weft_rad_of_deg(0.3));
    }
    assert_float_equal(square, pow(weft_rad_of_deg(9), 2) / 2, 0.1 * square);
    scene.light_count = 0;
    assert_int_equal(weft_lighting_of(&scene, NULL, 0).key_count, 0);
}

/* Half of the light comes from one side: so do half of the directions. */
static void the_fill_comes_from_where_the_environment_is_bright(void **state)
{
    (void)state;
    enum { FRAMES = 128 };
    weft_error error = {0};
    weft_environment *environment = calloc(1, sizeof *environment);
    weft_scene scene = weft_scene_default();
    weft_image map;
    expect_ok(weft_image_create(64, 32, &map, &error), &error);
    for (int i = 0; i < 64 * 32; i++) {
        int x = i % 64, y = i / 64;
        for (int c = 0; c < 3; c++)
            map.pixels[3 * i + c] = y >= 16 ? 0.3f : x < 32 ? 3 : 1; /* below the horizon; x < 0; x > 0 */
    }
    expect_ok(weft_environment_of_image(&map, WEFT_ENVIRONMENT_SMOOTH_REGIONS, environment, &error), &error);
    scene.environment = true;
    double left = 0, all = 0;
    for (int i = 0; i < FRAMES; i++) {
        weft_lighting lighting = weft_lighting_of(&scene, environment, i);
        assert_int_equal(lighting.fill_count, WEFT_FILL_DIRECTIONS);
        for (int k = 0; k < lighting.fill_count; k++, all++) {
            assert_true(lighting.fill[k].z > 0);
            left += lighting.fill[k].x < 0;
        }
    }
    assert_float_equal(left / all, 0.75, 0.08);
    weft_image_free(&map);
    free(environment);
}

/* ---- Pictures ---- */

static void show(weft_player *player, const char *mesh_name)
{
    weft_error error = {0};
    weft_mesh mesh;
    weft_material material;
    expect_ok(weft_mesh_open(mesh_name, &mesh, &error), &error);
    expect_ok(weft_player_set_mesh(player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
    /* One smooth texel: what changes from pixel to pixel is shading. */
    expect_ok(weft_material_create(1, 1, 0, 0, 0, true, &material, &error), &error);
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_frame_encode(&frame, material.level[0].frame);
    for (int c = 0; c < 3; c++)
        material.level[0].diffuse[c] = weft_half_of_float(0.4f);
    material.texel_pitch_mm = 1;
    expect_ok(weft_player_set_material(player, &material, &error), &error);
    weft_material_free(&material);
}

/* No part of a ball hides another from a light that it faces. */
static void a_ball_casts_no_shadow_on_its_lit_side(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    long lit = 0;
    double darkest = 1;
    show(s->player, "sphere");
    for (int i = 0; i < 24; i++) {
        weft_surface_sample *at;
        weft_scene scene = weft_scene_default();
        scene.shadows = true;
        scene.orbit.distance = 1.5 + 0.3 * i;
        scene.light[0].direction = (weft_angles){weft_rad_of_deg(3.7 * i), weft_rad_of_deg(-160 + 13 * i)};
        expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error),
                  &error);
        for (int k = 0; k < PIXELS; k++) {
            /* At its rim a ball of triangles shows their backs. */
            if (at[k].covered == 0 || at[k].light[2] < 0.03f || at[k].view[2] < 0.05f)
                continue;
            lit++;
            darkest = fmin(darkest, (double)at[k].key_share);
        }
        free(at);
    }
    printf("%ld pixels, the least share of the light is %.4f\n", lit, darkest);
    assert_true(lit > 100000);
    assert_true(darkest > 0.999);
}

/* Pixels that see part of the key light, but neither nearly all nor nearly nothing of it. */
static long partly_shaded(weft_player *player, double key_size_deg)
{
    weft_error error = {0};
    weft_surface_sample *at;
    weft_scene scene = weft_scene_default();
    long count = 0;
    scene.shadows = true;
    scene.key_size_rad = weft_rad_of_deg(key_size_deg);
    expect_ok(weft_player_read_surface(player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error), &error);
    for (int k = 0; k < PIXELS; k++)
        count += at[k].covered > 0 && at[k].key_share > 0.2f && at[k].key_share < 0.8f;
    free(at);
    return count;
}

static void a_large_key_light_has_a_penumbra_in_the_first_frame(void **state)
{
    stage *s = *state;
    show(s->player, "drape");
    long small = partly_shaded(s->player, 0), large = partly_shaded(s->player, 9);
    printf("%ld pixels are partly shaded from a key light of 9 degrees, %ld from one without size\n", large, small);
    assert_true(large > 3 * small);
}

static float largest_step(const weft_image *image, const weft_surface_sample *at, float quantile, float *value)
{
    size_t count = 0;
    for (int k = 0; k < PIXELS - 1; k++) {
        if (at[k].covered > 0 && at[k + 1].covered > 0)
            value[count++] = fabsf(image->pixels[3 * k] - image->pixels[3 * k + 3]);
    }
    return weft_quantile_of_floats(value, count, quantile);
}

/* What shadows change from a pixel to the next, where the ball is lit and not seen from the rim. */
static float largest_added_step(const weft_image image[2], const weft_surface_sample *at)
{
    float largest = 0;
    for (int k = 0; k < PIXELS - 1; k++) {
        bool inside = at[k].covered > 0 && at[k + 1].covered > 0 && fminf(at[k].view[2], at[k + 1].view[2]) > 0.05f;
        float before = image[0].pixels[3 * k] - image[0].pixels[3 * k + 3];
        float after = image[1].pixels[3 * k] - image[1].pixels[3 * k + 3];
        largest = inside ? fmaxf(largest, fabsf(after - before)) : largest;
    }
    return largest;
}

/* Shadows of triangles on the cloth that they make up would be its strongest edges. */
static void smooth_cloth_has_no_stronger_edge_with_shadows_than_without(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    float *value = malloc(PIXELS * sizeof *value);
    show(s->player, "sphere");
    for (int i = 0; i < 8; i++) {
        weft_image image[2];
        weft_surface_sample *at;
        weft_scene scene = weft_scene_default();
        scene.light[0].direction = (weft_angles){weft_rad_of_deg(11 * i), weft_rad_of_deg(-70 + 40 * i)};
        expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error),
                  &error);
        for (int k = 0; k < 2; k++) {
            scene.shadows = k;
            expect_ok(weft_player_picture(s->player, &scene, WIDTH, HEIGHT, 1, NULL, &image[k], &error), &error);
        }
        float added = largest_added_step(image, at), usual = largest_step(&image[0], at, 0.99f, value);
        print_message("light %d: shadows add a step of %.5f, 99th percentile of steps %.5f\n", i, (double)added,
                      (double)usual);
        assert_true(added < usual);
        free(at);
        weft_image_free(&image[0]);
        weft_image_free(&image[1]);
    }
    free(value);
}

static weft_scene studio(weft_player *player, const char *name, int regions)
{
    weft_error error = {0};
    weft_image map = map_of(name);
    weft_scene scene = weft_scene_default();
    expect_ok(weft_player_set_environment(player, &map, regions, &error), &error);
    weft_image_free(&map);
    weft_surroundings_light(name, &scene);
    scene.shadows = scene.ground = true;
    return scene;
}

static weft_image picture_of(weft_player *player, const weft_scene *scene)
{
    weft_error error = {0};
    weft_image image;
    expect_ok(weft_player_picture(player, scene, WIDTH, HEIGHT, 1, NULL, &image, &error), &error);
    return image;
}

/* The mean of the squares of what a picture lacks, of blocks of so many pixels in the mean. */
static double lack(const weft_image *image, const weft_image *whole, int across, int up)
{
    double sum = 0;
    for (int y = 0; y + up <= HEIGHT; y += up) {
        for (int x = 0; x + across <= WIDTH; x += across) {
            double block = 0;
            for (int k = 0; k < across * up; k++) {
                int at = 3 * ((y + k / across) * WIDTH + x + k % across);
                block += (double)(image->pixels[at] - whole->pixels[at]) / (across * up);
            }
            sum += block * block * across * up / PIXELS;
        }
    }
    return sum;
}

/* What a frame lacks is grain, which is gone where eight pixels are looked at together: the whole picture leans little.
 */
static void neighbouring_pixels_are_lit_from_other_places(void **state)
{
    stage *s = *state;
    show(s->player, "drape");
    weft_scene scene = studio(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    scene.shadows = scene.ground = false;
    scene.light_count = 0;
    weft_image one = picture_of(s->player, &scene);
    scene.environment_reference = true;
    weft_image all = picture_of(s->player, &scene);
    double grain = lack(&one, &all, 1, 1), rest = lack(&one, &all, 4, 2);
    printf("a frame lacks %.2e, of which %.2e remain in blocks of eight pixels\n", grain, rest);
    assert_true(rest < 0.1 * grain);
    weft_image_free(&one);
    weft_image_free(&all);
}

static void cloth_stands_on_a_ground_that_takes_its_shadow(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_surface_sample *at;
    float *share = malloc(PIXELS * sizeof *share);
    for (int i = 0; weft_surroundings_words[i]; i++) {
        show(s->player, "drape");
        weft_scene scene = studio(s->player, weft_surroundings_words[i], WEFT_ENVIRONMENT_SMOOTH_REGIONS);
        weft_image image = picture_of(s->player, &scene);
        expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error),
                  &error);
        scene.shadows = false;
        weft_image without = picture_of(s->player, &scene);
        scene.exposure = 3;
        weft_image brighter = picture_of(s->player, &scene);
        size_t count = 0;
        for (int k = 0; k < PIXELS; k++) {
            if (at[k].covered > 0)
                continue;
            share[count++] = image.pixels[3 * k + 1] / without.pixels[3 * k + 1];
            assert_float_equal(brighter.pixels[3 * k + 1], without.pixels[3 * k + 1], 1e-4);
        }
        float deepest = weft_quantile_of_floats(share, count, 0.002f),
              usual = weft_quantile_of_floats(share, count, 0.8f);
        print_message("%s: %.3f of the light in the deepest shadow on the ground, %.3f far from it\n",
                      weft_surroundings_words[i], (double)deepest, (double)usual);
        assert_true(deepest < 0.8 && deepest > 0.02 && usual > 0.98 && usual <= 1.0001f);
        free(at);
        weft_image_free(&image);
        weft_image_free(&without);
        weft_image_free(&brighter);
    }
    free(share);
}

/* ---- What the ground sees of the lights ---- */

/* As likely as they bring light to level ground: bright and high ones more often. */
static void the_light_of_the_ground_comes_as_often_as_it_is_bright_there(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_image map = map_of("studio");
    weft_environment *environment = calloc(1, sizeof *environment);
    weft_scene scene = studio(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    expect_ok(weft_environment_of_image(&map, WEFT_ENVIRONMENT_SMOOTH_REGIONS, environment, &error), &error);
    double wanted[3] = {0}, found[3] = {0}, all = 0;
    for (int i = 0; i < WEFT_ENVIRONMENT_PARTS * environment->region_count; i++) {
        const weft_distant_light *light =
            &environment->part[i / environment->region_count][i % environment->region_count];
        double weight = fmax((double)light->direction.z, 0) *
                        (double)(light->irradiance[0] + light->irradiance[1] + light->irradiance[2]);
        wanted[0] += weight * (double)light->direction.x;
        wanted[1] += weight * (double)light->direction.y;
        wanted[2] += weight * (double)light->direction.z;
        all += weight;
    }
    for (int i = 0; i < WEFT_GROUND_DIRECTIONS; i++) {
        weft_vec3 light = weft_lighting_ground_place(&scene, environment, i);
        assert_true(light.z > 0);
        found[0] += (double)light.x / WEFT_GROUND_DIRECTIONS;
        found[1] += (double)light.y / WEFT_GROUND_DIRECTIONS;
        found[2] += (double)light.z / WEFT_GROUND_DIRECTIONS;
    }
    for (int c = 0; c < 3; c++)
        assert_float_equal(found[c], wanted[c] / all, 0.02);
    weft_image_free(&map);
    free(environment);
}

typedef struct ball {
    weft_vec3 centre;
    double radius;
} ball;

static ball ball_of_mesh(void)
{
    weft_error error = {0};
    weft_mesh mesh;
    float centre[3], radius;
    expect_ok(weft_mesh_open("sphere", &mesh, &error), &error);
    weft_mesh_bounds(&mesh, centre, &radius);
    weft_mesh_free(&mesh);
    return (ball){weft_vec3_of((weft_real)centre[0], (weft_real)centre[1], (weft_real)centre[2]), (double)radius};
}

/* The place of the ground that a pixel shows. */
static weft_vec3 place_on_ground(const weft_scene *scene, const ball *b, int pixel)
{
    weft_orbit_axes ray = weft_orbit_rays(&scene->orbit, WIDTH, HEIGHT, 0, 0);
    double x = pixel % WIDTH + 0.5, y = HEIGHT - (pixel / WIDTH + 0.5);
    weft_vec3 along = weft_subtract(weft_add(weft_scale(ray.right, (weft_real)x), weft_scale(ray.up, (weft_real)y)),
                                    ray.backward),
              eye = weft_orbit_eye(&scene->orbit, b->centre, b->radius);
    weft_real ground = b->centre.z - (weft_real)b->radius;
    return weft_add(eye, weft_scale(along, (ground - eye.z) / along.z));
}

/* The share of the key light that a ball on level ground leaves a place there. */
static double seen_beside_ball(const weft_scene *scene, const ball *b, weft_vec3 place)
{
    enum { DIRECTIONS = 200 };
    weft_vec3 toward = weft_subtract(b->centre, place);
    int hidden = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        weft_vec3 light = weft_lighting_key_place(scene, i);
        double along = (double)weft_dot(toward, light);
        hidden += along > 0 && (double)weft_dot(toward, toward) - along * along < b->radius * b->radius;
    }
    return 1 - (double)hidden / DIRECTIONS;
}

/* Where a ball casts its shadow is plain geometry: from a small and from a large light. */
static void the_shadow_of_a_ball_lies_where_geometry_has_it(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    ball b = ball_of_mesh();
    show(s->player, "sphere");
    for (int i = 0; i < 4; i++) {
        weft_surface_sample *at;
        weft_scene scene = weft_scene_default();
        scene.orbit.distance = 8;
        scene.light[0].direction = (weft_angles){weft_rad_of_deg(20 + 11 * i), weft_rad_of_deg(-60 + 90 * i)};
        scene.key_size_rad = i % 2 ? weft_rad_of_deg(9) : 0;
        scene.ground = true;
        weft_image without = picture_of(s->player, &scene);
        scene.shadows = true;
        weft_image image = picture_of(s->player, &scene);
        expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error),
                  &error);
        double off = 0;
        long count = 0, shaded = 0;
        for (int k = 0; k < PIXELS; k++) {
            weft_vec3 place = place_on_ground(&scene, &b, k), away = weft_subtract(place, b.centre);
            if (at[k].covered > 0 || weft_dot(away, away) > (weft_real)(6 * b.radius * b.radius))
                continue;
            double expected = seen_beside_ball(&scene, &b, place);
            off += fabs((double)(image.pixels[3 * k] / without.pixels[3 * k]) - expected);
            shaded += expected < 0.5;
            count++;
        }
        printf("light %d: %ld of %ld places are shaded, shares are off by %.4f\n", i, shaded, count,
               off / (double)count);
        assert_true(shaded > 300);
        assert_true(off < 0.004 * (double)count);
        free(at);
        weft_image_free(&image);
        weft_image_free(&without);
    }
}

/* Levels of 255 that two pictures of the drape differ by on its ground, in the mean of squares. */
static double difference_on_ground(weft_player *player, const weft_scene *scene, const weft_image *a,
                                   const weft_image *b)
{
    weft_error error = {0};
    weft_surface_sample *at;
    double sum = 0;
    long count = 0;
    expect_ok(weft_player_read_surface(player, scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error), &error);
    for (int k = 1; k < PIXELS - 1; k++) {
        if (at[k - 1].covered > 0 || at[k].covered > 0 || at[k + 1].covered > 0)
            continue;
        sum += pow(255 * (double)(a->pixels[3 * k] - b->pixels[3 * k]), 2);
        count++;
    }
    free(at);
    return sqrt(sum / (double)count);
}

/* One frame, after so many that moved, very small, in which the camera turned. */
static weft_image frame_at_rest(weft_player *player, const weft_scene *scene, int moving)
{
    weft_error error = {0};
    weft_canvas canvas;
    weft_image image;
    weft_scene moved = *scene;
    expect_ok(weft_canvas_create(WIDTH, HEIGHT, &canvas, &error), &error);
    for (int i = 0; i < moving; i++) {
        moved.orbit.azimuth_rad += 0.01;
        weft_canvas_begin_small_frame(&canvas, 0.05);
        expect_ok(weft_player_draw(player, &moved, canvas.drawn_width, canvas.drawn_height,
                                   (weft_sampling){.frame = -1}, &error),
                  &error);
    }
    weft_canvas_clear(&canvas);
    weft_canvas_begin_frame(&canvas);
    expect_ok(weft_player_draw(player, scene, WIDTH, HEIGHT, (weft_sampling){.frame = 0}, &error), &error);
    weft_canvas_end_frame(&canvas);
    expect_ok(weft_canvas_read(&canvas, &image, &error), &error);
    weft_canvas_free(&canvas);
    return image;
}

/* Its light is that of many frames, in the first one at rest. */
static void the_ground_is_whole_when_a_camera_comes_to_rest(void **state)
{
    stage *s = *state;
    show(s->player, "drape");
    weft_scene scene = studio(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    weft_image early = frame_at_rest(s->player, &scene, 0), late = frame_at_rest(s->player, &scene, 60),
               whole = picture_of(s->player, &scene);
    double early_off = difference_on_ground(s->player, &scene, &early, &whole),
           late_off = difference_on_ground(s->player, &scene, &late, &whole);
    printf("the ground is off by %.3f levels of 255 at once, by %.3f after the camera has moved\n", early_off,
           late_off);
    assert_true(late_off < 0.5 && early_off > 1.5 * late_off);
    weft_image_free(&early);
    weft_image_free(&late);
    weft_image_free(&whole);
}

static void expect_new_ground(weft_player *player, const weft_scene *scene)
{
    weft_image after = picture_of(player, scene);
    show(player, "drape");
    weft_image fresh = picture_of(player, scene);
    assert_memory_equal(after.pixels, fresh.pixels, 3 * sizeof(float) * PIXELS);
    weft_image_free(&after);
    weft_image_free(&fresh);
}

/* Whatever was drawn before. */
static void another_light_casts_another_shadow_on_the_ground(void **state)
{
    stage *s = *state;
    show(s->player, "drape");
    weft_scene scene = studio(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS), first = scene;
    weft_image before = picture_of(s->player, &scene);
    scene.light[0].direction.theta_rad += 0.2;
    scene.light[0].direction.phi_rad += 0.5;
    expect_new_ground(s->player, &scene);
    scene.key_size_rad *= 0.3;
    expect_new_ground(s->player, &scene);
    scene.environment_turn_rad += 1;
    expect_new_ground(s->player, &scene);
    scene = studio(s->player, "overcast", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    expect_new_ground(s->player, &scene);
    studio(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    weft_image again = picture_of(s->player, &first);
    assert_memory_equal(before.pixels, again.pixels, 3 * sizeof(float) * PIXELS);
    weft_image_free(&before);
    weft_image_free(&again);
}

static weft_image frame_of(weft_player *player, const weft_scene *scene, weft_sampling sampling)
{
    weft_error error = {0};
    weft_canvas canvas;
    weft_image image;
    expect_ok(weft_canvas_create(WIDTH, HEIGHT, &canvas, &error), &error);
    weft_canvas_begin_frame(&canvas);
    expect_ok(weft_player_draw(player, scene, WIDTH, HEIGHT, sampling, &error), &error);
    weft_canvas_end_frame(&canvas);
    expect_ok(weft_canvas_read(&canvas, &image, &error), &error);
    weft_canvas_free(&canvas);
    return image;
}

/* Green of 255 that the darkest hundredth of the pixels shows whose middle and whose neighbours lie on cloth. */
static double dark_on_screen(weft_player *player, const weft_scene *scene, weft_image *image)
{
    weft_error error = {0};
    weft_surface_sample *at;
    float dark[PIXELS];
    size_t count = 0;
    expect_ok(weft_player_read_surface(player, scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error), &error);
    weft_scene_show(scene, image);
    for (int k = WIDTH; k < PIXELS - WIDTH; k++) {
        bool is_inside = at[k].covered > 0 && at[k - 1].covered > 0 && at[k + 1].covered > 0 &&
                         at[k - WIDTH].covered > 0 && at[k + WIDTH].covered > 0;
        if (is_inside)
            dark[count++] = image->pixels[3 * k + 1];
    }
    free(at);
    weft_image_free(image);
    return 255 * (double)weft_quantile_of_floats(dark, count, 0.01);
}

/* Before the means of many frames: few directions of the environment cast shadows, and a fold may see none of them. */
static void folds_are_not_black_in_the_frames_that_stand_alone(void **state)
{
    stage *s = *state;
    show(s->player, "drape");
    weft_scene scene = studio(s->player, "studio", WEFT_ENVIRONMENT_SMOOTH_REGIONS);
    scene.light_count = 0;
    weft_image moving = frame_of(s->player, &scene, (weft_sampling){.frame = -1, .hurry = true}),
               first = frame_of(s->player, &scene, weft_sampling_at_rest(0)), whole = picture_of(s->player, &scene);
    double of_moving = dark_on_screen(s->player, &scene, &moving), of_first = dark_on_screen(s->player, &scene, &first),
           of_whole = dark_on_screen(s->player, &scene, &whole);
    print_message("the darkest hundredth: %.0f moving, %.0f of the first frame, %.0f of the whole picture\n", of_moving,
                  of_first, of_whole);
    assert_true(of_moving > 12 && of_first > 12);
}

/* On the screen, of 255: deep in a fold, facing away from every lamp. */
static void unlit_folds_are_not_black_and_lit_ones_not_white(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_surface_sample *at;
    for (int i = 0; weft_surroundings_words[i]; i++) {
        show(s->player, "drape");
        weft_scene scene = studio(s->player, weft_surroundings_words[i], WEFT_ENVIRONMENT_SMOOTH_REGIONS);
        scene.tone = WEFT_TONE_SOFT;
        weft_image image = picture_of(s->player, &scene);
        expect_ok(weft_player_read_surface(s->player, &scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &at, &error),
                  &error);
        weft_scene_show(&scene, &image);
        float darkest = 1, brightest = 0;
        for (int k = 0; k < PIXELS; k++) {
            for (int c = 0; at[k].covered > 0 && c < 3; c++) {
                darkest = fminf(darkest, image.pixels[3 * k + c]);
                brightest = fmaxf(brightest, image.pixels[3 * k + c]);
            }
        }
        print_message("%s: from %.0f to %.0f of 255\n", weft_surroundings_words[i], 255 * (double)darkest,
                      255 * (double)brightest);
        assert_true(darkest > 12.0f / 255 && brightest < 250.0f / 255);
        free(at);
        weft_image_free(&image);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_overcast_sky_is_three_times_as_bright_above),
        cmocka_unit_test(the_clear_sky_is_bright_round_its_sun),
        cmocka_unit_test(only_the_overcast_sky_has_no_key_light),
        cmocka_unit_test(the_key_light_fills_its_disc_and_starts_in_the_middle),
        cmocka_unit_test(the_shadows_of_the_key_light_come_from_all_of_its_disc),
        cmocka_unit_test(the_fill_comes_from_where_the_environment_is_bright),
        cmocka_unit_test(a_ball_casts_no_shadow_on_its_lit_side),
        cmocka_unit_test(a_large_key_light_has_a_penumbra_in_the_first_frame),
        cmocka_unit_test(smooth_cloth_has_no_stronger_edge_with_shadows_than_without),
        cmocka_unit_test(cloth_stands_on_a_ground_that_takes_its_shadow),
        cmocka_unit_test(the_light_of_the_ground_comes_as_often_as_it_is_bright_there),
        cmocka_unit_test(the_shadow_of_a_ball_lies_where_geometry_has_it),
        cmocka_unit_test(the_ground_is_whole_when_a_camera_comes_to_rest),
        cmocka_unit_test(another_light_casts_another_shadow_on_the_ground),
        cmocka_unit_test(neighbouring_pixels_are_lit_from_other_places),
        cmocka_unit_test(folds_are_not_black_in_the_frames_that_stand_alone),
        cmocka_unit_test(unlit_folds_are_not_black_and_lit_ones_not_white),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}

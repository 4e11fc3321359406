/* Draped cloth from geometry beside the dataset and the material made of it. Skipped without OpenGL. */
#include "base/atomic_file.h"
#include "compare/truth/comparison.h"
#include "compress/compress.h"
#include "geometry/acquisition/acquisition.h"
#include "player/draw/player.h"
#include "player/gl/context.h"
#include "tests/compare/fixture.h"
#include "tests/support/suite.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXELS = 8, DIRECTIONS = 8, CELLS = 20, BOUNCES = 1, SIDE = 96 };

static const double noise = 0.03;

static void overwrite(char *at, const char *with)
{
    for (; *with; with++)
        *at++ = *with;
}

/* The shipped plain weave on a coarse grid, so that hundreds of tiles are few triangles. */
static void write_stitch(const char *path, const char *name)
{
    char *text, *at;
    size_t size;
    weft_error error = {0};
    expect_ok(weft_read_file(WEFT_ASSETS "/stitches/plain_weave.stitch", 1 << 20, &text, &size, &error), &error);
    at = strstr(text, "resolution = 54");
    assert_non_null(at);
    overwrite(at, "resolution = 20");
    at = strstr(text, "\"Plain weave\"");
    assert_non_null(at);
    overwrite(at, name);
    expect_ok(weft_write_file(path, text, size, &error), &error);
    free(text);
}

static void simulate(const char *path)
{
    weft_stitch stitch;
    weft_tile_mesh tile;
    weft_vec3 direction[DIRECTIONS];
    weft_acquisition_options options = {
        .width = TEXELS, .height = TEXELS, .bounces = BOUNCES, .noise = noise, .seed = 1};
    weft_acquisition_report report;
    weft_error error = {0};
    for (int i = 0; i < DIRECTIONS; i++)
        direction[i] = weft_acquisition_direction(i * 9);
    expect_ok(weft_stitch_read("weave.stitch", &stitch, &error), &error);
    expect_ok(weft_tile_mesh_create(&stitch, 0, "weave.stitch", &tile, &error), &error);
    expect_ok(weft_acquire(&stitch, &tile, direction, DIRECTIONS, &options, path, NULL, &report, &error), &error);
    weft_tile_mesh_free(&tile);
    weft_stitch_free(&stitch);
}

static int make_files(void **state)
{
    (void)state;
    write_stitch("weave.stitch", "\"Plain weave\"");
    write_stitch("other.stitch", "\"Other weave\"");
    simulate("weave.btf.h5");
    return 0;
}

/* A square of tiles in the plane, and the cloth on it. */
typedef struct flat_cloth {
    weft_stitch stitch;
    weft_tile_mesh tile;
    weft_mesh plane;
    weft_truth_base base;
    weft_draped_cloth *cloth;
} flat_cloth;

static void lay_flat(flat_cloth *flat, double repeat)
{
    weft_error error = {0};
    expect_ok(weft_stitch_read("weave.stitch", &flat->stitch, &error), &error);
    expect_ok(weft_tile_mesh_create(&flat->stitch, 0, "weave.stitch", &flat->tile, &error), &error);
    expect_ok(weft_mesh_plane(&flat->plane, &error), &error);
    expect_ok(weft_truth_base_create(&flat->plane, repeat, flat->stitch.width, &flat->base, &error), &error);
    expect_ok(weft_draped_cloth_create(&flat->stitch, &flat->tile, &flat->base.surface, &flat->cloth, &error), &error);
}

static void take_up(flat_cloth *flat)
{
    weft_draped_cloth_free(flat->cloth);
    weft_truth_base_free(&flat->base);
    weft_mesh_free(&flat->plane);
    weft_tile_mesh_free(&flat->tile);
    weft_stitch_free(&flat->stitch);
}

/* A camera far away in a direction of the dataset, under one of its lights. */
static weft_scene distant_scene(int view, int light, double repeat)
{
    weft_scene scene = weft_scene_default();
    weft_angles from = weft_angles_of_direction(weft_acquisition_direction(view * 9));
    scene.orbit = (weft_orbit){from.phi_rad, WEFT_PI / 2 - from.theta_rad, 25, 0, 0};
    scene.light[0].direction = weft_angles_of_direction(weft_acquisition_direction(light * 9));
    scene.repeat = repeat;
    scene.labels = false;
    scene.pane[0] = WEFT_MODE_RAW;
    return scene;
}

/* The middle of a picture, about a third of the distant plane across. */
static double middle(const weft_image *image, int channel)
{
    double sum = 0;
    for (int y = SIDE / 2 - 2; y < SIDE / 2 + 2; y++)
        for (int x = SIDE / 2 - 2; x < SIDE / 2 + 2; x++)
            sum += (double)image->pixels[3 * (y * SIDE + x) + channel] / 16;
    return sum;
}

static weft_traced trace(const flat_cloth *flat, const weft_scene *scene, int side, int paths, uint64_t seed)
{
    weft_image background;
    weft_traced traced;
    weft_error error = {0};
    const weft_trace_options options = {side, side, paths, BOUNCES, 1000, seed};
    expect_ok(weft_image_create(side, side, &background, &error), &error);
    for (int i = 0; i < 3 * side * side; i++)
        background.pixels[i] = 0;
    expect_ok(weft_trace(flat->cloth, &flat->plane, flat->base.mm_per_unit, scene, &options, &background, NULL, &traced,
                         &error),
              &error);
    weft_image_free(&background);
    return traced;
}

/* The mean of all texels in one image of the dataset. */
static double mean_of_image(int image, int channel)
{
    static weft_half sample[TEXELS * TEXELS][DIRECTIONS * DIRECTIONS][3];
    weft_dataset *dataset;
    weft_error error = {0};
    double sum = 0;
    expect_ok(weft_dataset_open("weave.btf.h5", &dataset, &error), &error);
    expect_ok(weft_dataset_read_block(dataset, 0, 0, TEXELS, TEXELS, &sample[0][0][0], NULL, &error), &error);
    for (int i = 0; i < TEXELS * TEXELS; i++)
        sum += (double)weft_float_of_half(sample[i][image][channel]) / (TEXELS * TEXELS);
    weft_dataset_close(dataset);
    return sum;
}

static void a_large_plane_far_away_has_the_mean_of_the_dataset(void **state)
{
    (void)state;
    enum { REPEAT = 12 };
    flat_cloth flat;
    lay_flat(&flat, REPEAT);
    for (int view = 0; view < 5; view += suite_argument ? 2 : 4) {
        int light = (view + 3) % DIRECTIONS;
        weft_scene scene = distant_scene(view, light, REPEAT);
        weft_traced traced = trace(&flat, &scene, SIDE, 512, 1);
        for (int c = 0; c < 3; c++) {
            double expected = mean_of_image(view * DIRECTIONS + light, c);
            assert_float_equal(middle(&traced.all, c), expected, noise * expected);
            assert_float_equal(middle(&traced.near, c), middle(&traced.all, c), 1e-6);
        }
        weft_traced_free(&traced);
    }
    take_up(&flat);
}

static weft_player *player_of(const flat_cloth *flat)
{
    weft_player *player;
    weft_dataset *dataset;
    int skipped;
    weft_error error = {0};
    expect_ok(weft_player_create(&player, &error), &error);
    expect_ok(weft_player_set_mesh(player, &flat->plane, &error), &error);
    expect_ok(weft_dataset_open("weave.btf.h5", &dataset, &error), &error);
    expect_ok(weft_player_set_dataset(player, dataset, NULL, &skipped, &error), &error);
    weft_dataset_close(dataset);
    return player;
}

/* The player, too, shows that mean: camera, light and surface are the same for both. */
static void the_player_shows_that_plane_alike(void **state)
{
    (void)state;
    enum { REPEAT = 12 };
    flat_cloth flat;
    weft_headless *headless;
    weft_image raw;
    weft_error error = {0};
    if (weft_headless_create(WEFT_GL_CORE, &headless, &error) != WEFT_OK)
        skip();
    lay_flat(&flat, REPEAT);
    weft_player *player = player_of(&flat);
    weft_scene scene = distant_scene(3, 1, REPEAT);
    expect_ok(weft_player_picture(player, &scene, SIDE, SIDE, 2, NULL, &raw, &error), &error);
    weft_traced traced = trace(&flat, &scene, SIDE, 512, 1);
    for (int c = 0; c < 3; c++)
        assert_float_equal(middle(&raw, c), middle(&traced.all, c), 2 * noise * middle(&traced.all, c));
    weft_traced_free(&traced);
    weft_image_free(&raw);
    weft_player_free(player);
    weft_headless_free(headless);
    take_up(&flat);
}

/* Relative RMSE of the middle of two pictures, the second shifted. */
static double apart(const weft_image *truth, const weft_image *raw, int half, int shift_x, int shift_y)
{
    double errors = 0, squares = 0;
    for (int y = truth->height / 2 - half; y < truth->height / 2 + half; y++) {
        for (int x = truth->width / 2 - half; x < truth->width / 2 + half; x++) {
            double t = (double)truth->pixels[3 * (y * truth->width + x)];
            double r = (double)raw->pixels[3 * ((y + shift_y) * raw->width + x + shift_x)];
            errors += (t - r) * (t - r);
            squares += t * t;
        }
    }
    return sqrt(errors / squares);
}

/* Seen and lit from directions of the dataset nothing is interpolated but texels: any shift makes it worse. */
static void yarns_lie_where_the_truth_has_them(void **state)
{
    (void)state;
    enum { REPEAT = 6, LARGE = 512, HALF = 9 };
    static const int shift[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    flat_cloth flat;
    weft_headless *headless;
    weft_player *player;
    weft_image raw;
    weft_error error = {0};
    if (weft_headless_create(WEFT_GL_CORE, &headless, &error) != WEFT_OK)
        skip();
    lay_flat(&flat, REPEAT);
    player = player_of(&flat);
    for (int view = suite_argument ? 0 : 3; view < 4; view += 3) {
        weft_scene scene = distant_scene(view, 1, REPEAT);
        expect_ok(weft_player_picture(player, &scene, LARGE, LARGE, 4, NULL, &raw, &error), &error);
        weft_traced traced = trace(&flat, &scene, LARGE, 64, 1);
        double best = apart(&traced.all, &raw, HALF, 0, 0);
        assert_true(best < 0.2);
        for (int i = 0; i < 4; i++)
            assert_true(best < apart(&traced.all, &raw, HALF, shift[i][0], shift[i][1]));
        weft_traced_free(&traced);
        weft_image_free(&raw);
    }
    weft_player_free(player);
    weft_headless_free(headless);
    take_up(&flat);
}

static void seeds_tell_pictures_apart_and_threads_do_not(void **state)
{
    (void)state;
    enum { SMALL = 24 };
    flat_cloth flat;
    lay_flat(&flat, 3);
    weft_scene scene = distant_scene(0, 1, 3);
    scene.orbit.distance = 3;
    omp_set_num_threads(1);
    weft_traced one = trace(&flat, &scene, SMALL, 16, 1);
    omp_set_num_threads(3);
    weft_traced many = trace(&flat, &scene, SMALL, 16, 1), other = trace(&flat, &scene, SMALL, 16, 2);
    size_t bytes = 3 * SMALL * SMALL * sizeof(float);
    assert_memory_equal(one.all.pixels, many.all.pixels, bytes);
    assert_memory_equal(one.near.pixels, many.near.pixels, bytes);
    assert_true(one.noise == many.noise);
    assert_memory_not_equal(one.all.pixels, other.all.pixels, bytes);
    /* The stated noise is that between seeds. */
    double difference = 0, square = 0;
    for (int i = 0; i < 3 * SMALL * SMALL; i++) {
        double a = (double)one.all.pixels[i], b = (double)other.all.pixels[i];
        difference += (a - b) * (a - b) / 2;
        square += (a * a + b * b) / 2;
    }
    double between = sqrt(difference / square);
    assert_true(between > 0.7 * one.noise && between < 1.4 * one.noise);
    weft_traced_free(&one);
    weft_traced_free(&many);
    weft_traced_free(&other);
    take_up(&flat);
}

static double sum_of(const weft_image *image)
{
    double sum = 0;
    for (size_t i = 0; i < 3 * (size_t)image->width * (size_t)image->height; i++)
        sum += (double)image->pixels[i];
    return sum;
}

static void check_scene(const weft_truth_scene *scene)
{
    const weft_truth_pictures *all = &scene->under[WEFT_TRUTH_ALL], *near = &scene->under[WEFT_TRUTH_NEAR];
    for (int model = 0; model < WEFT_TRUTH_MODELS; model++) {
        /* Folds shade each other more than they light each other. */
        assert_true(sum_of(&all->picture[model]) > 0.5 * sum_of(&near->picture[model]));
        assert_true(sum_of(&all->picture[model]) < sum_of(&near->picture[model]));
    }
    for (int light = 0; light < WEFT_TRUTH_LIGHTS; light++) {
        for (int model = 0; model < WEFT_TRUTH_TRACED; model++) {
            const weft_truth_error *e = &scene->under[light].error[model];
            /* Nothing is exact, and blocks forgive where the yarns lie. */
            assert_true(e->error.count > 5000);
            assert_true(e->error.relative_rmse > scene->noise && e->error.relative_rmse < 1);
            assert_true(e->block_relative_rmse > 0 && e->block_relative_rmse < e->error.relative_rmse);
            assert_true(e->error.psnr_db > 5 && e->error.psnr_db < 40);
        }
        /* The dataset alone has a plane: drawn without it, it is another picture, and a worse one. */
        const weft_truth_pictures *under = &scene->under[light];
        double flat = under->flat[WEFT_TRUTH_RAW].error.relative_rmse,
               played = under->error[WEFT_TRUTH_RAW].error.relative_rmse;
        printf("raw %.4f, without heights %.4f\n", played, flat);
        assert_int_equal(under->flat[WEFT_TRUTH_RAW].error.count, under->error[WEFT_TRUTH_RAW].error.count);
        assert_int_equal(under->flat[WEFT_TRUTH_COMPRESSED].error.count, 0);
        assert_true(flat > 1.0005 * played);
    }
}

static void the_drape_is_drawn_in_every_scene_and_measured(void **state)
{
    (void)state;
    weft_traced_truth truth;
    weft_dataset *dataset;
    weft_material material;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    weft_error error = {0};
    options.lobe_count = 1;
    expect_ok(weft_dataset_put_relief("weave.btf.h5", "weave.btf.h5", -0.15, NULL, "{}", &error), &error);
    expect_ok(weft_dataset_open("weave.btf.h5", &dataset, &error), &error);
    expect_ok(weft_compress(dataset, &options, NULL, &material, NULL, &error), &error);
    weft_traced_request request = {
        .dataset = dataset, .material = &material, .stitch = "weave.stitch", .side = 112, .paths = 2, .seed = 1};
    expect_ok(weft_traced_truth_measure(&request, NULL, &truth, &error), &error);
    bool drawn = truth.drawn;
    if (drawn) {
        assert_string_equal(truth.warning, "");
        assert_int_equal(truth.bounces, BOUNCES);
        assert_int_equal(truth.cells, CELLS);
        for (int i = 0; i < WEFT_TRUTH_SCENE_COUNT; i++)
            check_scene(&truth.scene[i]);
        weft_traced_truth_free(&truth);
        request.stitch = "other.stitch";
        request.paths = 1;
        request.side = 16;
        expect_ok(weft_traced_truth_measure(&request, NULL, &truth, &error), &error);
        assert_non_null(strstr(truth.warning, "'Plain weave', the truth is traced from 'Other weave'"));
        weft_traced_truth_free(&truth);
        request.stitch = "none.stitch";
        assert_int_equal(weft_class_of(weft_traced_truth_measure(&request, NULL, &truth, &error)), WEFT_BAD_INPUT);
    }
    weft_material_free(&material);
    weft_dataset_close(dataset);
    if (!drawn)
        skip();
}

int test_truth(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_large_plane_far_away_has_the_mean_of_the_dataset),
        cmocka_unit_test(the_player_shows_that_plane_alike),
        cmocka_unit_test(yarns_lie_where_the_truth_has_them),
        cmocka_unit_test(seeds_tell_pictures_apart_and_threads_do_not),
        cmocka_unit_test(the_drape_is_drawn_in_every_scene_and_measured),
    };
    return cmocka_run_group_tests(tests, make_files, NULL);
}

/* Datasets simulated from stitches. */
#include "btf/dataset/dataset.h"
#include "geometry/acquisition/acquisition.h"
#include "tests/geometry/shipped_stitches.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { DIRECTIONS = 6, SIZE = 8 };

static weft_acquisition_report simulate(const char *name, const char *path, double noise, uint64_t seed)
{
    weft_stitch stitch;
    weft_tile_mesh mesh;
    weft_vec3 direction[DIRECTIONS];
    weft_acquisition_options options = {.width = SIZE, .height = SIZE, .bounces = 2, .noise = noise, .seed = seed};
    weft_acquisition_report report;
    weft_error error = {0};
    for (int i = 0; i < DIRECTIONS; i++)
        direction[i] = weft_acquisition_direction(i * 11);
    shipped_stitch_open(name, 40, &stitch, &mesh);
    if (weft_acquire(&stitch, &mesh, direction, DIRECTIONS, &options, path, NULL, &report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
    return report;
}

typedef struct samples {
    float value[SIZE * SIZE][DIRECTIONS * DIRECTIONS][3];
    float opacity[SIZE * SIZE][DIRECTIONS];
    weft_vec3 direction[DIRECTIONS];
} samples;

static void load(const char *path, samples *into)
{
    static weft_half half[SIZE * SIZE][DIRECTIONS * DIRECTIONS][3];
    weft_dataset *dataset;
    weft_error error = {0};
    if (weft_dataset_open(path, &dataset, &error) != WEFT_OK ||
        weft_dataset_read_block(dataset, 0, 0, SIZE, SIZE, &half[0][0][0], NULL, &error) != WEFT_OK ||
        weft_dataset_read_opacity(dataset, 0, SIZE, &into->opacity[0][0], &error) != WEFT_OK)
        fail_msg("%s", error.message);
    memcpy(into->direction, weft_dataset_get_layout(dataset)->view, sizeof into->direction);
    weft_dataset_close(dataset);
    for (int i = 0; i < SIZE * SIZE; i++)
        for (int k = 0; k < DIRECTIONS * DIRECTIONS; k++)
            for (int c = 0; c < 3; c++)
                into->value[i][k][c] = weft_float_of_half(half[i][k][c]);
}

static void the_stated_noise_is_that_between_seeds(void **state)
{
    (void)state;
    static samples one, other;
    weft_acquisition_report report = simulate("plain_knit", "one.btf.h5", 0.02, 1);
    simulate("plain_knit", "other.btf.h5", 0.02, 2);
    load("one.btf.h5", &one);
    load("other.btf.h5", &other);
    assert_true(report.noise <= 0.02 && report.noise > 0.01);
    assert_true(report.paths_per_texel >= 64);
    double difference = 0, signal = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        for (int k = 0; k < DIRECTIONS * DIRECTIONS; k++) {
            double a = (double)one.value[i][k][1], b = (double)other.value[i][k][1];
            difference += (a - b) * (a - b) / 2;
            signal += (a * a + b * b) / 2;
        }
    }
    print_message("stated %.4f, between seeds %.4f\n", report.noise, sqrt(difference / signal));
    assert_true(sqrt(difference / signal) < 1.3 * report.noise);
}

static void exchanging_views_and_lights_changes_nothing_within_the_noise(void **state)
{
    (void)state;
    static samples s;
    weft_acquisition_report report = simulate("plain_weave", "weave.btf.h5", 0.02, 1);
    load("weave.btf.h5", &s);
    double mean[DIRECTIONS * DIRECTIONS] = {0}, rms[DIRECTIONS] = {0};
    for (int i = 0; i < SIZE * SIZE; i++)
        for (int k = 0; k < DIRECTIONS * DIRECTIONS; k++)
            mean[k] += (double)s.value[i][k][0] / (SIZE * SIZE);
    for (int i = 0; i < SIZE * SIZE; i++)
        for (int k = 0; k < DIRECTIONS * DIRECTIONS; k++)
            rms[k / DIRECTIONS] += (double)(s.value[i][k][0] * s.value[i][k][0]) / (SIZE * SIZE * DIRECTIONS);
    for (int a = 0; a < DIRECTIONS; a++) {
        for (int b = 0; b < a; b++) {
            double one = mean[a * DIRECTIONS + b] / s.direction[b].z;
            double other = mean[b * DIRECTIONS + a] / s.direction[a].z;
            /* Standard errors of the two means, of texels with the stated noise. */
            double of_one = report.noise * sqrt(rms[a]) / SIZE / s.direction[b].z;
            double of_other = report.noise * sqrt(rms[b]) / SIZE / s.direction[a].z;
            assert_true(fabs(one - other) < 4 * hypot(of_one, of_other));
            assert_true(fabs(one - other) < 0.05 * (one + other));
        }
    }
}

static void the_threads_do_not_show(void **state)
{
    (void)state;
    static samples one, many;
    omp_set_num_threads(1);
    simulate("open_weave", "one.btf.h5", 0.1, 3);
    omp_set_num_threads(3);
    simulate("open_weave", "many.btf.h5", 0.1, 3);
    load("one.btf.h5", &one);
    load("many.btf.h5", &many);
    assert_memory_equal(&one, &many, sizeof one);
}

static void holes_show_in_the_opacity_and_close_at_grazing_views(void **state)
{
    (void)state;
    static samples s;
    weft_acquisition_report report = simulate("open_weave", "open.btf.h5", 0.1, 1);
    load("open.btf.h5", &s);
    double steep = 0, grazing = 0, all = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        steep += (double)s.opacity[i][0] / (SIZE * SIZE);
        grazing += (double)s.opacity[i][DIRECTIONS - 1] / (SIZE * SIZE);
        for (int v = 0; v < DIRECTIONS; v++) {
            all += (double)s.opacity[i][v] / (SIZE * SIZE * DIRECTIONS);
            if (s.opacity[i][v] == 0)
                assert_true(s.value[i][v * DIRECTIONS][0] == 0);
        }
    }
    assert_true(fabs(all - report.covered) < 1e-6);
    assert_true(steep > 0.3 && steep < 0.5);
    assert_true(grazing > steep + 0.1);
}

/* A straight cylinder of radius 0.25 along x, seen from above: across it the normal goes round, the tangent stays x. */
static void frames_average_normals_and_fibres(void **state)
{
    (void)state;
    static const char text[] = "stitch { tile = {1, 1}, resolution = 96, yarn { radius = 0.25, diffuse = {0.5, 0.5, "
                               "0.5}, points { {0, 0.5, 0}, {0.5, 0.5, 0}, {1, 0.5, 0} } } }";
    weft_stitch stitch;
    weft_tile_mesh mesh;
    const weft_vec3 up = {0, 0, 1};
    weft_acquisition_options options = {.width = 2, .height = SIZE, .noise = 0.05, .seed = 1};
    weft_acquisition_report report;
    weft_dataset *dataset;
    float frame[SIZE][2][2][3];
    assert_int_equal(weft_stitch_parse(text, "rod.stitch", &stitch, NULL), WEFT_OK);
    assert_int_equal(weft_tile_mesh_create(&stitch, 0, "rod.stitch", &mesh, NULL), WEFT_OK);
    assert_int_equal(weft_acquire(&stitch, &mesh, &up, 1, &options, "rod.btf.h5", NULL, &report, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_open("rod.btf.h5", &dataset, NULL), WEFT_OK);
    assert_true(weft_dataset_has_frames(dataset));
    assert_int_equal(weft_dataset_read_frames(dataset, 0, SIZE, &frame[0][0][0][0], NULL), WEFT_OK);
    weft_dataset_close(dataset);
    for (int y = 2; y < 6; y++) {
        /* From the axis upward, in radii: a row is half a radius high. */
        double low = (SIZE / 2.0 - y - 1) / 2, high = low + 0.5;
        double along_y = (high * high - low * low) / 2;
        double along_z = (high * sqrt(1 - high * high) + asin(high) - low * sqrt(1 - low * low) - asin(low)) / 2;
        const float *normal = frame[y][1][0], *tangent = frame[y][1][1];
        assert_float_equal(normal[0], 0, 0.01);
        assert_float_equal(normal[1], along_y / hypot(along_y, along_z), 0.03);
        assert_true(tangent[0] > 0.999f);
    }
    assert_true(frame[0][1][0][2] == 1 && frame[0][1][1][0] == 1);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
}

enum { PAIR = 2 };

static void simulate_pair(const weft_stitch *stitch, const weft_tile_mesh *mesh, double plane_mm, const char *path,
                          float value[SIZE * SIZE][PAIR * PAIR][3])
{
    static weft_half half[SIZE * SIZE][PAIR * PAIR][3];
    const weft_vec3 direction[PAIR] = {{0, 0, 1}, {sqrt(0.5), 0, sqrt(0.5)}};
    const weft_acquisition_options options = {
        .width = SIZE, .height = SIZE, .noise = 0.03, .seed = 4, .plane_mm = plane_mm};
    weft_acquisition_report report;
    weft_dataset *dataset;
    weft_error error = {0};
    if (weft_acquire(stitch, mesh, direction, PAIR, &options, path, NULL, &report, &error) != WEFT_OK ||
        weft_dataset_open(path, &dataset, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_int_equal(weft_dataset_read_block(dataset, 0, 0, SIZE, SIZE, &half[0][0][0], NULL, &error), WEFT_OK);
    weft_dataset_close(dataset);
    for (int i = 0; i < SIZE * SIZE; i++)
        for (int k = 0; k < PAIR * PAIR; k++)
            for (int c = 0; c < 3; c++)
                value[i][k][c] = weft_float_of_half(half[i][k][c]);
}

/* A texel that lies deeper is seen where its line of sight leaves the top of the cloth: at 45 degrees one texel farther
 * for a depth of one texel, and from above where it was. */
static void a_deeper_plane_shifts_what_slanted_views_see(void **state)
{
    (void)state;
    static float top[SIZE * SIZE][PAIR * PAIR][3], deep[SIZE * SIZE][PAIR * PAIR][3];
    weft_stitch stitch;
    weft_tile_mesh mesh;
    shipped_stitch_open("plain_knit", 40, &stitch, &mesh);
    simulate_pair(&stitch, &mesh, 0, "top.btf.h5", top);
    simulate_pair(&stitch, &mesh, -stitch.width / SIZE, "deep.btf.h5", deep);
    for (int view = 0; view < PAIR; view++) {
        double moved = 0, still = 0, signal = 0;
        for (int i = 0; i < SIZE * SIZE; i++) {
            int farther = i / SIZE * SIZE + (i + 1) % SIZE, image = view * PAIR;
            double here = (double)deep[i][image][0];
            moved += pow(here - (double)top[farther][image][0], 2);
            still += pow(here - (double)top[i][image][0], 2);
            signal += here * here;
        }
        assert_true(sqrt((view ? moved : still) / signal) < 0.1);
        assert_true(sqrt((view ? still : moved) / signal) > 0.3);
    }
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
}

/* A rod of radius 0.25 covers half of its tile; its top is seen pi / 4 of the radius high in the mean. */
static void the_mean_height_is_of_what_is_seen(void **state)
{
    (void)state;
    static const char text[] = "stitch { tile = {1, 1}, resolution = 96, yarn { radius = 0.25, diffuse = {0.5, 0.5, "
                               "0.5}, points { {0, 0.5, 0}, {0.5, 0.5, 0}, {1, 0.5, 0} } } }";
    weft_stitch stitch;
    weft_tile_mesh mesh;
    double height_mm;
    assert_int_equal(weft_stitch_parse(text, "rod.stitch", &stitch, NULL), WEFT_OK);
    assert_int_equal(weft_tile_mesh_create(&stitch, 0, "rod.stitch", &mesh, NULL), WEFT_OK);
    assert_int_equal(weft_acquisition_mean_height(&stitch, &mesh, &height_mm, NULL), WEFT_OK);
    assert_float_equal(height_mm, 0.25 * (atan(1) - 1), 0.003);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
}

static void requests_without_sense_are_refused(void **state)
{
    (void)state;
    weft_stitch stitch;
    weft_tile_mesh mesh;
    const weft_vec3 below = {0, 0.8, -0.6}, up = {0, 0, 1};
    weft_acquisition_options options = {.width = 4, .height = 4, .noise = 0.1};
    weft_acquisition_report report;
    weft_error error = {0};
    shipped_stitch_open("open_weave", 20, &stitch, &mesh);
    assert_int_equal(weft_acquire(&stitch, &mesh, &below, 1, &options, "no.btf.h5", NULL, &report, &error),
                     WEFT_BAD_USAGE);
    assert_string_equal(error.message, "direction 1 is (0, 0.8, -0.6), not above the horizon");
    options.bounces = 1000;
    assert_int_equal(weft_acquire(&stitch, &mesh, &up, 1, &options, "no.btf.h5", NULL, &report, &error),
                     WEFT_BAD_USAGE);
    options.bounces = 0;
    options.plane_mm = 0.01;
    assert_int_equal(weft_acquire(&stitch, &mesh, &up, 1, &options, "no.btf.h5", NULL, &report, &error),
                     WEFT_BAD_USAGE);
    options.plane_mm = -100;
    assert_int_equal(weft_acquire(&stitch, &mesh, &up, 1, &options, "no.btf.h5", NULL, &report, &error),
                     WEFT_BAD_USAGE);
    options.plane_mm = 0;
    options.width = 0;
    assert_int_equal(weft_acquire(&stitch, &mesh, &up, 1, &options, "no.btf.h5", NULL, &report, &error),
                     WEFT_BAD_USAGE);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
}

int test_acquisition(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_stated_noise_is_that_between_seeds),
        cmocka_unit_test(exchanging_views_and_lights_changes_nothing_within_the_noise),
        cmocka_unit_test(the_threads_do_not_show),
        cmocka_unit_test(holes_show_in_the_opacity_and_close_at_grazing_views),
        cmocka_unit_test(frames_average_normals_and_fibres),
        cmocka_unit_test(a_deeper_plane_shifts_what_slanted_views_see),
        cmocka_unit_test(the_mean_height_is_of_what_is_seen),
        cmocka_unit_test(requests_without_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}

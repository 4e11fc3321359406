/* Heights from photographs of surfaces that the test knows: matte bumps traced ray by ray, with shadows and marks, by
 * formulas of its own; and what has to be refused. */
#include "relief/move.h"
#include "relief/relief.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/synthetic_dataset.h"

#include "btf/direction/direction.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 16, VIEWS = 57, LIGHTS = 7 };
static const double pitch_mm = 0.1, tile_mm = SIDE * 0.1;

/* ---- Surfaces ---- */

/* Height in mm at a place of the plane; it repeats after a tile. */
typedef double height_function(double x, double y);

static double bumps(double x, double y)
{
    double k = 2 * WEFT_PI / tile_mm;
    return -0.3 + 0.2 * cos(k * x) * cos(k * y) + 0.06 * sin(2 * k * x + 1);
}

static double lowered(double x, double y)
{
    (void)x, (void)y;
    return -0.3;
}

static double level(double x, double y)
{
    (void)x, (void)y;
    return 0;
}

/* Marks of several sizes, so that every place can be told from its neighbours. */
static void marked(double x, double y, double rgb[3])
{
    double k = 2 * WEFT_PI / tile_mm;
    rgb[0] = 0.4 + 0.25 * sin(2 * k * x + sin(k * y));
    rgb[1] = 0.4 + 0.25 * sin(2 * k * y + sin(k * x));
    rgb[2] = 0.3 + 0.2 * cos(k * x - 2 * k * y);
}

static height_function *surface;
static double shine; /* of a mirror lobe whose place wanders with the view */
static double noise; /* standard deviation */
static bool wipe;    /* every sample is masked */
static bool gaps;    /* some are: one in fifty, and a corner in every fourth view */
static weft_vec3 view_direction[VIEWS], light_direction[LIGHTS];

/* ---- Tracing ---- */

/* Where the sight line through (x, y) of the plane z = 0 meets the surface: small steps down from above, then halving.
 */
static weft_vec3 meet(double x, double y, weft_vec3 view)
{
    double above = 0.2, below = above;
    do {
        above = below;
        below -= 0.004;
    } while (below > surface(x + below * view.x / view.z, y + below * view.y / view.z) && below > -1);
    for (int i = 0; i < 30; i++) {
        double middle = (above + below) / 2;
        if (middle > surface(x + middle * view.x / view.z, y + middle * view.y / view.z))
            above = middle;
        else
            below = middle;
    }
    return weft_vec3_of(x + above * view.x / view.z, y + above * view.y / view.z, above);
}

static weft_vec3 normal_at(double x, double y)
{
    const double d = 1e-4;
    return weft_unit(weft_vec3_of(-(surface(x + d, y) - surface(x - d, y)) / (2 * d),
                                  -(surface(x, y + d) - surface(x, y - d)) / (2 * d), 1));
}

static bool is_lit(weft_vec3 from, weft_vec3 light)
{
    for (double t = 0.02; from.z + t * light.z < 0.2; t += 0.02)
        if (surface(from.x + t * light.x, from.y + t * light.y) > from.z + t * light.z)
            return false;
    return true;
}

static double random_normal(void)
{
    static uint64_t seed = 1;
    double sum = 0;
    for (int i = 0; i < 12; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        sum += (double)(seed >> 40) * 0x1p-24;
    }
    return sum - 6;
}

/* Glints of flat cloth: bright where a normal that the place has of its own mirrors the light. They wander over the
 * texels as the view turns, as if they lay at a depth. */
static double glint(weft_vec3 at, weft_vec3 view, weft_vec3 light)
{
    double k = 2 * WEFT_PI / tile_mm;
    weft_vec3 normal = weft_unit(weft_vec3_of(0.5 * sin(2 * k * at.x), 0.5 * sin(2 * k * at.y), 1));
    weft_vec3 half = weft_unit(weft_add(light, view));
    return shine * pow(fmax(weft_dot(normal, half), 0), 60);
}

static void shade(weft_vec3 at, weft_vec3 view, weft_vec3 light, double rgb[3])
{
    weft_vec3 normal = normal_at(at.x, at.y);
    double cosine = fmax(weft_dot(normal, light), 0) * (is_lit(at, light) ? 1 : 0);
    double colour[3];
    marked(at.x, at.y, colour);
    if (shine > 0)
        colour[0] = colour[1] = colour[2] = 0.1;
    for (int c = 0; c < 3; c++)
        rgb[c] = colour[c] * cosine + glint(at, view, light) + noise * random_normal();
}

/* The mean of four points of the texel. */
static void fill_texel(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    weft_vec3 met[4] = {{0}};
    for (int i = 0; i < layout->image_count; i++) {
        weft_vec3 view = layout->view[layout->view_of_image[i]];
        double sum[3] = {0};
        for (int k = 0; k < 4; k++) {
            double px = (x + 0.25 + 0.5 * (k & 1)) * pitch_mm, py = tile_mm - (y + 0.25 + 0.5 * (k >> 1)) * pitch_mm;
            double rgb[3];
            /* The photographs of a view follow each other. */
            if (i == 0 || layout->view_of_image[i] != layout->view_of_image[i - 1])
                met[k] = meet(px, py, view);
            shade(met[k], view, layout->light[i], rgb);
            for (int c = 0; c < 3; c++)
                sum[c] += rgb[c] / 4;
        }
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = (float)sum[c];
        bool lost = (x * 7919 + y * 104729 + i * 1299) % 50 == 0 || (layout->view_of_image[i] % 4 == 1 && x + y < 8);
        mask[i] = wipe || (gaps && lost) ? WEFT_MASK_MISSING : 0;
    }
}

static weft_dataset *photograph(const char *path, int views, int lights)
{
    weft_dataset_layout layout = {
        .width = SIDE, .height = SIDE, .image_count = views * lights, .view_count = views, .texel_pitch_mm = pitch_mm};
    weft_error error = {0};
    expect_ok(weft_dataset_layout_allocate(&layout, &error), &error);
    for (int i = 0; i < views * lights; i++) {
        layout.view_of_image[i] = i / lights;
        layout.view[i / lights] = view_direction[i / lights];
        layout.light[i] = light_direction[i % lights];
    }
    synthetic_dataset_write(path, &layout, fill_texel);
    weft_dataset_layout_free(&layout);
    return synthetic_dataset_open(path);
}

static weft_relief_report estimate(weft_dataset *dataset)
{
    const weft_relief_options options = {0};
    weft_relief_report report;
    weft_error error = {0};
    expect_ok(weft_relief_estimate(dataset, &options, NULL, &report, &error), &error);
    weft_dataset_close(dataset);
    return report;
}

static void assert_cannot(weft_dataset *dataset, const char *cause)
{
    const weft_relief_options options = {0};
    weft_relief_report report;
    weft_error error = {0};
    assert_int_equal(weft_relief_estimate(dataset, &options, NULL, &report, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, cause))
        fail_msg("message '%s', expected '%s'", error.message, cause);
    weft_dataset_close(dataset);
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median of the distances of all heights from the true surface. */
static double median_error(const weft_relief_report *report)
{
    static double apart[4 * SIDE * SIDE];
    int count = report->width * report->height;
    assert_int_equal(count, 4 * SIDE * SIDE);
    for (int i = 0; i < count; i++) {
        double x = (i % report->width + 0.5) / report->width * tile_mm;
        double y = tile_mm - (i / report->width + 0.5) / report->height * tile_mm;
        apart[i] = fabs((double)report->height_mm_of[i] - surface(x, y));
    }
    qsort(apart, (size_t)count, sizeof *apart, compare_doubles);
    return apart[count / 2];
}

/* ---- Tests ---- */

static void bumps_are_measured(void **state)
{
    (void)state;
    surface = bumps;
    weft_relief_report report = estimate(photograph("bumps.btf.h5", VIEWS, LIGHTS));
    assert_int_equal(report.verdict, WEFT_RELIEF_HEIGHTS);
    assert_true(report.repeats);
    print_message("median error %.4f mm, errors %.3f %.3f %.3f\n", median_error(&report), report.error.flat,
                  report.error.plane, report.error.heights);
    assert_true(median_error(&report) < 0.015);
    assert_true(fabs(report.plane_mm + 0.3) < 0.1);
    assert_true(report.error.heights < 0.8 * report.error.plane);
    assert_true(report.low_mm < -0.5 && report.high_mm > -0.1);
    weft_relief_report_free(&report);
}

static void gaps_in_the_samples_do_no_harm(void **state)
{
    (void)state;
    surface = bumps;
    gaps = true;
    weft_relief_report report = estimate(photograph("gaps.btf.h5", VIEWS, LIGHTS));
    gaps = false;
    assert_int_equal(report.verdict, WEFT_RELIEF_HEIGHTS);
    print_message("median error %.4f mm\n", median_error(&report));
    assert_true(median_error(&report) < 0.025);
    weft_relief_report_free(&report);
}

/* The plate lies at the height of the texels, the cloth a little below it. */
static void a_lowered_plane_is_found_and_nothing_more(void **state)
{
    (void)state;
    surface = lowered;
    weft_relief_report report = estimate(photograph("lowered.btf.h5", VIEWS, LIGHTS));
    assert_int_equal(report.verdict, WEFT_RELIEF_PLANE);
    print_message("plane %.4f, errors %.3f %.3f %.3f\n", report.plane_mm, report.error.flat, report.error.plane,
                  report.error.heights);
    assert_true(fabs(report.plane_mm + 0.3) < 0.03);
    weft_relief_report_free(&report);
}

static void a_flat_card_is_refused(void **state)
{
    (void)state;
    surface = level;
    weft_relief_report report = estimate(photograph("card.btf.h5", VIEWS, LIGHTS));
    assert_int_equal(report.verdict, WEFT_RELIEF_NOTHING);
    assert_int_equal(report.levels_used, 0);
    weft_relief_report_free(&report);
}

static void shine_on_flat_cloth_is_refused(void **state)
{
    (void)state;
    surface = level;
    shine = 2;
    weft_relief_report report = estimate(photograph("shine.btf.h5", VIEWS, LIGHTS));
    shine = 0;
    print_message("shine: errors %.3f %.3f %.3f\n", report.error.flat, report.error.plane, report.error.heights);
    assert_int_not_equal(report.verdict, WEFT_RELIEF_HEIGHTS);
    weft_relief_report_free(&report);
}

static void noise_is_refused(void **state)
{
    (void)state;
    surface = level;
    noise = 5;
    weft_relief_report report = estimate(photograph("noise.btf.h5", VIEWS, LIGHTS));
    noise = 0;
    assert_int_equal(report.verdict, WEFT_RELIEF_NOTHING);
    weft_relief_report_free(&report);
}

static void what_cannot_be_judged_is_said(void **state)
{
    (void)state;
    surface = level;
    assert_cannot(photograph("one.btf.h5", 1, LIGHTS), "1 of 1 views were photographed under the same 7 lights");
    wipe = true;
    weft_dataset *dataset = photograph("masked.btf.h5", VIEWS, 2);
    wipe = false;
    assert_cannot(dataset, "masked");
}

static int enter(void **state)
{
    for (int i = 0; i < VIEWS; i++)
        view_direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    for (int i = 0; i < LIGHTS; i++)
        light_direction[i] = weft_direction_of_angles(weft_ubo81_angles(i < 4 ? 2 * i : 14 + 6 * i));
    return scratch_folder_enter(state);
}

/* ---- Moved ---- */

typedef struct all_samples {
    weft_half value[SIDE * SIDE * VIEWS * LIGHTS * 3];
    uint8_t mask[SIDE * SIDE * VIEWS * LIGHTS];
} all_samples;

static void read_all(weft_dataset *dataset, all_samples *all)
{
    weft_error error = {0};
    expect_ok(weft_dataset_read_block(dataset, 0, 0, SIDE, SIDE, all->value, all->mask, &error), &error);
    weft_dataset_close(dataset);
}

static void move_to(double plane_mm, bool repeats, const char *output, all_samples *moved)
{
    weft_error error = {0};
    weft_dataset *dataset = synthetic_dataset_open("lowered.btf.h5");
    const weft_move move = {plane_mm, repeats, NULL};
    expect_ok(weft_relief_move(dataset, &move, output, json_object(), NULL, &error), &error);
    weft_dataset_close(dataset);
    read_all(synthetic_dataset_open(output), moved);
}

/* Root mean square of what is known of both, of views up to 60 degrees. */
static double apart(const all_samples *a, const all_samples *b)
{
    double sum = 0;
    long count = 0;
    for (size_t i = 0; i < SIDE * SIDE * VIEWS * LIGHTS; i++) {
        bool steep = view_direction[i / LIGHTS % VIEWS].z < 0.5;
        for (size_t c = 0; c < 3 && !a->mask[i] && !b->mask[i] && !steep; c++, count++)
            sum += pow((double)(weft_float_of_half(a->value[3 * i + c]) - weft_float_of_half(b->value[3 * i + c])), 2);
    }
    assert_true(count > 100000);
    return sqrt(sum / (double)count);
}

/* What lies 0.3 mm below its texels, moved there, is what was photographed in their plane. */
static void moved_texels_lie_on_the_surface(void **state)
{
    (void)state;
    static all_samples flat, low, moved, wrong;
    surface = level;
    read_all(photograph("level.btf.h5", VIEWS, LIGHTS), &flat);
    surface = lowered;
    read_all(photograph("lowered.btf.h5", VIEWS, LIGHTS), &low);
    move_to(-0.3, true, "moved.btf.h5", &moved);
    move_to(0.3, true, "wrong.btf.h5", &wrong);
    print_message("apart %.4f, moved %.4f, the other way %.4f\n", apart(&low, &flat), apart(&moved, &flat),
                  apart(&wrong, &flat));
    assert_true(apart(&moved, &flat) < 0.15 * apart(&low, &flat));
    for (size_t i = 0; i < sizeof moved.mask; i++)
        assert_int_equal(moved.mask[i], 0);
}

/* Views along x and y look past another border each. */
static void nothing_is_known_beyond_the_border(void **state)
{
    (void)state;
    static all_samples around, cut;
    surface = lowered;
    weft_dataset_close(photograph("lowered.btf.h5", VIEWS, LIGHTS));
    move_to(-0.3, true, "moved.btf.h5", &around);
    move_to(-0.3, false, "cut.btf.h5", &cut);
    long lost = 0;
    for (size_t i = 0; i < sizeof cut.mask; i++) {
        size_t texel = i / (VIEWS * LIGHTS);
        weft_vec3 view = view_direction[i / LIGHTS % VIEWS];
        double x = (double)(texel % SIDE) + 3 * view.x / fmax(view.z, 0.2),
               y = (double)(texel / SIDE) - 3 * view.y / fmax(view.z, 0.2);
        bool inside = x > -1e-3 && y > -1e-3 && x < SIDE - 1 + 1e-3 && y < SIDE - 1 + 1e-3;
        assert_int_equal(cut.mask[i] == 0, inside);
        for (size_t c = 0; c < 3 && inside; c++)
            assert_int_equal(cut.value[3 * i + c], around.value[3 * i + c]);
        lost += !inside;
    }
    assert_true(lost > 10000);
}

int test_relief(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bumps_are_measured),
        cmocka_unit_test(moved_texels_lie_on_the_surface),
        cmocka_unit_test(nothing_is_known_beyond_the_border),
        cmocka_unit_test(gaps_in_the_samples_do_no_harm),
        cmocka_unit_test(a_lowered_plane_is_found_and_nothing_more),
        cmocka_unit_test(a_flat_card_is_refused),
        cmocka_unit_test(shine_on_flat_cloth_is_refused),
        cmocka_unit_test(noise_is_refused),
        cmocka_unit_test(what_cannot_be_judged_is_said),
    };
    return cmocka_run_group_tests(tests, enter, scratch_folder_leave);
}

/* Irregularities of cloth and the balance of energy. Built twice: in double, and in single precision. */
#include "btf/direction/direction.h"
#include "reflectance/weave/weave.h"
#include "tests/reflectance/random.h"
#include "tests/reflectance/weave_text.h"
#include "tests/support/cmocka_all.h"

#include <stdio.h>
#include <string.h>

enum { SEED = 42 };

static weft_weave read_asset(const char *name)
{
    char path[512];
    weft_weave weave;
    weft_error error = {0};
    snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, name);
    if (weft_weave_read(path, NULL, 0, &weave, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return weave;
}

static void seed_zero_is_no_noise(void **state)
{
    (void)state;
    weft_weave weave = read_asset("silk_shantung");
    uint64_t random = 1;
    for (int i = 0; i < 1000; i++) {
        weft_weave_point point =
            weft_weave_locate(&weave, random_between(&random, -50, 50), random_between(&random, -50, 50), 0);
        assert_true(point.umax_offset_rad == 0 && point.intensity == 1);
    }
    weft_weave_free(&weave);
}

static void intensity_is_exponential_with_mean_one(void **state)
{
    (void)state;
    enum { COUNT = 200000 };
    weft_weave weave = read_asset("cotton_denim");
    uint64_t random = 2;
    double sum = 0, squares = 0;
    int above_two = 0;
    for (int i = 0; i < COUNT; i++) {
        double x =
            weft_weave_locate(&weave, random_between(&random, -400, 400), random_between(&random, -400, 400), SEED)
                .intensity;
        sum += x;
        squares += x * x;
        above_two += x > 2;
    }
    /* Four standard deviations: that of the mean is 1 / sqrt(COUNT), the mean square of the distribution is 2. */
    assert_true(fabs(sum / COUNT - 1) < 0.009);
    assert_true(fabs(squares / COUNT - 2) < 0.04);
    assert_true(fabs((double)above_two / COUNT - exp(-2.0)) < 0.004);
    weft_weave_free(&weave);
}

static void inclination_stays_admissible_and_within_its_amplitude(void **state)
{
    (void)state;
    static const char *const name[] = {"silk_shantung", "polyester_lining"};
    for (int k = 0; k < 2; k++) {
        weft_weave weave = read_asset(name[k]);
        uint64_t random = 3;
        weft_real least = 1, most = -1;
        for (int i = 0; i < 100000; i++) {
            weft_weave_point point = weft_weave_locate(&weave, random_between(&random, -3000, 3000),
                                                       random_between(&random, -3000, 3000), SEED);
            const weft_yarn *yarn = &weave.yarn[point.yarn];
            const weft_real *amplitude = weave.inclination_noise_deg + (yarn->warp ? 0 : 2);
            weft_segment noisy = yarn->segment;
            noisy.umax += point.umax_offset_rad;
            assert_true(weft_segment_admissible(&noisy));
            assert_true(fabs(point.umax_offset_rad) <=
                        weft_rad_of_deg(amplitude[0] + amplitude[1]) * (weft_real)1.0001);
            least = fmin(least, point.umax_offset_rad);
            most = fmax(most, point.umax_offset_rad);
        }
        assert_true(least < weft_rad_of_deg(-6) && most > weft_rad_of_deg(6));
        weft_weave_free(&weave);
    }
}

static void inclination_is_shared_along_a_segment_and_smooth_along_a_yarn(void **state)
{
    (void)state;
    weft_weave weave = read_asset("silk_shantung");
    /* Yarn 3 of the file: a weft of length 4 cells; its column of the pattern spans a third of the tile. */
    weft_weave_point start = weft_weave_locate(&weave, (weft_real)0.05, (weft_real)0.7, SEED);
    weft_weave_point end = weft_weave_locate(&weave, (weft_real)0.6, (weft_real)0.8, SEED);
    assert_int_equal(start.yarn, end.yarn);
    assert_true(start.umax_offset_rad == end.umax_offset_rad);
    weft_real largest_step = 0, largest = 0;
    for (int tile = 0; tile < 400; tile++) {
        weft_real U = (weft_real)tile + (weft_real)0.3, V = (weft_real)0.75;
        weft_real here = weft_weave_locate(&weave, U, V, SEED).umax_offset_rad;
        weft_real next = weft_weave_locate(&weave, U + 1, V, SEED).umax_offset_rad;
        largest_step = fmax(largest_step, fabs(next - here));
        largest = fmax(largest, fabs(here));
    }
    assert_true(largest > 0 && largest_step < largest);
    weft_weave_free(&weave);
}

static void pieces_of_a_segment_across_a_tile_border_agree(void **state)
{
    (void)state;
    /* Yarns 4 and 5 of shantung are the two ends of one weft segment round u = -1/6 = 5/6. */
    weft_weave weave = read_asset("silk_shantung");
    for (int tile = -20; tile < 20; tile++) {
        weft_real border = (weft_real)tile, V = (weft_real)0.25;
        weft_weave_point left = weft_weave_locate(&weave, border - (weft_real)0.01, V, SEED);
        weft_weave_point right = weft_weave_locate(&weave, border + (weft_real)0.01, V, SEED);
        assert_int_not_equal(left.yarn, right.yarn);
        assert_true(left.umax_offset_rad == right.umax_offset_rad);
        assert_true(fabs(right.y - left.y - (weft_real)0.12) < (weft_real)1e-3);
    }
    weft_weave_free(&weave);
}

static void noise_does_not_repeat_with_the_tile_and_follows_the_seed(void **state)
{
    (void)state;
    weft_weave weave = read_asset("cotton_denim");
    int repeats = 0, same_for_other_seed = 0, same_for_high_bits = 0;
    for (int tile = 0; tile < 1000; tile++) {
        weft_real U = (weft_real)tile + (weft_real)0.1, V = (weft_real)0.3;
        weft_real here = weft_weave_locate(&weave, U, V, SEED).intensity;
        repeats += here == weft_weave_locate(&weave, U + 1, V, SEED).intensity;
        repeats += here == weft_weave_locate(&weave, U, V + 1, SEED).intensity;
        same_for_other_seed += here == weft_weave_locate(&weave, U, V, SEED + 1).intensity;
        same_for_high_bits += here == weft_weave_locate(&weave, U, V, SEED + (1ull << 40)).intensity;
        assert_true(here == weft_weave_locate(&weave, U, V, SEED).intensity);
    }
    assert_int_equal(repeats + same_for_other_seed + same_for_high_bits, 0);
    weft_weave_free(&weave);
}

/* Values of one machine that every other must reach. */
static void noise_is_the_same_on_every_machine(void **state)
{
    (void)state;
    weft_weave weave;
    weft_error error = {0};
    assert_int_equal(weft_weave_parse(WEAVE_TEXT, "plain.wv", NULL, 0, &weave, NULL, &error), WEFT_OK);
    const double expected[3][2] = {{-0.0073336, 1.684262}, {-0.1185526, 0.051229}, {-0.0160078, 1.680877}};
    for (int i = 0; i < 3; i++) {
        weft_weave_point point = weft_weave_locate(&weave, (weft_real)(0.1 + 7 * i), (weft_real)(0.9 - 11 * i), SEED);
        assert_true(fabs(point.umax_offset_rad - expected[i][0]) < 1e-6);
        assert_true(fabs(point.intensity - expected[i][1]) < 1e-5);
    }
    weft_weave_free(&weave);
}

static void any_coordinate_lies_in_a_yarn(void **state)
{
    (void)state;
    weft_weave weave = read_asset("wool_gabardine");
    const weft_real odd[] = {
        0,  (weft_real)-0.0, (weft_real)-1e-30, (weft_real)1e-30, (weft_real)0.99999997, 1,
        -1, (weft_real)1e8,  (weft_real)-1e8,   (weft_real)1e30,  (weft_real)INFINITY,   (weft_real)NAN};
    enum { ODD = sizeof odd / sizeof *odd };
    for (int i = 0; i < ODD; i++) {
        for (int k = 0; k < ODD; k++) {
            weft_weave_point point = weft_weave_locate(&weave, odd[i], odd[k], SEED);
            assert_in_range(point.yarn, 0, weave.yarn_count - 1);
            assert_true(isfinite(point.x) && isfinite(point.y) && isfinite(point.intensity));
        }
    }
    weft_weave_free(&weave);
}

static void published_segments_cover_their_cells(void **state)
{
    (void)state;
    static const char *const name[] = {"cotton_denim", "polyester_lining", "silk_charmeuse", "silk_shantung"};
    for (int k = 0; k < 4; k++) {
        weft_weave weave = read_asset(name[k]);
        uint64_t random = 4;
        int outside = 0;
        for (int i = 0; i < 10000; i++) {
            weft_weave_point point =
                weft_weave_locate(&weave, random_between(&random, -5, 5), random_between(&random, -5, 5), 0);
            const weft_segment *segment = &weave.yarn[point.yarn].segment;
            /* Centres are printed with four digits of a tile of at most ten cells. */
            outside += fabs(point.x) > segment->width / 2 + (weft_real)2e-3 ||
                       fabs(point.y) > segment->length / 2 + (weft_real)2e-3;
        }
        if (outside)
            print_message("%s: %d of 10000 points outside their segment\n", name[k], outside);
        assert_int_equal(outside, 0);
        weft_weave_free(&weave);
    }
}

/* An independent estimate: stratified random directions, the integral of each segment in closed order. */
static void specular_part_with_ks_one_reflects_all_light_on_average(void **state)
{
    (void)state;
    enum { SIDE = 200 };
    weft_weave weave = read_asset("polyester_lining");
    uint64_t random = 5;
    double sum = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        weft_real r1 = ((weft_real)(i / SIDE) + random_between(&random, 0, 1)) / SIDE;
        weft_real r2 = ((weft_real)(i % SIDE) + random_between(&random, 0, 1)) / SIDE;
        weft_real phi = 2 * (weft_real)WEFT_PI * r2;
        weft_vec3 light = {sqrt(r1) * cos(phi), sqrt(r1) * sin(phi), sqrt(1 - r1)};
        sum += weft_weave_mean_specular(&weave, light, random_direction(&random));
    }
    double albedo = weave.specular_scale * sum / (SIDE * SIDE) * (double)WEFT_PI;
    print_message("bihemispherical reflectance %.4f\n", albedo);
    assert_true(fabs(albedo - 1) < 0.02);
    weft_weave_free(&weave);
}

int test_weave_noise(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(seed_zero_is_no_noise),
        cmocka_unit_test(intensity_is_exponential_with_mean_one),
        cmocka_unit_test(inclination_stays_admissible_and_within_its_amplitude),
        cmocka_unit_test(inclination_is_shared_along_a_segment_and_smooth_along_a_yarn),
        cmocka_unit_test(pieces_of_a_segment_across_a_tile_border_agree),
        cmocka_unit_test(noise_does_not_repeat_with_the_tile_and_follows_the_seed),
        cmocka_unit_test(noise_is_the_same_on_every_machine),
        cmocka_unit_test(any_coordinate_lies_in_a_yarn),
        cmocka_unit_test(published_segments_cover_their_cells),
        cmocka_unit_test(specular_part_with_ks_one_reflects_all_light_on_average),
    };
    return cmocka_run_group_tests_name("weave noise", tests, NULL, NULL);
}

/* Weaves found again from what they reflect: one of each kind, with an argument all. */
#include "tests/support/cmocka_all.h"
#include "tests/support/suite.h"

#include "btf/direction/direction.h"
#include "compress/weave_fit/fit_weave.h"
#include "compress/weave_fit/least_squares.h"
#include "tests/reflectance/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { VIEW_STEP = 16 }; /* six views are enough, and quick */

static weft_weave read_fabric(const char *name)
{
    char path[512], warning[WEFT_MESSAGE_SIZE];
    weft_weave weave;
    weft_error error;
    snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, name);
    if (weft_weave_read(path, NULL, 0, &weave, warning, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return weave;
}

/* Normal noise from a counter (Box and Muller 1958). */
static double normal_noise(uint32_t index)
{
    uint32_t a = (index * 2654435761u) ^ 0x9e3779b9u, b = (index + 77777u) * 2246822519u;
    a = (a ^ a >> 15) * 0x2c1b3c6du;
    b = (b ^ b >> 13) * 0x297a2d39u;
    double u = ((a ^ a >> 16) + 0.5) / 4294967296.0, v = ((b ^ b >> 16) + 0.5) / 4294967296.0;
    return sqrt(-2 * log(u)) * cos(2 * WEFT_PI * v);
}

/* What `weave` reflects on average under 81 lights seen from every `step`th of 81 views. */
static weft_mean_brdf photograph(const weft_weave *weave, int step)
{
    weft_vec3 direction[WEFT_UBO81_COUNT];
    for (int i = 0; i < WEFT_UBO81_COUNT; i++)
        direction[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    weft_mean_brdf mean = {.light = calloc(6561, sizeof(weft_vec3)),
                           .view = calloc(6561, sizeof(weft_vec3)),
                           .value = calloc(6561, sizeof(weft_rgb))};
    for (int v = 0; v < WEFT_UBO81_COUNT; v += step) {
        for (int l = 0; l < WEFT_UBO81_COUNT; l++) {
            int i = mean.count++;
            mean.light[i] = direction[l];
            mean.view[i] = direction[v];
            mean.value[i] = weft_weave_mean_brdf(weave, direction[l], direction[v]);
        }
    }
    return mean;
}

/* Standard deviations, relative: of each photograph, and of what the photographs of a view, or under a light, share. */
typedef struct noise_levels {
    double image, shared;
} noise_levels;

static void add_noise(const weft_mean_brdf *clean, noise_levels levels, uint32_t seed, weft_mean_brdf *noisy)
{
    for (int i = 0; i < clean->count; i++) {
        uint32_t view = (uint32_t)i / WEFT_UBO81_COUNT, light = (uint32_t)i % WEFT_UBO81_COUNT, first = seed * 100000;
        double noise = 1 + levels.image * normal_noise(first + (uint32_t)i) +
                       levels.shared * (normal_noise(first + 50000 + view) + normal_noise(first + 60000 + light));
        weft_rgb value = clean->value[i];
        noisy->value[i] = (weft_rgb){value.r * noise, value.g * noise, value.b * noise};
    }
}

/* Every shape and scattering parameter and width 30 % off, up and down in turn; colours of another cloth. */
static void spoil(weft_weave *weave)
{
    for (int i = 0; i < weave->yarn_count; i++) {
        weft_yarn *yarn = &weave->yarn[i];
        double up = yarn->warp ? 1.3 : 0.7, down = yarn->warp ? 0.7 : 1.3;
        if (yarn->admissible)
            yarn->segment.width *= down;
        double largest = 0.98 * yarn->segment.length / yarn->segment.width;
        double umax = yarn->segment.umax * up;
        yarn->segment.alpha *= 1.3;
        yarn->segment.beta *= 0.7;
        if (!yarn->admissible)
            continue;
        yarn->segment.umax = largest < 1 && sin(umax) > largest ? asin(largest) : umax;
        yarn->segment.psi *= down;
        yarn->segment.kappa *= up;
        yarn->kd = (weft_rgb){0.2, 0.1, 0.3};
        yarn->ks = (weft_rgb){0.05, 0.2, 0.1};
    }
    weft_weave_update(weave);
}

static void print_group(const weft_fit_weave_group *found, const weft_segment *truth)
{
    print_message(
        "  %s: psi %.2f +- %.2f (%.2f), umax %.2f +- %.2f (%.2f), kappa %.2f +- %.2f (%.2f), width %.3f +- %.3f "
        "(%.3f)%s\n",
        found->warp ? "warp" : "weft", found->psi_deg, found->psi_deviation, weft_deg_of_rad(truth->psi),
        found->umax_deg, found->umax_deviation, weft_deg_of_rad(truth->umax), found->kappa, found->kappa_deviation,
        truth->kappa, found->width, found->width_deviation, truth->width, found->width_fitted ? "" : ", held");
}

/* Widths that are told to a tenth are right; `told` of them there are. */
static void assert_recovered(const char *name, int told)
{
    weft_weave truth = read_fabric(name), start = read_fabric(name);
    weft_mean_brdf mean = photograph(&truth, VIEW_STEP);
    weft_fit_weave_report report;
    weft_error error;
    int clear = 0;
    add_noise(&mean, (noise_levels){.image = 0.01}, 0, &mean);
    spoil(&start);
    if (weft_fit_weave(&mean, &start, NULL, &report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    print_message("%s: median %.2f %% -> %.2f %%, 80th percentile %.2f %%, %.1f s\n", name,
                  100 * report.before.median_relative, 100 * report.after.median_relative,
                  100 * report.after.percentile80_relative, report.seconds);
    for (int group = 0; group < report.group_count; group++) {
        const weft_fit_weave_group *found = &report.group[group];
        const weft_segment *true_segment = &truth.yarn[found->yarn].segment;
        print_group(found, true_segment);
        assert_true(fabs(found->psi_deg - weft_deg_of_rad(true_segment->psi)) < 2);
        assert_true(fabs(found->umax_deg - weft_deg_of_rad(true_segment->umax)) < 2);
        if (!found->width_fitted || found->width_deviation > 0.1 * found->width)
            continue;
        clear++;
        assert_true(fabs(found->width / true_segment->width - 1) < 0.1);
    }
    assert_int_equal(clear, told);
    assert_true(report.after.median_relative < 0.05);
    weft_mean_brdf_free(&mean);
    weft_weave_free(&truth);
    weft_weave_free(&start);
}

static void staple_fabrics_are_found_again_from_30_percent_off(void **state)
{
    (void)state;
    assert_recovered("wool_gabardine", 2);
    if (!suite_argument)
        return;
    assert_recovered("cotton_denim", 1);
    assert_recovered("cotton_twill", 1);
}

static void filament_fabrics_are_found_again_from_30_percent_off(void **state)
{
    (void)state;
    assert_recovered("silk_shantung", 2);
    if (!suite_argument)
        return;
    assert_recovered("polyester_lining", 2);
    assert_recovered("silk_charmeuse", 2);
}

enum { GROUPS = 2 };

static int captures(void)
{
    return suite_argument ? 8 : 4;
}

/* Of one parameter over repeated captures: sums of squared errors and of squared standard errors. */
typedef struct spread {
    double error, deviation;
} spread;

static void add_to_spread(double error, double deviation, spread *of)
{
    of->error += error * error;
    of->deviation += deviation * deviation;
}

static void assert_honest(const char *what, const spread *of)
{
    double ratio = sqrt(of->deviation / of->error);
    print_message("  %s: error %.3f, standard error %.2f times that\n", what, sqrt(of->error / captures()), ratio);
    assert_true(ratio > 0.5 && ratio < 2);
}

/* Photographs deviate together: 2 % shared by those of a view and by those under a light, beside 1 % of each. */
static void standard_errors_are_those_of_repeated_captures(void **state)
{
    (void)state;
    weft_weave truth = read_fabric("wool_gabardine");
    weft_mean_brdf clean = photograph(&truth, 4), noisy = photograph(&truth, 4);
    spread psi[GROUPS] = {0}, umax[GROUPS] = {0}, width[GROUPS] = {0};
    for (uint32_t capture = 1; capture <= (uint32_t)captures(); capture++) {
        weft_weave start = read_fabric("wool_gabardine");
        weft_fit_weave_report report;
        weft_error error;
        add_noise(&clean, (noise_levels){.image = 0.01, .shared = 0.02}, capture, &noisy);
        if (weft_fit_weave(&noisy, &start, NULL, &report, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        assert_int_equal(report.group_count, GROUPS);
        for (int i = 0; i < GROUPS; i++) {
            const weft_fit_weave_group *found = &report.group[i];
            add_to_spread(found->psi_deg - 30, found->psi_deviation, &psi[i]);
            add_to_spread(found->umax_deg - 30, found->umax_deviation, &umax[i]);
            add_to_spread(found->width - truth.yarn[found->yarn].segment.width, found->width_deviation, &width[i]);
        }
        weft_weave_free(&start);
    }
    for (int i = 0; i < GROUPS; i++) {
        assert_honest("psi", &psi[i]);
        assert_honest("umax", &umax[i]);
        assert_honest("width", &width[i]);
    }
    weft_mean_brdf_free(&clean);
    weft_mean_brdf_free(&noisy);
    weft_weave_free(&truth);
}

/* Lights and views are those of the rig, in which the sample lies turned. */
static void turn_sample(weft_vec3 turn_rad, weft_mean_brdf *mean)
{
    for (int i = 0; i < mean->count; i++) {
        mean->light[i] = weft_unit(weft_add(mean->light[i], weft_cross(turn_rad, mean->light[i])));
        mean->view[i] = weft_unit(weft_add(mean->view[i], weft_cross(turn_rad, mean->view[i])));
    }
}

/* By a third of a degree. */
static void a_sample_that_lies_askew_is_not_taken_for_twisted(void **state)
{
    (void)state;
    const weft_vec3 turn = {weft_rad_of_deg(0.1), weft_rad_of_deg(-0.2), weft_rad_of_deg(0.25)};
    weft_weave truth = read_fabric("wool_gabardine"), start = read_fabric("wool_gabardine");
    weft_mean_brdf mean = photograph(&truth, 4);
    weft_fit_weave_report report;
    weft_error error;
    add_noise(&mean, (noise_levels){.image = 0.01}, 7, &mean);
    turn_sample(turn, &mean);
    if (weft_fit_weave(&mean, &start, NULL, &report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    const double wanted[3] = {0.1, -0.2, 0.25};
    assert_int_equal(report.turn, WEFT_TURN_FITTED);
    for (int axis = 0; axis < 3; axis++) {
        print_message("  askew by %.3f +- %.3f (%.2f) degrees\n", report.askew_deg[axis], report.askew_deviation[axis],
                      wanted[axis]);
        assert_true(fabs(report.askew_deg[axis] - wanted[axis]) < 0.1);
    }
    for (int i = 0; i < report.group_count; i++) {
        print_group(&report.group[i], &truth.yarn[report.group[i].yarn].segment);
        assert_true(fabs(report.group[i].psi_deg - 30) < 0.1);
    }
    weft_mean_brdf_free(&mean);
    weft_weave_free(&truth);
    weft_weave_free(&start);
}

/* Gabardine turned about its normal, seen in every `step`th view. */
static weft_fit_weave_report fit_turned(double turn_deg, int step, noise_levels levels)
{
    weft_weave truth = read_fabric("wool_gabardine"), start = read_fabric("wool_gabardine");
    weft_mean_brdf mean = photograph(&truth, step);
    weft_fit_weave_report report;
    weft_error error;
    add_noise(&mean, levels, 7, &mean);
    turn_sample((weft_vec3){0, 0, weft_rad_of_deg(turn_deg)}, &mean);
    if (weft_fit_weave(&mean, &start, NULL, &report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    for (int axis = 0; axis < 3; axis++)
        print_message("  askew by %.3f +- %.3f degrees\n", report.askew_deg[axis], report.askew_deviation[axis]);
    weft_mean_brdf_free(&mean);
    weft_weave_free(&truth);
    weft_weave_free(&start);
    return report;
}

static void a_sample_held_straight_is_reported_with_the_reason(void **state)
{
    (void)state;
    weft_fit_weave_report far = fit_turned(1.6, 8, (noise_levels){.image = 0.01});
    weft_fit_weave_report noisy = fit_turned(0.25, 16, (noise_levels){.image = 0.015, .shared = 0.03});
    assert_int_equal(far.turn, WEFT_TURN_AT_BOUND);
    assert_int_equal(noisy.turn, WEFT_TURN_VAGUE);
    for (int axis = 0; axis < 3; axis++) {
        assert_true(far.askew_deg[axis] == 0);
        assert_true(noisy.askew_deg[axis] == 0);
    }
}

static void non_negative_solutions_are_exact_and_stop_at_zero(void **state)
{
    (void)state;
    const double a[8] = {1, 2, 0, 1, 3, 1, 1, 1};
    double b[4], x[2] = {0}, truth[2] = {0.5, 2};
    weft_error error;
    for (int row = 0; row < 4; row++)
        b[row] = a[2 * row] * truth[0] + a[2 * row + 1] * truth[1];
    x[1] = 1e16; /* what was there before does not matter */
    assert_int_equal(weft_non_negative_least_squares(4, 2, a, b, x, &error), WEFT_OK);
    assert_true(fabs(x[0] - 0.5) < 1e-9 && fabs(x[1] - 2) < 1e-9);
    /* The free solution would be (-1, 2): at the bound the other solves alone. */
    for (int row = 0; row < 4; row++)
        b[row] = -a[2 * row] + 2 * a[2 * row + 1];
    assert_int_equal(weft_non_negative_least_squares(4, 2, a, b, x, &error), WEFT_OK);
    double product = 0, square = 0;
    for (int row = 0; row < 4; row++) {
        product += a[2 * row + 1] * b[row];
        square += a[2 * row + 1] * a[2 * row + 1];
    }
    assert_true(fabs(x[0]) < 1e-9 && fabs(x[1] - product / square) < 1e-6);
}

/* The conditions of Karush, Kuhn and Tucker, for random columns; every third program has a column twice, or one of
 * zeros. */
static void non_negative_solutions_have_no_slope_downwards(void **state)
{
    (void)state;
    uint64_t random = 1;
    for (int trial = 0; trial < 300; trial++) {
        enum { rows = 40, most = 9 };
        int n = 2 + trial % (most - 1);
        double a[rows * most], b[rows], x[most], left[rows];
        weft_error error;
        for (int row = 0; row < rows; row++) {
            b[row] = left[row] = (double)random_between(&random, -1, 2);
            for (int i = 0; i < n; i++)
                a[row * n + i] = (double)random_between(&random, 0, 1) * pow(10, i - 4);
            if (trial % 3 == 2)
                a[row * n] = trial % 2 ? 0 : a[row * n + 1];
        }
        assert_int_equal(weft_non_negative_least_squares(rows, n, a, b, x, &error), WEFT_OK);
        for (int row = 0; row < rows; row++) {
            for (int i = 0; i < n; i++)
                left[row] -= a[row * n + i] * x[i];
        }
        for (int i = 0; i < n; i++) {
            double slope = 0, size = 0;
            for (int row = 0; row < rows; row++) {
                slope += a[row * n + i] * left[row];
                size += fabs(a[row * n + i] * b[row]);
            }
            assert_true(x[i] >= 0);
            assert_true(x[i] > 0 ? fabs(slope) <= 1e-10 * size : slope <= 1e-10 * size);
        }
    }
}

static void least_squares_of_numbers_that_are_not_finite_are_refused(void **state)
{
    (void)state;
    const double a[2] = {1, NAN}, b[2] = {1, 1};
    double x;
    weft_error error;
    assert_int_equal(weft_non_negative_least_squares(2, 1, a, b, &x, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "not finite"));
}

static void a_written_weave_reads_back_to_the_same_numbers(void **state)
{
    (void)state;
    char warning[WEFT_MESSAGE_SIZE];
    weft_weave first = read_fabric("silk_shantung"), second;
    weft_error error;
    assert_int_equal(weft_weave_write("written.wv", &first, "as fitted", &error), WEFT_OK);
    if (weft_weave_read("written.wv", NULL, 0, &second, warning, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    unlink("written.wv");
    assert_int_equal(first.yarn_count, second.yarn_count);
    assert_string_equal(first.name, second.name);
    assert_memory_equal(first.pattern, second.pattern,
                        (size_t)first.tile_width * (size_t)first.tile_height * sizeof *first.pattern);
    for (int i = 0; i < first.yarn_count; i++) {
        assert_true(fabs(first.yarn[i].segment.umax - second.yarn[i].segment.umax) < 1e-14);
        assert_true(first.yarn[i].segment.kappa == second.yarn[i].segment.kappa);
        assert_true(first.yarn[i].ks.g == second.yarn[i].ks.g && first.yarn[i].kd.b == second.yarn[i].kd.b);
        assert_true(first.yarn[i].center_u == second.yarn[i].center_u);
    }
    assert_true(fabs(first.specular_scale / second.specular_scale - 1) < 1e-12);
    weft_weave_free(&first);
    weft_weave_free(&second);
}

static void a_weave_without_highlights_or_too_few_images_are_refused(void **state)
{
    (void)state;
    weft_weave weave = read_fabric("wool_gabardine");
    weft_mean_brdf mean = photograph(&weave, 40);
    weft_fit_weave_report report;
    weft_error error;
    mean.count = 3;
    assert_int_equal(weft_fit_weave(&mean, &weave, NULL, &report, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "3 images are too few"));
    mean.count = 200;
    for (int i = 0; i < weave.yarn_count; i++)
        weave.yarn[i].segment.width = 1000;
    weft_weave_update(&weave);
    assert_int_equal(weft_fit_weave(&mean, &weave, NULL, &report, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "no segment with a highlight"));
    weft_mean_brdf_free(&mean);
    weft_weave_free(&weave);
}

int test_fit_weave(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(staple_fabrics_are_found_again_from_30_percent_off),
        cmocka_unit_test(filament_fabrics_are_found_again_from_30_percent_off),
        cmocka_unit_test(standard_errors_are_those_of_repeated_captures),
        cmocka_unit_test(a_sample_that_lies_askew_is_not_taken_for_twisted),
        cmocka_unit_test(a_sample_held_straight_is_reported_with_the_reason),
        cmocka_unit_test(non_negative_solutions_are_exact_and_stop_at_zero),
        cmocka_unit_test(non_negative_solutions_have_no_slope_downwards),
        cmocka_unit_test(least_squares_of_numbers_that_are_not_finite_are_refused),
        cmocka_unit_test(a_written_weave_reads_back_to_the_same_numbers),
        cmocka_unit_test(a_weave_without_highlights_or_too_few_images_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

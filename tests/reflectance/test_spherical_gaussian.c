/* Spherical and circular Gaussians: the reference vectors and the limits. Built twice: in double, and in single
 * precision. */
#include "reflectance/gaussian/spherical_gaussian.h"
#include "tests/reflectance/random.h"
#include "tests/reflectance/representable.h"

static weft_real real_at(const reference_vectors *v, int row, const char *column)
{
    return (weft_real)vectors_number(v, row, column);
}

static void product_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("sg_product.csv", 230);
    for (int row = 0; row < v.csv.row_count; row++) {
        weft_circular_lobe lobe = weft_circular_product(real_at(&v, row, "mu1"), real_at(&v, row, "sigma1"),
                                                        real_at(&v, row, "mu2"), real_at(&v, row, "sigma2"));
        check_representable(&v, row, "mu", lobe.mean);
        check_representable(&v, row, "sigma", lobe.width);
        check_representable(&v, row, "scale", lobe.scale);
    }
    vectors_close(&v);
}

static void split_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("sg_split.csv", 220);
    for (int row = 0; row < v.csv.row_count; row++) {
        weft_vec3 direction = vectors_direction(&v, row, "w"), centre = vectors_direction(&v, row, "xi");
        weft_real width = real_at(&v, row, "sigma");
        weft_gaussian_split split = weft_spherical_gaussian_split(direction, centre, width);
        check_representable(&v, row, "G", weft_spherical_gaussian(direction, centre, width));
        check_representable(&v, row, "theta_i", split.theta);
        check_representable(&v, row, "theta_k", split.theta_centre);
        check_representable(&v, row, "sigma_prime", split.phi_width);
    }
    vectors_close(&v);
}

static void split_is_exact(void **state)
{
    (void)state;
    uint64_t random = 4;
    for (int i = 0; i < 10000; i++) {
        weft_vec3 direction = random_direction(&random), centre = random_direction(&random);
        weft_real width = random_between(&random, 0.2, 3);
        weft_gaussian_split split = weft_spherical_gaussian_split(direction, centre, width);
        weft_real product = weft_circular_gaussian(split.theta, split.theta_centre, width) *
                            weft_circular_gaussian(split.phi, split.phi_centre, split.phi_width);
        weft_real whole = weft_spherical_gaussian(direction, centre, width);
        assert_true(fabs((double)product - whole) <= 1e3 * (double)WEFT_REAL_EPSILON * whole + LEAST_NORMAL);
    }
}

/* Nine digits are printed: their rounding alone is up to 5e-9 of a value that begins with 1, more than the 1e-9 of
 * pi s s' that the file asks for. */
static double half_last_digit(double printed)
{
    return printed > 0 ? pow(10, floor(log10(printed)) - 8) / 2 : 0;
}

/* 1e-9 of pi s s' beside the rounding of the file. */
static void box_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("sg_box.csv", 220);
    for (int row = 0; row < v.csv.row_count; row++) {
        weft_real theta_width = real_at(&v, row, "sigma_l"), phi_width = real_at(&v, row, "sigma_p");
        weft_real value =
            weft_gaussian_box(real_at(&v, row, "theta_l"), theta_width, real_at(&v, row, "phi_k"), phi_width);
        double absolute = (1e-9 + 20 * (double)WEFT_REAL_EPSILON) * (double)WEFT_PI * theta_width * phi_width;
        vectors_check_within(&v, row, "value", value, absolute + half_last_digit(vectors_number(&v, row, "value")));
    }
    vectors_close(&v);
}

static void half_plane_share_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("sg_H.csv", 240);
    for (int row = 0; row < v.csv.row_count; row++)
        vectors_check_within(&v, row, "H",
                             weft_gaussian_half_plane(real_at(&v, row, "sigma_l"), real_at(&v, row, "sigma_p"),
                                                      real_at(&v, row, "d"), real_at(&v, row, "gamma")),
                             1e-6 + 20 * (double)WEFT_REAL_EPSILON);
    vectors_close(&v);
}

static void sigmoid_fit_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("sg_gain.csv", 200);
    for (int row = 0; row < v.csv.row_count; row++) {
        weft_sigmoid_fit fit = weft_gaussian_half_plane_fit(real_at(&v, row, "sigma_l"), real_at(&v, row, "sigma_p"),
                                                            real_at(&v, row, "gamma"));
        vectors_check_within(&v, row, "kappa", fit.gain, 1e-3 * vectors_number(&v, row, "kappa"));
        vectors_check_within(&v, row, "max_abs_error", fit.largest_error,
                             1e-3 * vectors_number(&v, row, "max_abs_error"));
    }
    vectors_close(&v);
}

static void extreme_widths_give_finite_values(void **state)
{
    (void)state;
    const weft_real widths[] = {0, (weft_real)1e-30, (weft_real)1e-9, (weft_real)0.3, (weft_real)1e18, INFINITY};
    const weft_vec3 up = {0, 0, 1}, along = {1, 0, 0};
    for (int i = 0; i < 6; i++) {
        assert_true(weft_spherical_gaussian(up, up, widths[i]) == 1);
        assert_true(weft_circular_gaussian(2, 2, widths[i]) == 1);
        assert_true(weft_spherical_gaussian_split(along, up, widths[i]).phi_width > 0);
        for (int j = 0; j < 6; j++) {
            weft_circular_lobe lobe = weft_circular_product(1, widths[i], -2, widths[j]);
            assert_true(isfinite(lobe.mean) && lobe.width > 0 && lobe.scale >= 0 && lobe.scale <= 1);
            assert_true(isfinite(weft_gaussian_box(2, widths[i], -1, widths[j])));
            weft_real share = weft_gaussian_half_plane(widths[i], widths[j], (weft_real)0.2, 1);
            assert_true(share >= 0.5 && share <= 1);
        }
    }
}

static void opposite_lobes_of_one_width_cancel(void **state)
{
    (void)state;
    weft_circular_lobe lobe = weft_circular_product(0, 2, (weft_real)WEFT_PI, 2);
    assert_true(fabs(lobe.scale - exp((weft_real)-1)) < 1e-6);
    assert_true(lobe.width > 1e3 && isfinite(lobe.mean));
}

static void sigmoid_never_overflows(void **state)
{
    (void)state;
    assert_true(weft_sigmoid((weft_real)1e30, -1) == 0);
    assert_true(weft_sigmoid((weft_real)1e30, 1) == 1);
    assert_true(weft_sigmoid(3, 0) == 0.5);
}

int test_spherical_gaussian(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(product_matches_every_row),
        cmocka_unit_test(split_matches_every_row),
        cmocka_unit_test(split_is_exact),
        cmocka_unit_test(box_matches_every_row),
        cmocka_unit_test(half_plane_share_matches_every_row),
        cmocka_unit_test(sigmoid_fit_matches_every_row),
        cmocka_unit_test(extreme_widths_give_finite_values),
        cmocka_unit_test(opposite_lobes_of_one_width_cancel),
        cmocka_unit_test(sigmoid_never_overflows),
    };
    return cmocka_run_group_tests_name("spherical gaussian", tests, NULL, NULL);
}

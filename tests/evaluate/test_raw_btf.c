#include "btf/direction/direction.h"
#include "evaluate/model.h"
#include "tests/compare/fixture.h"

#include <math.h>
#include <unistd.h>

static const char *const path = "raw_btf.btf.h5";

static weft_rgb diffuse(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)light, (void)view;
    return (weft_rgb){0.5 + 0.1 * x, 0.25, 0.1 + 0.1 * y};
}

/* Linear in the view's direction, so that planar interpolation is easy to predict at the measured directions only. */
static weft_rgb shiny(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)x, (void)y;
    weft_real aligned = weft_dot(light, view);
    return (weft_rgb){0.3 + 0.5 * aligned, 0.2 + light.x * 0.1, 0.4 + 0.2 * view.y};
}

static weft_vec3 direction(double theta_deg, double phi_deg)
{
    return weft_direction_of_angles((weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)});
}

typedef struct opened {
    weft_dataset *dataset;
    weft_raw_btf *raw;
} opened;

static opened open_raw(void)
{
    opened o;
    weft_error error = {0};
    expect_ok(weft_dataset_open(path, &o.dataset, &error), &error);
    expect_ok(weft_raw_btf_create(o.dataset, &o.raw, &error), &error);
    return o;
}

static void close_raw(opened *o)
{
    weft_raw_btf_free(o->raw);
    weft_dataset_close(o->dataset);
    unlink(path);
}

static void at_measured_directions_the_samples_come_back(void **state)
{
    (void)state;
    fixture_far_dataset(path, 3, 2, 3, shiny, FIXTURE_MASK_NONE);
    opened o = open_raw();
    for (int i = 0; i < 19; i += 3) {
        weft_vec3 light = weft_direction_of_angles(weft_ubo81_angles(i)),
                  view = weft_direction_of_angles(weft_ubo81_angles(18 - i));
        weft_rgb brdf, expected = shiny(0, 0, light, view);
        expect_ok(weft_raw_btf_sample(o.raw, 0.5, 0.25, light, view, &brdf, NULL), &(weft_error){0});
        assert_float_equal(brdf.r * WEFT_PI, expected.r, 1e-3);
        assert_float_equal(brdf.g * WEFT_PI, expected.g, 1e-3);
        assert_float_equal(brdf.b * WEFT_PI, expected.b, 1e-3);
    }
    close_raw(&o);
}

static void a_diffuse_texel_is_constant_between_directions(void **state)
{
    (void)state;
    fixture_far_dataset(path, 3, 2, 3, diffuse, FIXTURE_MASK_NONE);
    opened o = open_raw();
    for (int i = 0; i < 20; i++) {
        weft_rgb brdf;
        expect_ok(
            weft_raw_btf_sample(o.raw, 0.5, 0.75, direction(1.7 * i, 13 * i), direction(29 - i, 41 * i), &brdf, NULL),
            &(weft_error){0});
        assert_float_equal(brdf.r * WEFT_PI, 0.6, 1e-3);
        assert_float_equal(brdf.b * WEFT_PI, 0.1, 1e-3);
    }
    close_raw(&o);
}

static void texels_are_interpolated_and_repeated(void **state)
{
    (void)state;
    fixture_far_dataset(path, 3, 2, 2, diffuse, FIXTURE_MASK_NONE);
    opened o = open_raw();
    const weft_vec3 up = {0, 0, 1};
    weft_rgb between, repeated, wrapped;
    /* Texel centres lie at u = (x + 0.5) / 3 and v = 1 - (y + 0.5) / 2. */
    expect_ok(weft_raw_btf_sample(o.raw, 1.0 / 3, 0.75, up, up, &between, NULL), &(weft_error){0});
    expect_ok(weft_raw_btf_sample(o.raw, 1.0 / 3 - 2, 0.75 + 3, up, up, &repeated, NULL), &(weft_error){0});
    expect_ok(weft_raw_btf_sample(o.raw, 0, 0.25, up, up, &wrapped, NULL), &(weft_error){0});
    assert_float_equal(between.r * WEFT_PI, 0.55, 1e-3);
    assert_float_equal(repeated.r, between.r, 1e-6);
    assert_float_equal(wrapped.r * WEFT_PI, 0.6, 1e-3);
    assert_float_equal(wrapped.b * WEFT_PI, 0.2, 1e-3);
    close_raw(&o);
}

static void a_masked_sample_takes_no_part(void **state)
{
    (void)state;
    fixture_far_dataset(path, 1, 1, 2, diffuse, FIXTURE_MASK_ONE);
    opened o = open_raw();
    weft_rgb brdf;
    const weft_vec3 up = {0, 0, 1};
    expect_ok(weft_raw_btf_sample(o.raw, 0.5, 0.5, direction(5, 3), direction(4, 100), &brdf, NULL), &(weft_error){0});
    assert_float_equal(brdf.r * WEFT_PI, 0.5, 1e-3);
    expect_ok(weft_raw_btf_sample(o.raw, 0.5, 0.5, up, up, &brdf, NULL), &(weft_error){0});
    assert_true(isnan(brdf.r));
    close_raw(&o);
}

static void the_mean_is_that_of_all_texels(void **state)
{
    (void)state;
    fixture_far_dataset(path, 3, 2, 2, diffuse, FIXTURE_MASK_NONE);
    opened o = open_raw();
    weft_rgb brdf;
    expect_ok(weft_raw_btf_mean(o.raw, direction(10, 20), direction(3, 4), &brdf, NULL), &(weft_error){0});
    assert_float_equal(brdf.r * WEFT_PI, 0.6, 1e-3);
    assert_float_equal(brdf.b * WEFT_PI, 0.15, 1e-3);
    close_raw(&o);
}

static void directions_below_the_horizon_are_black(void **state)
{
    (void)state;
    fixture_far_dataset(path, 2, 2, 2, diffuse, FIXTURE_MASK_NONE);
    opened o = open_raw();
    weft_rgb brdf;
    expect_ok(weft_raw_btf_sample(o.raw, 0, 0, direction(95, 0), direction(0, 0), &brdf, NULL), &(weft_error){0});
    assert_true(brdf.r == 0 && brdf.g == 0 && brdf.b == 0);
    close_raw(&o);
}

static void near_lights_are_seen_from_each_texel(void **state)
{
    (void)state;
    fixture_near_dataset(path, 4, 5, diffuse);
    opened o = open_raw();
    const weft_dataset_layout *layout = weft_dataset_get_layout(o.dataset);
    weft_vec3 light = weft_dataset_light_direction(layout, 2, 3, 0);
    weft_rgb brdf;
    expect_ok(weft_raw_btf_sample(o.raw, 3.5 / 4, 3.5 / 4, light, light, &brdf, NULL), &(weft_error){0});
    assert_float_equal(brdf.r * WEFT_PI, 0.8, 1e-3);
    assert_float_equal(brdf.b * WEFT_PI, 0.1, 1e-3);
    close_raw(&o);
}

int test_raw_btf(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_measured_directions_the_samples_come_back),
        cmocka_unit_test(a_diffuse_texel_is_constant_between_directions),
        cmocka_unit_test(texels_are_interpolated_and_repeated),
        cmocka_unit_test(a_masked_sample_takes_no_part),
        cmocka_unit_test(the_mean_is_that_of_all_texels),
        cmocka_unit_test(directions_below_the_horizon_are_black),
        cmocka_unit_test(near_lights_are_seen_from_each_texel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

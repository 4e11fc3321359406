/* Intervals by hand, what is stored of them, and that damaged ones are refused. */
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include "btf/material/certificate.h"
#include "btf/material/metadata.h"

#include <math.h>
#include <string.h>

static weft_certificate example(void)
{
    weft_certificate c = {.probability = 0.95,
                          .over_images = true,
                          .image_count = 100,
                          .direction_count = 12,
                          .mean = 0.5,
                          .value = {0.1, 0.2, 0.4, 0.6, 0.8, 1, 2, 4},
                          .spread = {0.1, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.6},
                          .has_registration = true,
                          .level_count = 2,
                          .measured_levels = 1};
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        c.view[ring] = 1 + 0.1 * ring;
        c.light[ring] = 2 + 0.1 * ring;
        c.view_images[ring] = 10 * ring;
        c.light_images[ring] = 20 * ring;
        for (int k = 0; k < 2; k++) {
            c.level[k].fitted[ring] = 0.5 + 0.1 * k + 0.01 * ring;
            c.level[k].storage[ring] = 0.3;
            c.level[k].registration[ring] = 0.04 * ring;
        }
    }
    c.level[0].quantile = 1.1;
    c.level[1].quantile = 0.6;
    return c;
}

static weft_vec3 tilted(double theta_deg)
{
    return weft_direction_of_angles((weft_angles){weft_rad_of_deg(theta_deg), 1});
}

static double width(double level, double value, double light_deg, double view_deg)
{
    const weft_certificate c = example();
    return weft_certificate_half_width(&c, level, value, tilted(light_deg), tilted(view_deg));
}

/* mean 0.5: a value of 0.25 is half the mean, where the spread is halfway between 0.2 and 0.3. */
static void the_half_width_is_the_product_of_its_factors(void **state)
{
    (void)state;
    assert_float_equal(width(0, 0.25, 0, 0), 1.1 * 0.5 * 0.25 * 1 * 2, 1e-12);
    assert_float_equal(width(0, 0.25, 31, 0), 1.1 * 0.5 * 0.25 * 1 * 2.2, 1e-12);
    assert_float_equal(width(0, 0.25, 0, 58), 1.1 * 0.5 * 0.25 * 1.4 * 2, 1e-12);
    assert_float_equal(width(0, 0.25, 85, 85), 1.1 * 0.5 * 0.25 * 1.5 * 2.5, 1e-12);
}

static void beyond_the_knots_the_spread_stays(void **state)
{
    (void)state;
    assert_float_equal(width(0, -1, 0, 0), 1.1 * 0.5 * 0.1 * 2, 1e-12);
    assert_float_equal(width(0, 0.5 * 3, 0, 0), 1.1 * 0.5 * 0.65 * 2, 1e-12);
    assert_float_equal(width(0, 100, 0, 0), 1.1 * 0.5 * 0.6 * 2, 1e-12);
}

static void coarser_levels_have_the_last_quantile_and_the_finer_one_between(void **state)
{
    (void)state;
    assert_float_equal(width(0.9, 0.25, 0, 0), 1.1 * 0.25, 1e-12);
    assert_float_equal(width(1, 0.25, 0, 0), 0.6 * 0.25, 1e-12);
    assert_float_equal(width(7.5, 0.25, 0, 0), 0.6 * 0.25, 1e-12);
    assert_float_equal(width(-1, 0.25, 0, 0), 1.1 * 0.25, 1e-12);
    assert_true(width(0, 0.25, 95, 0) == 0 && width(0, 0.25, 0, 95) == 0);
}

static void parts_add_to_the_whole_as_they_are_said_to(void **state)
{
    (void)state;
    const weft_certificate c = example();
    weft_certificate_parts parts = weft_certificate_parts_of(&c, 1, 5);
    assert_float_equal(parts.sampling, 1 - 0.65, 1e-12);
    assert_float_equal(hypot(hypot(parts.model, parts.storage), parts.registration), 0.65, 1e-12);
    assert_float_equal(parts.registration, 0.2, 1e-12);
}

/* ---- Storage ---- */

static void what_is_stored_comes_back(void **state)
{
    (void)state;
    weft_certificate c = example(), read;
    c.level[0].quantile = 1.0001; /* is rounded up */
    c.spread[0] = 0;              /* is no factor */
    c.value[1] = 0.1001;          /* would not ascend */
    weft_certificate_round(&c);
    assert_float_equal(c.level[0].quantile, 1.001, 1e-12);
    assert_float_equal(c.spread[0], 0.001, 1e-12);
    assert_float_equal(c.value[1], 0.101, 1e-12);
    json_t *object = weft_certificate_pack(&c);
    assert_null(weft_certificate_unpack(object, &read));
    json_decref(object);
    assert_memory_equal(&read.view_images, &c.view_images, sizeof c.view_images);
    assert_memory_equal(&read.light_images, &c.light_images, sizeof c.light_images);
    assert_int_equal(read.measured_levels, 1);
    assert_true(read.over_images && read.has_registration && read.image_count == 100 && read.direction_count == 12);
    for (double theta = 0; theta < 90; theta += 7)
        assert_float_equal(weft_certificate_half_width(&read, 0, 0.3, tilted(theta), tilted(80 - 0.8 * theta)),
                           weft_certificate_half_width(&c, 0, 0.3, tilted(theta), tilted(80 - 0.8 * theta)), 1e-12);
    for (int k = 0; k < 2; k++)
        for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
            weft_certificate_parts a = weft_certificate_parts_of(&c, k, ring),
                                   b = weft_certificate_parts_of(&read, k, ring);
            assert_float_equal(a.model, b.model, 1e-12);
            assert_float_equal(a.registration, b.registration, 1e-12);
        }
}

/* The example with a member changed: a JSON text, or NULL to take it away. */
static json_t *changed(const char *name, const char *text)
{
    weft_certificate c = example();
    json_t *object = weft_certificate_pack(&c);
    if (text)
        assert_int_equal(json_object_set_new(object, name, json_loads(text, JSON_DECODE_ANY, NULL)), 0);
    else
        json_object_del(object, name);
    return object;
}

static void damaged_values_are_refused(void **state)
{
    (void)state;
    static const char *const damage[][3] = {
        {"probability", "1", "probability"},
        {"probability", "\"0.95\"", "probability"},
        {"mean", "0", "mean"},
        {"mean", NULL, "mean"},
        {"over", "\"all\"", "held out"},
        {"images", "0", "held out"},
        {"directions", "1.5", "held out"},
        {"images_by_view", "[1,2,3,4,5]", "held out"},
        {"images_by_light", "[1,2,3,4,5,-6]", "held out"},
        {"values", "[1,2,3,4,5,6,7,7]", "ascend"},
        {"values", "[1,2,3,4,5,6,7]", "ascend"},
        {"spreads", "[1,2,3,4,5,6,7,0]", "factor"},
        {"views", "[1,2,3,4,5,6.5]", "factor"},
        {"lights", "[1,2,3,4,5,1000000001]", "factor"},
        {"lights", NULL, "factor"},
        {"quantiles", "[]", "levels"},
        {"quantiles", "[1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1]", "levels"},
        {"quantiles", "[1]", "levels"},
        {"fitted", "[[1,2,3,4,5,6]]", "levels"},
        {"storage", "[[1,2,3,4,5,6],[1,2,3,4,5,-1]]", "levels"},
        {"registration", "7", "levels"},
        {"measured_levels", "3", "levels"},
        {"measured_levels", "0", "levels"},
    };
    for (size_t i = 0; i < sizeof damage / sizeof *damage; i++) {
        weft_certificate read;
        json_t *object = changed(damage[i][0], damage[i][1]);
        const char *fault = weft_certificate_unpack(object, &read);
        json_decref(object);
        if (!fault || !strstr(fault, damage[i][2]))
            fail_msg("%s = %s: %s", damage[i][0], damage[i][1] ? damage[i][1] : "nothing", fault ? fault : "taken");
    }
}

static void measured_levels_may_be_unknown(void **state)
{
    (void)state;
    weft_certificate read;
    json_t *object = changed("measured_levels", NULL);
    assert_null(weft_certificate_unpack(object, &read));
    assert_int_equal(read.measured_levels, 0);
    json_decref(object);
}

/* Between two levels the finer one counts. */
static void levels_beyond_the_measured_ones_are_told(void **state)
{
    (void)state;
    const weft_certificate c = {.level_count = 5, .measured_levels = 3}, unknown = {.level_count = 5};
    assert_true(weft_certificate_is_measured(&c, -1) && weft_certificate_is_measured(&c, 0));
    assert_true(weft_certificate_is_measured(&c, 2) && weft_certificate_is_measured(&c, 2.9));
    assert_false(weft_certificate_is_measured(&c, 3) || weft_certificate_is_measured(&c, 4.5));
    assert_false(weft_certificate_is_measured(&unknown, 0));
}

static void registration_may_be_absent(void **state)
{
    (void)state;
    weft_certificate read;
    json_t *object = changed("registration", NULL);
    assert_null(weft_certificate_unpack(object, &read));
    assert_false(read.has_registration);
    json_decref(object);
}

/* A file with a damaged certificate is refused as a whole, naming section and fault; one without has none. */
static void a_material_with_a_damaged_certificate_is_refused(void **state)
{
    (void)state;
    weft_material material, read;
    weft_certificate certificate;
    weft_error error = {0};
    bool found = true;
    expect_ok(weft_material_create(2, 2, 0, 0, 0, 0, &material, &error), &error);
    expect_ok(weft_certificate_read(material.metadata, &found, &certificate, &error), &error);
    assert_false(found);
    expect_ok(weft_material_put_metadata(&material, "certificate", changed("probability", "0.95"), &error), &error);
    expect_ok(weft_material_write("good.weft", &material, &error), &error);
    expect_ok(weft_material_read("good.weft", &read, &error), &error);
    expect_ok(weft_certificate_read(read.metadata, &found, &certificate, &error), &error);
    assert_true(found && certificate.level_count == 2);
    weft_material_free(&read);
    expect_ok(weft_material_put_metadata(&material, "certificate", changed("mean", "-1"), &error), &error);
    expect_ok(weft_material_write("bad.weft", &material, &error), &error);
    assert_int_equal(weft_class_of(weft_material_read("bad.weft", &read, &error)), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "bad.weft"));
    assert_non_null(strstr(error.message, "certificate whose mean"));
    assert_int_equal(weft_certificate_read(material.metadata, &found, &certificate, &error), WEFT_BAD_INPUT);
    weft_material_free(&material);
}

int test_certificate(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_half_width_is_the_product_of_its_factors),
        cmocka_unit_test(beyond_the_knots_the_spread_stays),
        cmocka_unit_test(coarser_levels_have_the_last_quantile_and_the_finer_one_between),
        cmocka_unit_test(parts_add_to_the_whole_as_they_are_said_to),
        cmocka_unit_test(what_is_stored_comes_back),
        cmocka_unit_test(damaged_values_are_refused),
        cmocka_unit_test(measured_levels_may_be_unknown),
        cmocka_unit_test(levels_beyond_the_measured_ones_are_told),
        cmocka_unit_test(registration_may_be_absent),
        cmocka_unit_test(a_material_with_a_damaged_certificate_is_refused),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}

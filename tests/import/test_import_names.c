#include "import/angle_name.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void expect_angles(const char *name, double tl, double pl, double tv, double pv)
{
    weft_named_angles angles;
    assert_true(weft_angle_name_parse(name, &angles));
    assert_float_equal(weft_deg_of_rad(angles.light.theta_rad), tl, 1e-9);
    assert_float_equal(weft_deg_of_rad(angles.light.phi_rad), pl, 1e-9);
    assert_float_equal(weft_deg_of_rad(angles.view.theta_rad), tv, 1e-9);
    assert_float_equal(weft_deg_of_rad(angles.view.phi_rad), pv, 1e-9);
}

static void names_of_the_public_sets_are_read(void **state)
{
    (void)state;
    expect_angles("tv045_pv090/tl030_pl120_tv045_pv090.png", 30, 120, 45, 90);
    expect_angles("00008 tl000 pl000 tv030 pv030.jpg", 0, 0, 30, 30);
    expect_angles("TL7.5_PL011.25_TV22.5_PV180.exr", 7.5, 11.25, 22.5, 180);
    expect_angles("plate_tvset_tl030_pl120_tv045_pv090.png", 30, 120, 45, 90);
}

static void names_without_all_four_angles_are_left_out(void **state)
{
    (void)state;
    static const char *const names[] = {"IMG_0001.png",
                                        "tl030_pl120_tv045.png",
                                        "tl030_tl031_pl120_tv045_pv090.png",
                                        "tl_pl120_tv045_pv090.png",
                                        "tl3.0.1_pl0_tv0_pv0.png",
                                        "tv045_pv090/tl030_pl120.png",
                                        ".png",
                                        ""};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        weft_named_angles angles;
        if (weft_angle_name_parse(names[i], &angles))
            fail_msg("'%s' was read", names[i]);
    }
}

static void half_degrees_need_a_point(void **state)
{
    (void)state;
    static const char *const clear[] = {"tl011.5_pl007.5_tv023.5_pv000.png", "00008 tl000 pl000 tv030 pv030.jpg",
                                        "tl030_pl120_tv045_pv090_1.png", "2026_tl030_pl120_tv045_pv090_0002.png"};
    static const char *const doubtful[] = {"tl0235_pl000_tv000_pv000.png", "tl000_pl000_tv000_pv0075.png",
                                           "tl011-5-pl000-tv000-pv000.png", "a/tl011_5_pl000_tv000_pv000.jpg"};
    for (size_t i = 0; i < sizeof clear / sizeof *clear; i++)
        assert_null(weft_angle_name_doubt(clear[i]));
    for (size_t i = 0; i < sizeof doubtful / sizeof *doubtful; i++) {
        if (!weft_angle_name_doubt(doubtful[i]))
            fail_msg("'%s' was believed", doubtful[i]);
    }
}

static void names_written_are_names_read(void **state)
{
    (void)state;
    const weft_named_angles angles = {{weft_rad_of_deg(30), weft_rad_of_deg(120)},
                                      {weft_rad_of_deg(75), weft_rad_of_deg(345)}};
    char name[64];
    weft_angle_name_write(&angles, name);
    assert_string_equal(name, "tl030_pl120_tv075_pv345");
    expect_angles(name, 30, 120, 75, 345);
}

int test_import_names(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_of_the_public_sets_are_read),
        cmocka_unit_test(names_without_all_four_angles_are_left_out),
        cmocka_unit_test(half_degrees_need_a_point),
        cmocka_unit_test(names_written_are_names_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

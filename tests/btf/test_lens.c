#include "btf/session/lens.h"
#include "tests/btf/lens_bridge.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Published lenses, and one with strong decentring. */
static const weft_camera lenses[] = {
    {.width = 640,
     .height = 480,
     .fx = 535.916,
     .fy = 535.916,
     .cx = 342.283,
     .cy = 235.571,
     .k1 = -0.26637,
     .k2 = -0.03859,
     .p1 = 0.00178,
     .p2 = -0.00028,
     .k3 = 0.23839},
    {.width = 640,
     .height = 480,
     .fx = 452.51,
     .fy = 456.77,
     .cx = 317.7,
     .cy = 277.75,
     .k1 = 0.121,
     .k2 = -1.085,
     .p1 = 1.2e-4,
     .p2 = -4.6e-4,
     .k3 = 2.954},
    {.width = 800,
     .height = 600,
     .fx = 900,
     .fy = 880,
     .cx = 380,
     .cy = 310,
     .k1 = -0.2,
     .k2 = 0.1,
     .p1 = 0.01,
     .p2 = -0.02,
     .k3 = 0.05},
};

enum { LENSES = sizeof lenses / sizeof lenses[0] };

static double distance(weft_pixel a, weft_pixel b)
{
    return hypot(a.x - b.x, a.y - b.y);
}

static void copy_lens(const weft_camera *c, double lens[WEFT_LENS_PARAMETERS])
{
    for (int i = 0; i < WEFT_LENS_PARAMETERS; i++)
        lens[i] = weft_lens_parameter(c, i);
}

static void a_lens_distorts_as_opencv_does(void **state)
{
    (void)state;
    for (int i = 0; i < LENSES; i++) {
        const weft_camera *c = &lenses[i];
        for (int y = 0; y < c->height; y += 17) {
            for (int x = 0; x < c->width; x += 17) {
                weft_pixel here = {x, y};
                weft_pixel ours = weft_camera_distort(c, here);
                double lens[WEFT_LENS_PARAMETERS], theirs[2];
                copy_lens(c, lens);
                opencv_project(lens, (x - c->cx) / c->fx, (y - c->cy) / c->fy, theirs);
                assert_true(hypot(ours.x - theirs[0], ours.y - theirs[1]) < 1e-9);
            }
        }
    }
}

static void the_inverse_is_that_of_opencv_and_exact(void **state)
{
    (void)state;
    for (int i = 0; i < LENSES; i++) {
        const weft_camera *c = &lenses[i];
        double worst = 0, away = 0;
        int lost = 0;
        for (int y = 0; y < c->height; y += 17) {
            for (int x = 0; x < c->width; x += 17) {
                weft_pixel here = {x, y}, ours = weft_camera_undistort(c, here);
                worst = fmax(worst, distance(weft_camera_distort(c, ours), here));
                double lens[WEFT_LENS_PARAMETERS], theirs[2];
                copy_lens(c, lens);
                opencv_undistort(lens, (const double[2]){x, y}, theirs);
                /* Its iteration does not converge everywhere: it must find the way back itself. */
                weft_pixel again = weft_camera_distort(c, (weft_pixel){theirs[0], theirs[1]});
                if (distance(again, here) < 1e-7)
                    away = fmax(away, hypot(ours.x - theirs[0], ours.y - theirs[1]));
                else
                    lost++;
            }
        }
        print_message("lens %d: there and back %.1e, from OpenCV's %.1e pixels, of which it lost %d\n", i, worst, away,
                      lost);
        assert_true(worst < 1e-9);
        assert_true(away < 1e-6);
        assert_true(lost < (i == 1 ? 200 : 1));
    }
}

/* k1 alone turns back at r = 1/sqrt(-3 k1) = 1.29, where it shows the radius 0.861. */
static void where_the_lens_turns_back_the_inverse_stays_on_the_axis_side(void **state)
{
    (void)state;
    weft_camera c = {.width = 2000, .height = 2000, .fx = 1000, .fy = 1000, .cx = 0, .cy = 0, .k1 = -0.2};
    double turn = 1000 / sqrt(0.6), shown = 1000 * (1 / sqrt(0.6)) * (1 - 0.2 / 0.6);
    for (int i = 1; i < 100; i++) {
        weft_pixel at = {0.6 * shown * i / 100, 0.8 * shown * i / 100};
        weft_pixel back = weft_camera_undistort(&c, at);
        assert_true(hypot(back.x, back.y) < turn);
        assert_true(distance(weft_camera_distort(&c, back), at) < 1e-6);
    }
    weft_pixel beyond = weft_camera_undistort(&c, (weft_pixel){0.6 * 3 * shown, 0.8 * 3 * shown});
    assert_true(fabs(hypot(beyond.x, beyond.y) - turn) < 0.01 * turn);
    /* It turns back, and forth again further out: that second branch is none of the lens. */
    c.k1 = -0.5;
    c.k2 = 0.11;
    for (double radius = 100; radius < 3000; radius += 100) {
        weft_pixel p = weft_camera_undistort(&c, (weft_pixel){radius, 0});
        assert_true(isfinite(p.x) && p.x > 0 && p.x < 1200);
    }
    assert_true(isnan(weft_camera_undistort(&c, (weft_pixel){NAN, 1}).x) ||
                isfinite(weft_camera_undistort(&c, (weft_pixel){NAN, 1}).x)); /* it ends */
}

/* Each coefficient alone turns a lens back: k2 where 1 + 5 k2 r^4 = 0, k3 where 1 + 7 k3 r^6 = 0, p1 below and p2 to
 * the left where 1 - 6 p r = 0. */
static void whatever_turns_the_lens_back_is_seen(void **state)
{
    (void)state;
    const struct {
        double k2, k3, p1, p2, turn, x, y; /* the way: x, y */
    } lens[] = {{-0.3, 0, 0, 0, pow(1.5, -1.0 / 4), 0.6, 0.8},
                {0, -0.3, 0, 0, pow(2.1, -1.0 / 6), 0.8, -0.6},
                {0, 0, 0.1, 0, 1 / 0.6, 0, -1},
                {0, 0, 0, 0.1, 1 / 0.6, -1, 0}};
    for (size_t i = 0; i < sizeof lens / sizeof lens[0]; i++) {
        weft_camera c = {.width = 2000, .height = 2000, .fx = 1000, .fy = 1000};
        c.k2 = lens[i].k2;
        c.k3 = lens[i].k3;
        c.p1 = lens[i].p1;
        c.p2 = lens[i].p2;
        for (double radius = 100; radius < 4000; radius += 100) {
            weft_pixel p = weft_camera_undistort(&c, (weft_pixel){radius * lens[i].x, radius * lens[i].y});
            assert_true(hypot(p.x, p.y) < 1000 * lens[i].turn);
        }
    }
}

static void what_is_written_is_read(void **state)
{
    (void)state;
    weft_error error = {0};
    for (int i = 0; i < LENSES; i++) {
        weft_lens lens = {.camera = lenses[i], .rms_px = 0.25}, back;
        for (int k = 0; k < WEFT_LENS_PARAMETERS; k++)
            lens.standard_error[k] = k + 0.5;
        const weft_lens_photograph photograph[] = {{"one.jpg", NULL}, {"tw\xffo.jpg", "blurred"}};
        expect_ok(weft_lens_write("lens.json", &lens, "plate:50", photograph, 2, &error), &error);
        expect_ok(weft_lens_read("lens.json", &back, &error), &error);
        for (int k = 0; k < WEFT_LENS_PARAMETERS; k++) {
            assert_true(fabs(weft_lens_parameter(&back.camera, k) - weft_lens_parameter(&lens.camera, k)) < 1e-9);
            assert_true(back.standard_error[k] == lens.standard_error[k]);
        }
        assert_int_equal(back.camera.width, lens.camera.width);
        assert_int_equal(back.camera.height, lens.camera.height);
        assert_true(back.rms_px == 0.25);
    }
}

static void assert_refused(const char *text, const char *word)
{
    weft_lens lens;
    weft_error error = {0};
    scratch_store("bad.json", text, strlen(text));
    assert_int_equal(weft_class_of(weft_lens_read("bad.json", &lens, &error)), WEFT_BAD_INPUT);
    if (!strstr(error.message, word) || !strstr(error.message, "bad.json"))
        fail_msg("'%s' does not say '%s'", error.message, word);
}

#define REST "\"cx\": 1, \"cy\": 2, \"k2\": 0, \"vignetting\": [0, 0, 0]"

static void a_bad_file_is_refused_with_its_fault(void **state)
{
    (void)state;
    assert_refused("{}", "is no lens");
    assert_refused("[1]", "is no lens");
    assert_refused("{\"weft_lens\": 2}", "version 2");
    assert_refused("{\"weft_lens\": 1, \"width\": 64}", "height");
    assert_refused("{\"weft_lens\": 1, \"width\": 64, \"height\": 0, \"fx\": 9, \"fy\": 9, \"k1\": 0, " REST "}",
                   "64 x 0");
    assert_refused("{\"weft_lens\": 1, \"width\": 64, \"height\": 9, \"fx\": -9, \"fy\": 9, \"k1\": 0, " REST "}",
                   "-9");
    assert_refused("{\"weft_lens\": 1, \"width\": 64, \"height\": 9, \"fx\": 9, \"fy\": 9, \"k1\": 1e9, " REST "}",
                   "'k1'");
    assert_refused("{\"weft_lens\": 1, \"width\": 64, \"height\": 9, \"fx\": 9, \"fy\": 9, \"k1\": \"0\", " REST "}",
                   "got string");
    assert_refused("{\"weft_lens\": 1, \"width\": 64, \"height\": 9, \"fx\": 9, \"fy\": 9, \"k1\": 0, \"p1\": [], " REST
                   "}",
                   "got array");
}

int test_lens(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lens_distorts_as_opencv_does),
        cmocka_unit_test(the_inverse_is_that_of_opencv_and_exact),
        cmocka_unit_test(where_the_lens_turns_back_the_inverse_stays_on_the_axis_side),
        cmocka_unit_test(whatever_turns_the_lens_back_is_seen),
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(a_bad_file_is_refused_with_its_fault),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}

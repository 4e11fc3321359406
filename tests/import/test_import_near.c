#include "base/vector.h"
#include "folder.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { PIXELS = 32, TEXELS = 8 };
static const double side_cm = 8;

/* A white diffuser photographed under a near light: BRDF 1/pi, so p = cos / pi x power / d^2. */
static void photograph_white(const test_folder *folder, const char *name, weft_vec3 light_cm, const double power[3])
{
    weft_image image;
    assert_int_equal(weft_image_create(PIXELS, PIXELS, &image, NULL), WEFT_OK);
    for (int i = 0; i < PIXELS * PIXELS; i++) {
        weft_vec3 at = weft_vec3_of((i % PIXELS + 0.5) / PIXELS * side_cm - side_cm / 2,
                                    side_cm / 2 - (i / PIXELS + 0.5) / PIXELS * side_cm, 0);
        weft_vec3 to_light = weft_subtract(light_cm, at);
        double d2 = weft_dot(to_light, to_light);
        for (int c = 0; c < 3; c++)
            image.pixels[3 * i + c] = (float)(to_light.z / sqrt(d2) / WEFT_PI * power[c] / d2);
    }
    folder_put_image(folder, name, &image);
    weft_image_free(&image);
}

static test_folder white_folder(void)
{
    test_folder folder = folder_make();
    folder_put_text(&folder, "camera_pos.txt", "0,0,30\n5,-3,20\n");
    folder_put_text(&folder, "light_pos.txt", "3,4,12\n-6,2,15\n");
    folder_put_text(&folder, "light_power.txt", "500,600,700\n");
    folder_put_text(&folder, "image_size.txt", "8\n");
    const double power[3] = {500, 600, 700};
    photograph_white(&folder, "00.exr", weft_vec3_of(3, 4, 12), power);
    photograph_white(&folder, "01.exr", weft_vec3_of(-6, 2, 15), power);
    return folder;
}

static void a_white_plane_imports_as_the_cosine_of_its_light(void **state)
{
    (void)state;
    test_folder folder = white_folder();
    weft_import_options options = weft_import_defaults();
    options.width = TEXELS;
    weft_error error = {0};
    if (folder_import(&folder, &options, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    imported import = folder_open(&folder);
    for (int image = 0; image < 2; image++) {
        for (int texel = 0; texel < TEXELS * TEXELS; texel++) {
            int x = texel % TEXELS, y = texel / TEXELS;
            weft_vec3 light = weft_dataset_light_direction(import.layout, image, x, y);
            for (int c = 0; c < 3; c++)
                assert_float_equal(imported_sample(&import, x, y, image, c), light.z, 2e-3);
        }
    }
    imported_close(&import);
    folder_remove(&folder);
}

static void positions_become_millimetres(void **state)
{
    (void)state;
    test_folder folder = white_folder();
    assert_int_equal(folder_import(&folder, NULL, NULL), WEFT_OK);
    imported import = folder_open(&folder);
    assert_int_equal(import.layout->distance, WEFT_NEAR);
    assert_int_equal(import.layout->view_count, 2);
    assert_float_equal(import.layout->texel_pitch_mm, 80.0 / PIXELS, 1e-9);
    assert_float_equal(import.layout->light[1].x, -60, 1e-4);
    assert_float_equal(import.layout->view[import.layout->view_of_image[1]].z, 200, 1e-4);
    imported_close(&import);
    folder_remove(&folder);
}

static void a_missing_photograph_is_masked(void **state)
{
    (void)state;
    test_folder folder = white_folder();
    folder_put_text(&folder, "camera_pos.txt", "0,0,30\n5,-3,20\n0,0,40\n");
    folder_put_text(&folder, "light_pos.txt", "3,4,12\n-6,2,15\n0,0,40\n");
    assert_int_equal(folder_import(&folder, NULL, NULL), WEFT_OK);
    imported import = folder_open(&folder);
    assert_int_equal(imported_mask(&import, 0, 0, 1), 0);
    assert_int_equal(imported_mask(&import, 0, 0, 2), WEFT_MASK_MISSING);
    imported_close(&import);
    folder_remove(&folder);
}

/* A grey photograph, of which `clipped` pixels of the top row are white. */
static void photograph_clipped(const test_folder *folder, const char *name, int clipped)
{
    weft_image image;
    assert_int_equal(weft_image_create(PIXELS, PIXELS, &image, NULL), WEFT_OK);
    for (int i = 0; i < 3 * PIXELS * PIXELS; i++)
        image.pixels[i] = i < 3 * clipped ? 1 : 0.5f;
    folder_put_image(folder, name, &image);
    weft_image_free(&image);
}

/* Texels that are clipped in one photograph have the other; those of both are named, as pictures show them black. */
static void texels_that_no_photograph_shows_are_named(void **state)
{
    (void)state;
    for (int both = 0; both < 2; both++) {
        test_folder folder = folder_make();
        weft_import_options options = weft_import_defaults();
        weft_import_report report;
        folder_put_text(&folder, "camera_pos.txt", "0,0,30\n5,-3,20\n");
        folder_put_text(&folder, "light_pos.txt", "3,4,12\n-6,2,15\n");
        folder_put_text(&folder, "light_power.txt", "500,600,700\n");
        folder_put_text(&folder, "image_size.txt", "8\n");
        photograph_clipped(&folder, "00.png", both ? 3 : 0);
        photograph_clipped(&folder, "01.png", 9);
        assert_int_equal(weft_import(folder.path, folder.dataset, &options, NULL, &report, NULL), WEFT_OK);
        int named = 0;
        for (int i = 0; i < report.notes.count; i++) {
            bool is_it = strstr(report.notes.line[i], "masked in every photograph") != NULL;
            assert_true(!is_it || strncmp(report.notes.line[i], "3 of 1024 texels", 16) == 0);
            named += is_it;
        }
        assert_int_equal(named, both);
        weft_import_report_free(&report);
        folder_remove(&folder);
    }
}

static void expect_refusal(const char *name, const char *text, const char *what)
{
    test_folder folder = white_folder();
    folder_put_text(&folder, name, text);
    weft_error error = {0};
    assert_int_equal(folder_import(&folder, NULL, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, name) || !strstr(error.message, what))
        fail_msg("'%s' does not say %s and %s", error.message, name, what);
    folder_remove(&folder);
}

static void tables_that_contradict_themselves_are_refused(void **state)
{
    (void)state;
    expect_refusal("light_pos.txt", "3,4,12\n", "1 lines");
    expect_refusal("light_pos.txt", "3,4,12\n-6,2\n", ":2");
    expect_refusal("light_pos.txt", "3,4,12\n-6,2,nan\n", ":2");
    expect_refusal("camera_pos.txt", "3,4,12\n-6,2,-5\n", "above the surface");
    expect_refusal("light_power.txt", "500,0,500\n", "positive");
    expect_refusal("image_size.txt", "0\n", "0 cm");
}

int test_import_near(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_white_plane_imports_as_the_cosine_of_its_light),
        cmocka_unit_test(positions_become_millimetres),
        cmocka_unit_test(a_missing_photograph_is_masked),
        cmocka_unit_test(texels_that_no_photograph_shows_are_named),
        cmocka_unit_test(tables_that_contradict_themselves_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

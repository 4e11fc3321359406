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
        cmocka_unit_test(tables_that_contradict_themselves_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

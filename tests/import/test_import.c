#include "base/atomic_file.h"
#include "base/picture/colour.h"
#include "folder.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

/* A grid of 4 views and 5 lights; photograph (v, l) is grey. */
static const char *const view_name[] = {"tv000_pv000", "tv030_pv000", "tv030_pv180", "tv060_pv090"};
static const char *const light_name[] = {"tl000_pl000", "tl030_pl045", "tl030_pl225", "tl060_pl120", "tl075_pl300"};

static float grey_of(int view, int light)
{
    return 0.1f + 0.04f * (float)(5 * view + light);
}

static void utia_name(int view, int light, const char *extension, char name[128])
{
    snprintf(name, 128, "%s/%s_%s.%s", view_name[view], light_name[light], view_name[view], extension);
}

static test_folder utia_folder(const char *extension)
{
    test_folder folder = folder_make();
    for (int i = 0; i < 20; i++) {
        char name[128];
        utia_name(i / 5, i % 5, extension, name);
        folder_put_grey(&folder, name, 6, 4, grey_of(i / 5, i % 5));
    }
    return folder;
}

static void a_utia_folder_of_8_bit_photographs_is_decoded_from_srgb(void **state)
{
    (void)state;
    test_folder folder = utia_folder("png");
    weft_error error = {0};
    assert_int_equal(folder_import(&folder, NULL, &error), WEFT_OK);
    imported import = folder_open(&folder);
    assert_int_equal(import.layout->width, 6);
    assert_int_equal(import.layout->height, 4);
    assert_int_equal(import.layout->image_count, 20);
    assert_int_equal(import.layout->view_count, 4);
    assert_int_equal(import.layout->distance, WEFT_FAR);
    assert_int_equal(import.layout->values, WEFT_REFLECTANCE_COSINE);
    int image = imported_image(&import, 60, 120, 30, 180);
    float expected = weft_linear_of_srgb(roundf(grey_of(2, 3) * 255) / 255);
    assert_float_equal(imported_sample(&import, 5, 3, image, 1), expected, 2e-4);
    assert_int_equal(imported_mask(&import, 5, 3, image), 0);
    imported_close(&import);
    folder_remove(&folder);
}

static void a_full_turn_is_the_same_view(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    folder_put_grey(&folder, "tl000_pl000_tv045_pv000.png", 2, 2, 0.3f);
    folder_put_grey(&folder, "tl030_pl090_tv045_pv360.png", 2, 2, 0.4f);
    assert_int_equal(folder_import(&folder, NULL, NULL), WEFT_OK);
    imported import = folder_open(&folder);
    assert_int_equal(import.layout->image_count, 2);
    assert_int_equal(import.layout->view_count, 1);
    imported_close(&import);
    folder_remove(&folder);
}

static void float_photographs_are_linear_already(void **state)
{
    (void)state;
    test_folder folder = utia_folder("exr");
    assert_int_equal(folder_import(&folder, NULL, NULL), WEFT_OK);
    imported import = folder_open(&folder);
    int image = imported_image(&import, 75, 300, 60, 90);
    assert_float_equal(imported_sample(&import, 0, 0, image, 2), grey_of(3, 4), 5e-4);
    imported_close(&import);
    folder_remove(&folder);
}

static void rows_and_channels_keep_their_place(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    weft_image image;
    assert_int_equal(weft_image_create(3, 2, &image, NULL), WEFT_OK);
    for (int i = 0; i < 18; i++)
        image.pixels[i] = 0.01f * (float)i;
    folder_put_image(&folder, "00001 tl015 pl000 tv000 pv000.exr", &image);
    weft_image_free(&image);
    assert_int_equal(folder_import(&folder, NULL, NULL), WEFT_OK);
    imported import = folder_open(&folder);
    for (int i = 0; i < 18; i++)
        assert_float_equal(imported_sample(&import, i / 3 % 3, i / 9, 0, i % 3), 0.01f * (float)i, 1e-4);
    imported_close(&import);
    folder_remove(&folder);
}

static void a_hole_in_a_grid_becomes_a_masked_image(void **state)
{
    (void)state;
    test_folder folder = utia_folder("png");
    char name[128], path[256];
    utia_name(1, 2, "png", name);
    snprintf(path, sizeof path, "%s/%s", folder.path, name);
    assert_int_equal(unlink(path), 0);
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    assert_int_equal(weft_import(folder.path, folder.dataset, &options, NULL, &report, NULL), WEFT_OK);
    assert_int_equal(report.missing_count, 1);
    assert_int_equal(report.image_count, 20);
    bool named = false;
    for (int i = 0; i < report.notes.count; i++)
        named = named || strstr(report.notes.line[i], "tl030_pl225_tv030_pv000");
    assert_true(named);
    weft_import_report_free(&report);
    imported import = folder_open(&folder);
    int image = imported_image(&import, 30, 225, 30, 0);
    assert_int_equal(imported_mask(&import, 2, 2, image), WEFT_MASK_MISSING);
    imported_close(&import);
    folder_remove(&folder);
}

static void a_table_of_directions_wins_over_names(void **state)
{
    (void)state;
    test_folder folder = utia_folder("png");
    folder_put_text(&folder, "directions.csv",
                    "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg,file\n"
                    "7.5,12,0,0,tv000_pv000/tl030_pl045_tv000_pv000.png\n"
                    "30,90,10,20,tv000_pv000/none.png\n");
    assert_int_equal(folder_import(&folder, NULL, NULL), WEFT_OK);
    imported import = folder_open(&folder);
    assert_int_equal(import.layout->image_count, 2);
    int image = imported_image(&import, 7.5, 12, 0, 0);
    assert_float_equal(imported_sample(&import, 0, 0, image, 0), weft_linear_of_srgb(roundf(grey_of(0, 1) * 255) / 255),
                       2e-4);
    assert_int_equal(imported_mask(&import, 0, 0, imported_image(&import, 30, 90, 10, 20)), WEFT_MASK_MISSING);
    imported_close(&import);
    folder_remove(&folder);
}

/* Excel's mark of the byte order before the first name, and its ends of lines. */
static void a_table_of_a_spreadsheet_is_read_and_lists_a_photograph_once(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    folder_put_grey(&folder, "a.png", 2, 2, 0.5f);
    folder_put_text(&folder, "directions.csv",
                    "\xef\xbb\xbf"
                    "file,theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\r\na.png,10,0,0,0\r\n");
    assert_int_equal(folder_import(&folder, NULL, NULL), WEFT_OK);
    folder_put_text(&folder, "directions.csv",
                    "file,theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\na.png,10,0,0,0\na.png,20,0,0,0\n");
    weft_error error = {0};
    assert_int_equal(folder_import(&folder, NULL, &error), WEFT_BAD_INPUT);
    assert_string_equal(error.message, "directions.csv lists 'a.png' twice");
    folder_remove(&folder);
}

static void a_table_cannot_reach_outside_its_folder(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    folder_put_text(&folder, "directions.csv",
                    "file,theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n../a.png,0,0,0,0\n");
    weft_error error = {0};
    assert_int_equal(folder_import(&folder, NULL, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "directions.csv:2"));
    folder_remove(&folder);
}

static void a_clipped_pixel_masks_the_texel_it_falls_into(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    weft_image image;
    assert_int_equal(weft_image_create(4, 4, &image, NULL), WEFT_OK);
    for (int i = 0; i < 48; i++)
        image.pixels[i] = 0.5f;
    image.pixels[3 * (4 * 3 + 2) + 1] = 1;
    folder_put_image(&folder, "tl000_pl000_tv000_pv000.png", &image);
    weft_image_free(&image);
    weft_import_options options = weft_import_defaults();
    options.width = 2;
    assert_int_equal(folder_import(&folder, &options, NULL), WEFT_OK);
    imported import = folder_open(&folder);
    assert_int_equal(imported_mask(&import, 1, 1, 0), WEFT_MASK_SATURATED);
    assert_int_equal(
        imported_mask(&import, 0, 0, 0) + imported_mask(&import, 1, 0, 0) + imported_mask(&import, 0, 1, 0), 0);
    imported_close(&import);
    folder_remove(&folder);
}

static void areas_that_divide_pixels_keep_the_mean(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    weft_image image;
    assert_int_equal(weft_image_create(5, 5, &image, NULL), WEFT_OK);
    double mean = 0;
    for (int i = 0; i < 75; i++) {
        image.pixels[i] = (float)(i * 37 % 64) / 64;
        mean += (double)image.pixels[i] / 75;
    }
    folder_put_image(&folder, "tl000_pl000_tv000_pv000.exr", &image);
    weft_image_free(&image);
    weft_import_options options = weft_import_defaults();
    options.width = 3;
    assert_int_equal(folder_import(&folder, &options, NULL), WEFT_OK);
    imported import = folder_open(&folder);
    double reduced = 0;
    for (int i = 0; i < 27; i++)
        reduced += (double)imported_sample(&import, i / 3 % 3, i / 9, 0, i % 3) / 27;
    assert_float_equal(reduced, mean, 1e-4);
    imported_close(&import);
    folder_remove(&folder);
}

/* The mean of the numbers of the pixels between two places on an axis, from 0 at the outer side of pixel 0. */
static double mean_index(double begin, double end)
{
    double sum = 0;
    for (int i = 0; i < end; i++)
        sum += i * fmax(0, fmin(end, i + 1) - fmax(begin, i));
    return sum / (end - begin);
}

/* Texels are square, and as many as fit; what is left over is cut off on both sides alike. */
static void any_size_can_be_imported_in_any_smaller_one(void **state)
{
    (void)state;
    enum { WIDE = 9, HIGH = 8 };
    for (int width = 1; width <= WIDE; width++) {
        test_folder folder = folder_make();
        weft_image image;
        assert_int_equal(weft_image_create(WIDE, HIGH, &image, NULL), WEFT_OK);
        /* A slope down the picture and across. */
        for (int i = 0; i < WIDE * HIGH; i++) {
            for (int c = 0; c < 3; c++)
                image.pixels[3 * i + c] = 0.25f + 0.03f * (float)(i / WIDE) + 0.01f * (float)(i % WIDE);
        }
        folder_put_image(&folder, "tl000_pl000_tv000_pv000.exr", &image);
        weft_image_free(&image);
        weft_import_options options = weft_import_defaults();
        weft_error error = {0};
        options.width = width;
        int height = width * HIGH / WIDE;
        weft_code code = folder_import(&folder, &options, &error);
        assert_int_equal(code, height ? WEFT_OK : WEFT_BAD_USAGE);
        if (code == WEFT_OK) {
            imported import = folder_open(&folder);
            double side = (double)WIDE / width, above = (HIGH - height * side) / 2;
            assert_true(import.layout->width == width && import.layout->height == height);
            for (int i = 0; i < width * height; i++) {
                double left = side * (i % width), top = above + side * (i / width);
                double expected = 0.25 + 0.03 * mean_index(top, top + side) + 0.01 * mean_index(left, left + side);
                assert_float_equal(imported_sample(&import, i % width, i / width, 0, 1), expected, 5e-4);
            }
            imported_close(&import);
        }
        folder_remove(&folder);
    }
}

/* Shows two more columns of an EXR picture than its file holds. */
static void show_more(const test_folder *folder, const char *name)
{
    static const char attribute[] = "displayWindow\0box2i\0\20\0\0";
    char path[512], bytes[8192];
    snprintf(path, sizeof path, "%s/%s", folder->path, name);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    char *found = memmem(bytes, size, attribute, sizeof attribute);
    assert_non_null(found);
    int32_t right;
    memcpy(&right, found + sizeof attribute + 8, 4);
    right += 2;
    memcpy(found + sizeof attribute + 8, &right, 4);
    assert_int_equal(weft_write_file(path, bytes, size, NULL), WEFT_OK);
}

static void pixels_that_a_file_lacks_are_missing(void **state)
{
    (void)state;
    static const char name[] = "tl000_pl000_tv000_pv000.exr";
    for (int width = 6; width >= 2; width /= 3) {
        test_folder folder = folder_make();
        weft_import_options options = weft_import_defaults();
        weft_import_report report;
        weft_error error = {0};
        folder_put_grey(&folder, name, 4, 6, 0.5f);
        show_more(&folder, name);
        options.width = width;
        if (weft_import(folder.path, folder.dataset, &options, NULL, &report, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        bool is_told = false;
        for (int i = 0; i < report.notes.count; i++)
            is_told = is_told || (strstr(report.notes.line[i], name) && strstr(report.notes.line[i], "as missing"));
        assert_true(is_told);
        assert_float_equal(report.mean, 0.5, 1e-3);
        weft_import_report_free(&report);
        imported import = folder_open(&folder);
        for (int x = 0; x < width; x++) {
            bool is_there = (x + 1) * 6 / width <= 4;
            assert_int_equal(imported_mask(&import, x, 0, 0), is_there ? 0 : WEFT_MASK_MISSING);
            if (is_there)
                assert_float_equal(imported_sample(&import, x, 0, 0, 0), 0.5, 1e-3);
        }
        imported_close(&import);
        folder_remove(&folder);
    }
}

/* ---- Photographs that cannot be used ---- */

static void expect_refusal(const test_folder *folder, const char *name, const char *what)
{
    weft_error error = {0};
    assert_int_equal(weft_class_of(folder_import(folder, NULL, &error)), WEFT_BAD_INPUT);
    if (!strstr(error.message, name) || !strstr(error.message, what))
        fail_msg("'%s' does not say %s and %s", error.message, name, what);
    assert_int_not_equal(access(folder->dataset, F_OK), 0);
}

static void a_truncated_photograph_is_named_or_skipped(void **state)
{
    (void)state;
    test_folder folder = utia_folder("png");
    char name[128];
    utia_name(2, 1, "png", name);
    folder_truncate(&folder, name);
    expect_refusal(&folder, name, "");
    weft_import_options options = weft_import_defaults();
    options.skip_bad = true;
    assert_int_equal(folder_import(&folder, &options, NULL), WEFT_OK);
    imported import = folder_open(&folder);
    assert_int_equal(imported_mask(&import, 0, 0, imported_image(&import, 30, 45, 30, 180)), WEFT_MASK_MISSING);
    imported_close(&import);
    folder_remove(&folder);
}

static void a_photograph_of_another_size_is_named_with_both_sizes(void **state)
{
    (void)state;
    test_folder folder = utia_folder("png");
    char name[128];
    utia_name(3, 3, "png", name);
    folder_put_grey(&folder, name, 5, 4, 0.5f);
    expect_refusal(&folder, name, "5 x 4");
    expect_refusal(&folder, name, "6 x 4");
    folder_remove(&folder);
}

static void a_photograph_with_nan_is_named_with_the_pixel(void **state)
{
    (void)state;
    test_folder folder = utia_folder("exr");
    weft_image image;
    assert_int_equal(weft_image_create(6, 4, &image, NULL), WEFT_OK);
    image.pixels[3 * (6 * 2 + 5)] = NAN;
    char name[128];
    utia_name(1, 1, "exr", name);
    folder_put_image(&folder, name, &image);
    weft_image_free(&image);
    expect_refusal(&folder, name, "(5, 2)");
    folder_remove(&folder);
}

static void two_photographs_of_one_pair_of_directions_are_refused(void **state)
{
    (void)state;
    test_folder folder = utia_folder("png");
    folder_put_grey(&folder, "again tl030 pl045 tv030 pv000.png", 6, 4, 0.5f);
    expect_refusal(&folder, "again tl030 pl045 tv030 pv000.png", "tl030_pl045_tv030_pv000.png");
    folder_remove(&folder);
}

/* Of duplicates the first by its name stays, a listed one that is not there never. */
static void doubled_photographs_are_left_out_on_demand(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    folder_put_grey(&folder, "b.png", 2, 2, 1);
    folder_put_grey(&folder, "c.png", 2, 2, 0);
    folder_put_grey(&folder, "d.png", 2, 2, 0.5f);
    folder_put_text(&folder, "directions.csv",
                    "file,theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                    "c.png,10,0,0,0\na.png,10,0,0,0\nd.png,20,0,0,0\nb.png,10,360,0,0\n");
    expect_refusal(&folder, "'b.png' and 'c.png' have the same light and view", "--skip-bad");
    weft_import_options options = weft_import_defaults();
    options.skip_bad = options.linear = true;
    options.saturated_at = 2;
    options.texel_pitch_mm = 1;
    weft_import_report report;
    assert_int_equal(weft_import(folder.path, folder.dataset, &options, NULL, &report, NULL), WEFT_OK);
    assert_int_equal(report.image_count, 2);
    for (int i = 2; i < report.notes.count; i++)
        fail_msg("%s", report.notes.line[i]);
    assert_string_equal(report.notes.line[0], "left out 'c.png': it has the light and view of 'b.png'");
    assert_string_equal(report.notes.line[1], "left out 'a.png': it has the light and view of 'b.png'");
    weft_import_report_free(&report);
    imported import = folder_open(&folder);
    assert_float_equal(imported_sample(&import, 0, 0, imported_image(&import, 10, 0, 0, 0), 0), 1, 1e-3);
    assert_float_equal(imported_sample(&import, 0, 0, imported_image(&import, 20, 0, 0, 0), 0), 0.5, 2e-3);
    imported_close(&import);
    folder_remove(&folder);
}

static void a_view_below_the_horizon_is_refused(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    folder_put_grey(&folder, "tl030_pl000_tv095_pv000.png", 2, 2, 0.5f);
    expect_refusal(&folder, "tl030_pl000_tv095_pv000.png", "95 degrees");
    folder_remove(&folder);
}

static void an_empty_folder_and_a_file_are_refused(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    expect_refusal(&folder, folder.path, "no photograph");
    folder_put_text(&folder, "set.zip", "PK");
    char path[128];
    snprintf(path, sizeof path, "%s/set.zip", folder.path);
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    weft_error error = {0};
    assert_int_equal(weft_import(path, folder.dataset, &options, NULL, &report, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "not a folder"));
    folder_remove(&folder);
}

static void more_texels_than_pixels_are_refused(void **state)
{
    (void)state;
    test_folder folder = utia_folder("png");
    weft_import_options options = weft_import_defaults();
    options.width = 7;
    assert_int_equal(folder_import(&folder, &options, NULL), WEFT_BAD_USAGE);
    folder_remove(&folder);
}

int test_import(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_utia_folder_of_8_bit_photographs_is_decoded_from_srgb),
        cmocka_unit_test(a_full_turn_is_the_same_view),
        cmocka_unit_test(float_photographs_are_linear_already),
        cmocka_unit_test(rows_and_channels_keep_their_place),
        cmocka_unit_test(a_hole_in_a_grid_becomes_a_masked_image),
        cmocka_unit_test(a_table_of_directions_wins_over_names),
        cmocka_unit_test(a_table_of_a_spreadsheet_is_read_and_lists_a_photograph_once),
        cmocka_unit_test(a_table_cannot_reach_outside_its_folder),
        cmocka_unit_test(a_clipped_pixel_masks_the_texel_it_falls_into),
        cmocka_unit_test(areas_that_divide_pixels_keep_the_mean),
        cmocka_unit_test(any_size_can_be_imported_in_any_smaller_one),
        cmocka_unit_test(pixels_that_a_file_lacks_are_missing),
        cmocka_unit_test(a_truncated_photograph_is_named_or_skipped),
        cmocka_unit_test(a_photograph_of_another_size_is_named_with_both_sizes),
        cmocka_unit_test(a_photograph_with_nan_is_named_with_the_pixel),
        cmocka_unit_test(two_photographs_of_one_pair_of_directions_are_refused),
        cmocka_unit_test(doubled_photographs_are_left_out_on_demand),
        cmocka_unit_test(a_view_below_the_horizon_is_refused),
        cmocka_unit_test(an_empty_folder_and_a_file_are_refused),
        cmocka_unit_test(more_texels_than_pixels_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

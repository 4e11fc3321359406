/* Photographs of one view under many lamps, with an .lp file. */
#include "folder.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char *const list = "4\n"
                                "D:\\RTI\\JPG\\C.PNG -0.5 0 0.8660254\n"
                                "D:\\RTI\\JPG\\A.PNG 0 0 1\n"
                                "D:\\RTI\\JPG\\B.PNG 0 0.8660254 0.5\n"
                                "D:\\RTI\\JPG\\gone.PNG 0.5 0 0.8660254\n";

static test_folder rti_folder(void)
{
    test_folder folder = folder_make();
    folder_put_grey(&folder, "jpg/a.png", 4, 4, 0.2f);
    folder_put_grey(&folder, "jpg/b.png", 4, 4, 0.4f);
    folder_put_grey(&folder, "jpg/c.png", 4, 4, 0.6f);
    folder_put_grey(&folder, "jpg/mask.png", 4, 4, 0.9f);
    return folder;
}

static weft_code import_with(const test_folder *folder, const weft_import_options *options, weft_import_report *report,
                             weft_error *error)
{
    return weft_import(folder->path, folder->dataset, options, NULL, report, error);
}

static bool is_said(const weft_import_report *report, const char *a, const char *b)
{
    for (int i = 0; i < report->notes.count; i++) {
        if (strstr(report->notes.line[i], a) && strstr(report->notes.line[i], b))
            return true;
    }
    return false;
}

static void an_lp_file_gives_one_view_and_its_lamps(void **state)
{
    (void)state;
    test_folder folder = rti_folder();
    folder_put_text(&folder, "stones.LP", list);
    weft_import_options options = weft_import_defaults();
    options.linear = true;
    weft_import_report report;
    assert_int_equal(import_with(&folder, &options, &report, NULL), WEFT_OK);
    assert_int_equal(report.image_count, 4);
    assert_int_equal(report.view_count, 1);
    assert_int_equal(report.missing_count, 1);
    assert_true(is_said(&report, "missing", "gone.PNG"));
    assert_true(is_said(&report, "left out", "mask.png"));
    weft_import_report_free(&report);
    imported import = folder_open(&folder);
    assert_float_equal(import.layout->view[0].z, 1, 1e-9);
    assert_float_equal(imported_sample(&import, 0, 0, imported_image(&import, 0, 0, 0, 0), 0), 0.2, 0.003);
    assert_float_equal(imported_sample(&import, 0, 0, imported_image(&import, 60, 90, 0, 0), 0), 0.4, 0.003);
    assert_float_equal(imported_sample(&import, 0, 0, imported_image(&import, 30, 180, 0, 0), 0), 0.6, 0.003);
    assert_int_equal(imported_mask(&import, 0, 0, imported_image(&import, 30, 0, 0, 0)), WEFT_MASK_MISSING);
    imported_close(&import);
    folder_remove(&folder);
}

static void integer_photographs_are_srgb_unless_said(void **state)
{
    (void)state;
    test_folder folder = rti_folder();
    folder_put_text(&folder, "stones.lp", list);
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    assert_int_equal(import_with(&folder, &options, &report, NULL), WEFT_OK);
    weft_import_report_free(&report);
    imported import = folder_open(&folder);
    assert_float_equal(imported_sample(&import, 0, 0, imported_image(&import, 60, 90, 0, 0), 0), 0.1329, 0.002);
    imported_close(&import);
    folder_remove(&folder);
}

static void a_list_elsewhere_is_named(void **state)
{
    (void)state;
    test_folder folder = rti_folder();
    FILE *file = fopen("elsewhere.lp", "w");
    assert_non_null(file);
    fputs(list, file);
    fclose(file);
    weft_import_options options = weft_import_defaults();
    options.lights = "elsewhere.lp";
    weft_import_report report;
    assert_int_equal(import_with(&folder, &options, &report, NULL), WEFT_OK);
    assert_int_equal(report.view_count, 1);
    weft_import_report_free(&report);
    unlink("elsewhere.lp");
    folder_remove(&folder);
}

static void a_lamp_below_the_horizon_is_left_out(void **state)
{
    (void)state;
    test_folder folder = rti_folder();
    folder_put_text(&folder, "l.lp", "3\na.png 0 0 1\nb.png 0.6 0 -0.8\nc.png 0 0.6 0.8\n");
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    assert_int_equal(import_with(&folder, &options, &report, NULL), WEFT_OK);
    assert_int_equal(report.image_count, 2);
    assert_true(is_said(&report, "b.png", "l.lp:3"));
    weft_import_report_free(&report);
    folder_remove(&folder);
}

static void two_lists_and_bad_rows_are_refused(void **state)
{
    (void)state;
    test_folder folder = rti_folder();
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    weft_error error = {0};
    folder_put_text(&folder, "l.lp", "1\na.png 0 0\n");
    assert_int_equal(import_with(&folder, &options, &report, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "l.lp:2:"));
    folder_put_text(&folder, "m.lp", list);
    assert_int_equal(import_with(&folder, &options, &report, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "2 .lp files"));
    folder_remove(&folder);
}

int test_import_lights(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_lp_file_gives_one_view_and_its_lamps),
        cmocka_unit_test(integer_photographs_are_srgb_unless_said),
        cmocka_unit_test(a_list_elsewhere_is_named),
        cmocka_unit_test(a_lamp_below_the_horizon_is_left_out),
        cmocka_unit_test(two_lists_and_bad_rows_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* What lies about in folders that went through other systems: copies, thumbnails, files that are no pictures. */
#include "folder.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>
#include <string.h>

static const char name[] = "tl030_pl000_tv000_pv000.png", in_capitals[] = "TL030_PL000_TV000_PV000.PNG";

/* The notes of an import that has to succeed, a line each; the caller frees. */
static char *notes_of(const test_folder *folder, int images)
{
    weft_import_options options = weft_import_defaults();
    options.texel_pitch_mm = 1;
    weft_import_report report;
    weft_error error = {0};
    if (weft_import(folder->path, folder->dataset, &options, NULL, &report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_int_equal(report.image_count, images);
    char *notes = calloc(1, 4096);
    for (int i = 0; i < report.notes.count; i++) {
        strncat(notes, report.notes.line[i], 200);
        strcat(notes, "\n");
    }
    weft_import_report_free(&report);
    return notes;
}

static void assert_notes(const test_folder *folder, int images, const char *expected)
{
    char *notes = notes_of(folder, images);
    assert_string_equal(notes, expected);
    free(notes);
}

static void a_copy_under_a_name_in_capitals_is_left_out(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    folder_put_grey(&folder, name, 4, 4, 0.25f);
    folder_put_grey(&folder, in_capitals, 4, 4, 0.25f);
    assert_notes(&folder, 1, "left out 'tl030_pl000_tv000_pv000.png': it is a copy of 'TL030_PL000_TV000_PV000.PNG'\n");
    folder_put_grey(&folder, name, 4, 4, 0.5f);
    weft_error error = {0};
    assert_int_equal(folder_import(&folder, NULL, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "have the same light and view"));
    folder_remove(&folder);
}

static void a_copy_in_a_series_of_lamps_is_left_out(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    folder_put_grey(&folder, "a.png", 4, 4, 0.25f);
    folder_put_grey(&folder, "copies/a.png", 4, 4, 0.25f);
    folder_put_text(&folder, "lamps.lp", "1\na.png 0 0 1\n");
    assert_notes(&folder, 1, "left out 'copies/a.png': it is a copy of 'a.png'\n");
    folder_put_grey(&folder, "copies/a.png", 4, 4, 0.5f);
    weft_error error = {0};
    assert_int_equal(folder_import(&folder, NULL, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "both have this name"));
    folder_remove(&folder);
}

/* The names of macOS, Windows and a Synology; the thumbnail has another size. */
static void what_systems_leave_behind_stops_nothing(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    folder_put_grey(&folder, name, 4, 4, 0.25f);
    folder_put_text(&folder, "._tl030_pl000_tv000_pv000.png", "AppleDouble");
    folder_put_text(&folder, "__MACOSX/tl030_pl000_tv000_pv000.png", "AppleDouble");
    folder_put_text(&folder, "Thumbs.db", "thumbnails");
    folder_put_grey(&folder, "@eaDir/tl030_pl000_tv000_pv000.png", 2, 2, 0.25f);
    folder_put_grey(&folder, ".thumbnails/tl030_pl000_tv000_pv000.png", 2, 2, 0.25f);
    assert_notes(&folder, 1, "");
    folder_remove(&folder);
}

static void tenths_of_degrees_are_not_taken_for_degrees(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    folder_put_grey(&folder, "tl0075_pl000_tv000_pv000.png", 4, 4, 0.25f);
    weft_error error = {0};
    assert_int_equal(folder_import(&folder, NULL, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "'tl0075_pl000_tv000_pv000.png': four digits"));
    folder_remove(&folder);
}

int test_import_copies(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_copy_under_a_name_in_capitals_is_left_out),
        cmocka_unit_test(a_copy_in_a_series_of_lamps_is_left_out),
        cmocka_unit_test(what_systems_leave_behind_stops_nothing),
        cmocka_unit_test(tenths_of_degrees_are_not_taken_for_degrees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

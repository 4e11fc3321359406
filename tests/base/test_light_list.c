#include "base/text/light_list.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static weft_code read_text(const char *path, const char *text, weft_light_list *list, weft_error *error)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    weft_code code = weft_light_list_read(path, list, error);
    unlink(path);
    return code;
}

static void assert_refused(const char *path, const char *text, const char *reason)
{
    weft_light_list list;
    weft_error error = {0};
    assert_int_equal(read_text(path, text, &list, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, reason))
        fail_msg("'%s' does not say '%s'", error.message, reason);
}

static void assert_light(const weft_light_list *list, const char *photograph, double x, double y, double z)
{
    int row = weft_light_list_find(list, photograph);
    if (row < 0)
        fail_msg("'%s' is not found", photograph);
    assert_float_equal(list->row[row].light.x, x, 1e-6);
    assert_float_equal(list->row[row].light.y, y, 1e-6);
    assert_float_equal(list->row[row].light.z, z, 1e-6);
}

/* As they come from other computers: a byte order mark, line ends, folders of two systems, blanks and quotes in names.
 */
static void an_lp_file_of_another_computer_is_read(void **state)
{
    (void)state;
    weft_light_list list;
    assert_int_equal(read_text("other.lp",
                               "\xef\xbb\xbf 4 \r\n"
                               "C:\\Users\\me\\my stones\\IMG 2.JPG\t0.6 0 0.8\r\n"
                               "/home/me/img_1.tif  0 -0.6   0.8\r\n"
                               "\r\n"
                               "\"quoted.png\" 0 0 1.01\r\n"
                               "a.b.CR2 -1 0 0",
                               &list, NULL),
                     WEFT_OK);
    assert_true(list.of_pictures && !list.positions);
    assert_int_equal(list.count, 4);
    assert_light(&list, "jpg/img 2.jpg", 0.6, 0, 0.8);
    assert_light(&list, "IMG_1.TIF", 0, -0.6, 0.8);
    assert_light(&list, "img_1.jpg", 0, -0.6, 0.8); /* the list was made of a copy */
    assert_light(&list, "quoted.png", 0, 0, 1);     /* a unit vector, nearly */
    assert_light(&list, "a.b.jpg", -1, 0, 0);
    assert_int_equal(weft_light_list_find(&list, "a.jpg"), -1);
    assert_int_equal(weft_light_list_find(&list, "mg_1.tif"), -1);
    assert_int_equal(list.row[1].line, 3);
    weft_light_list_free(&list);
}

static void two_rows_of_one_stem_are_told_by_their_ending_alone(void **state)
{
    (void)state;
    weft_light_list list;
    assert_int_equal(read_text("stem.lp", "2\na.jpg 1 0 0\na.png 0 1 0\n", &list, NULL), WEFT_OK);
    assert_light(&list, "A.PNG", 0, 1, 0);
    assert_int_equal(weft_light_list_find(&list, "a.tif"), -1);
    weft_light_list_free(&list);
}

/* Spreadsheets write commas, or semicolons where a comma is that of decimals. */
static void commas_and_semicolons_separate_too(void **state)
{
    (void)state;
    weft_light_list list;
    assert_int_equal(read_text("commas.lp", "3\na.jpg,0.6,0,0.8\n\"my stone, left.jpg\" , 0 ,-0.6, 0.8\nb.jpg;0;0; 1\n",
                               &list, NULL),
                     WEFT_OK);
    assert_int_equal(list.count, 3);
    assert_light(&list, "a.jpg", 0.6, 0, 0.8);
    assert_light(&list, "my stone, left.jpg", 0, -0.6, 0.8);
    assert_light(&list, "b.jpg", 0, 0, 1);
    weft_light_list_free(&list);
    assert_refused("decimal.lp", "1\na.jpg 0,6 0,0 0,8\n", "decimal.lp:2: expected a name and three numbers");
    assert_refused("decimal.lp", "1\na.jpg;0,6;0,0;0,8\n", "decimal.lp:2: expected a name and three numbers");
    assert_refused("decimal.lp", "2\na.jpg 1 0 0\nb.jpg,0,264,0,905,0,198\n", "decimal.lp:3: expected a name");
    assert_refused("decimal.lp", "1\nb.jpg,0,264,0,905,0,198\n", "if its commas are decimal, write points");
    assert_refused("decimal.lp", "1\nb.jpg\t0,264\t0,905\t0,198\n", "if its commas are decimal, write points");
    assert_refused("decimal.lp", "1\nb.jpg,0,5,0,7\n", "if its commas are decimal, write points");
    assert_refused("commas.lp", "1\na.jpg,1,0\n", "commas.lp:2: expected a name");
    assert_refused("commas.lp", "1\n,1,0,0\n", "commas.lp:2: no name");
}

static void a_bad_lp_file_is_refused_with_its_line(void **state)
{
    (void)state;
    assert_refused("bad.lp", "2\na.jpg 1 0 0\nb.jpg 1 0\n", "bad.lp:3: expected a name and three numbers");
    assert_refused("bad.lp", "1\na.jpg 1 0 zero\n", "bad.lp:2: expected a name");
    assert_refused("bad.lp", "1\na.jpg 1 0 nan\n", "bad.lp:2: expected a name");
    assert_refused("bad.lp", "1\n1 0 0\n", "bad.lp:2: no name");
    assert_refused("bad.lp", "2\nx/a.jpg 1 0 0\n\ny/A.JPG 0 0 1\n", "bad.lp:4: 'A.JPG' is listed already in line 2");
    assert_refused("bad.lp", "a.jpg 1 0 0\n", "bad.lp:1: an .lp file begins with the number");
    assert_refused("bad.lp", "1\na.jpg 0 0 0\n", "bad.lp:2: no direction");
    assert_refused("bad.lp", "0\n", "lists no photograph");
}

static void lights_far_from_one_are_positions(void **state)
{
    (void)state;
    weft_light_list list;
    assert_int_equal(read_text("rig.lp", "2\na.jpg 300 0 400\nb.jpg 0 0 700\n", &list, NULL), WEFT_OK);
    assert_true(list.positions);
    assert_light(&list, "a.jpg", 300, 0, 400);
    weft_light_list_free(&list);
}

static void assert_told(const char *text, const char *words)
{
    weft_light_list list;
    assert_int_equal(read_text("rig.lp", text, &list, NULL), WEFT_OK);
    assert_false(list.positions);
    assert_int_equal(list.notes.count, words ? 1 : 0);
    if (words && !strstr(list.notes.line[0], words))
        fail_msg("'%s' does not say '%s'", list.notes.line[0], words);
    for (int i = 0; i < list.count; i++)
        assert_float_equal(weft_length(list.row[i].light), 1, 1e-6);
    weft_light_list_free(&list);
}

/* Of the real lists at hand vectors are 0.94 to 1 long, and one announces a photograph less than it has. */
static void what_is_no_unit_vector_is_told(void **state)
{
    (void)state;
    assert_told("2\na.jpg 0.6 0 0.8\nb.jpg 0 0 1.04\n", NULL);
    assert_told("2\na.jpg 0.264506 0.905075 0.0\nb.jpg 0 0 1\n", "0.943 to 1 long and taken as directions");
    assert_told("2\na.jpg 3 4 12\nb.jpg 0 0 13\n", "13 to 13 long");
    assert_told("1\na.jpg 0 0 1\nb.jpg 0 1 0\n", "rig.lp:1: 1 photographs are announced, but 2 are listed");
    assert_told("3\na.jpg 0 0 1\nb.jpg 0 1 0\n", "rig.lp:1: 3 photographs are announced, but 2 are listed");
}

static void comments_and_line_ends_of_all_kinds_are_passed_over(void **state)
{
    (void)state;
    static const char *const text[] = {
        "# made by hand\n2\n% x y z\na.jpg 0 0 1 # from above\n\n// b\nb #2.jpg 0 1 0\n\n\n",
        "2\r\na.jpg 0 0 1\r\n\r\nb #2.jpg 0 1 0\r\n\r\n", "2\ra.jpg 0 0 1\rb #2.jpg 0 1 0\r"};
    for (int i = 0; i < 3; i++) {
        weft_light_list list;
        weft_error error = {0};
        if (read_text("comments.lp", text[i], &list, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        assert_int_equal(list.count, 2);
        assert_light(&list, "a.jpg", 0, 0, 1);
        assert_light(&list, "b #2.jpg", 0, 1, 0);
        assert_int_equal(list.notes.count, 0);
        weft_light_list_free(&list);
    }
}

static void a_table_holds_lamps_views_or_both(void **state)
{
    (void)state;
    weft_light_list list;
    assert_int_equal(read_text("a.csv", "file,z,y,x,uncertainty_deg\na.jpg,0.8,0.6,0,0.5\n", &list, NULL), WEFT_OK);
    assert_true(!list.of_pictures && !list.row[0].has_view);
    assert_light(&list, "a.jpg", 0, 0.6, 0.8);
    assert_float_equal(list.row[0].uncertainty_deg, 0.5, 0);
    weft_light_list_free(&list);
    assert_int_equal(read_text("b.CSV",
                               "theta_view_deg,phi_view_deg,file,theta_light_deg,phi_light_deg\n30,90,a.jpg,90,180\n",
                               &list, NULL),
                     WEFT_OK);
    assert_true(list.row[0].has_view && list.row[0].has_light);
    assert_light(&list, "a.jpg", -1, 0, 0);
    assert_float_equal(list.row[0].view.y, 0.5, 1e-9);
    weft_light_list_free(&list);
    assert_int_equal(read_text("c.csv", "file,theta_view_deg,phi_view_deg\na.jpg,30,90\n", &list, NULL), WEFT_OK);
    assert_true(list.row[0].has_view && !list.row[0].has_light);
    weft_light_list_free(&list);
    assert_refused("d.csv", "file,x,y\na.jpg,1,0\n", "'d.csv' lacks columns");
    assert_refused("d.csv", "x,y,z\n1,0,0\n", "'d.csv' lacks columns");
    assert_refused("d.csv", "file,x,y,z\na.jpg,1,0,up\n", "d.csv:2: 'up' is not a finite number");
}

int test_light_list(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_lp_file_of_another_computer_is_read),
        cmocka_unit_test(two_rows_of_one_stem_are_told_by_their_ending_alone),
        cmocka_unit_test(commas_and_semicolons_separate_too),
        cmocka_unit_test(a_bad_lp_file_is_refused_with_its_line),
        cmocka_unit_test(lights_far_from_one_are_positions),
        cmocka_unit_test(what_is_no_unit_vector_is_told),
        cmocka_unit_test(comments_and_line_ends_of_all_kinds_are_passed_over),
        cmocka_unit_test(a_table_holds_lamps_views_or_both),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

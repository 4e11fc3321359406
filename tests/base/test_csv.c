#include "base/text/csv.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char path[] = "test_csv.csv";

static weft_code read_text(const char *text, weft_csv *csv, weft_error *error)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    weft_code code = weft_csv_read(path, true, csv, error);
    unlink(path);
    return code;
}

static void assert_refused(const char *text, const char *reason)
{
    weft_csv csv;
    weft_error error;
    assert_int_equal(read_text(text, &csv, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, reason))
        fail_msg("'%s' does not say '%s'", error.message, reason);
}

static void columns_are_found_by_name_and_lines_counted(void **state)
{
    (void)state;
    weft_csv csv;
    weft_error error;
    double value;
    assert_int_equal(read_text("# a comment\n lx , ly\n\n0.5, -2e3\n", &csv, &error), WEFT_OK);
    assert_int_equal(csv.row_count, 1);
    assert_int_equal(weft_csv_column(&csv, "ly"), 1);
    assert_int_equal(weft_csv_column(&csv, "lz"), -1);
    assert_int_equal(csv.line[0], 4);
    assert_int_equal(weft_csv_number(&csv, 0, 1, &value, &error), WEFT_OK);
    assert_true(value == -2e3);
    weft_csv_free(&csv);
}

static void two_columns_of_one_name_are_refused(void **state)
{
    (void)state;
    assert_refused("lx,ly,lx\n1,2,3\n", ":1: two columns are named 'lx'");
}

static void ragged_and_empty_tables_are_refused(void **state)
{
    (void)state;
    assert_refused("a,b\n1,2\n3\n", ":3: 1 cells, but 2");
    assert_refused("\n# nothing\n", "is empty");
}

static void a_table_of_too_many_columns_is_refused(void **state)
{
    (void)state;
    char text[5001];
    memset(text, ',', 5000);
    text[5000] = 0;
    assert_refused(text, "at most 4096");
}

static void numbers_that_are_none_are_refused(void **state)
{
    (void)state;
    weft_csv csv;
    weft_error error;
    double value;
    assert_int_equal(read_text("a,b,c\nnan,1x,\n", &csv, &error), WEFT_OK);
    for (int column = 0; column < 3; column++)
        assert_int_equal(weft_csv_number(&csv, 0, column, &value, &error), WEFT_BAD_INPUT);
    weft_csv_free(&csv);
}

int test_csv(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_are_found_by_name_and_lines_counted),
        cmocka_unit_test(two_columns_of_one_name_are_refused),
        cmocka_unit_test(ragged_and_empty_tables_are_refused),
        cmocka_unit_test(a_table_of_too_many_columns_is_refused),
        cmocka_unit_test(numbers_that_are_none_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

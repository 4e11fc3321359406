#include "capture/print/dictionary_bridge.h"
#include "registration/lens/board.h"
#include "tests/support/expect_ok.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void a_board_is_read_from_its_text(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_board b;
    expect_ok(weft_board_parse("charuco:7x9:28,21:5X5_100", &b, &error), &error);
    assert_true(b.kind == WEFT_BOARD_CHARUCO && b.columns == 7 && b.rows == 9 && b.size_mm == 28 && b.second_mm == 21);
    assert_string_equal(b.dictionary, "5X5_100");
    expect_ok(weft_board_parse("charuco:7x9:28,21:DICT_4X4_50", &b, &error), &error);
    assert_string_equal(b.dictionary, "4X4_50");
    expect_ok(weft_board_parse("apriltag:5x6:30,9:DICT_APRILTAG_36h11", &b, &error), &error);
    assert_string_equal(b.dictionary, "APRILTAG_36h11");
    expect_ok(weft_board_parse("plate:48.5", &b, &error), &error);
    assert_true(b.kind == WEFT_BOARD_PLATE && b.size_mm == 48.5);
    expect_ok(weft_board_parse("apriltag:1x1:65", &b, &error), &error);
    assert_string_equal(b.dictionary, "APRILTAG_36h11");
    expect_ok(weft_board_parse("apriltag:5x6:30,9:25h9", &b, &error), &error);
}

static void a_board_that_is_none_is_refused(void **state)
{
    (void)state;
    const char *const bad[] = {"",
                               "plate",
                               "plate:0",
                               "plate:50:4X4_50",
                               "chess:9x6:25",
                               "chessboard:9x6",
                               "chessboard:2x6:25",
                               "chessboard:9x6:25,20",
                               "chessboard:9x6:nan",
                               "charuco:5x7:40",
                               "charuco:5x7:20,40",
                               "charuco:5x7:40,20:9X9_50",
                               "charuco:15x17:40,20:4X4_50",
                               "aruco:5x7:40",
                               "aruco:5x7:40,5:4X4_50:more",
                               "apriltag:1x1:-5",
                               "apriltag:1000x1000:5,5",
                               "apriltag:6x6:30,9:25h9"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        weft_board b;
        weft_error error = {0};
        if (weft_board_parse(bad[i], &b, &error) != WEFT_BAD_USAGE || !strstr(error.message, "--board"))
            fail_msg("'%s' is taken, or refused with '%s'", bad[i], error.message);
    }
}

enum { SQUARE = 60, MARKER = 42, EDGE = 80, COLUMNS = 7 };

/* From the front, a pixel a millimetre; `old`: the top left square has a marker. */
static uint8_t *draw_charuco(int rows, bool old, int *width, int *height)
{
    *width = COLUMNS * SQUARE + 2 * EDGE;
    *height = rows * SQUARE + 2 * EDGE;
    uint8_t *grey = malloc((size_t)*width * (size_t)*height), cell[7][7];
    int id = 0;
    assert_non_null(grey);
    memset(grey, 230, (size_t)*width * (size_t)*height);
    for (int square = 0; square < COLUMNS * rows; square++) {
        int column = square % COLUMNS, row = square / COLUMNS;
        bool black = (row + column) % 2 == old;
        if (!black)
            assert_int_equal(weft_board_marker(id++, cell, NULL), WEFT_OK);
        for (int y = 0; y < SQUARE; y++) {
            for (int x = 0; x < SQUARE; x++) {
                int in = (SQUARE - MARKER) / 2, u = x - in, v = y - in;
                bool ink =
                    black || (u >= 0 && v >= 0 && u < MARKER && v < MARKER && cell[v * 7 / MARKER][u * 7 / MARKER]);
                if (ink)
                    grey[(EDGE + row * SQUARE + y) * *width + EDGE + column * SQUARE + x] = 20;
            }
        }
    }
    return grey;
}

static void assert_corners_are_true(int rows, bool old)
{
    char text[64];
    int width, height, count;
    weft_board b;
    weft_error error = {0};
    uint8_t *grey = draw_charuco(rows, old, &width, &height);
    snprintf(text, sizeof text, "charuco:%dx%d:%d,%d:5X5_100", COLUMNS, rows, SQUARE, MARKER);
    expect_ok(weft_board_parse(text, &b, &error), &error);
    weft_board_point *point = calloc((size_t)weft_board_point_limit(&b), sizeof *point);
    assert_non_null(point);
    expect_ok(weft_board_find(&b, grey, width, height, point, &count, &error), &error);
    assert_int_equal(count, (COLUMNS - 1) * (rows - 1));
    for (int i = 0; i < count; i++) {
        assert_true(fabs(point[i].pixel[0] - (EDGE + point[i].board_mm[0] - 0.5)) < 0.1);
        assert_true(fabs(point[i].pixel[1] - (EDGE + point[i].board_mm[1] - 0.5)) < 0.1);
    }
    free(point);
    free(grey);
}

/* OpenCV 4.6 changed where the markers of boards with an even number of rows are. */
static void charuco_boards_of_old_and_new_layout_are_found(void **state)
{
    (void)state;
    assert_corners_are_true(9, false);
    assert_corners_are_true(10, false);
    assert_corners_are_true(10, true);
}

int test_board(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_board_is_read_from_its_text),
        cmocka_unit_test(a_board_that_is_none_is_refused),
        cmocka_unit_test(charuco_boards_of_old_and_new_layout_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

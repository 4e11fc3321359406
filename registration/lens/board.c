#include "registration/lens/board.h"

#include "btf/session/target.h"
#include "registration/pose/opencv_bridge.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_PARTS = 4, MOST_ACROSS = 100 };

static const double largest_mm = 1e5;

typedef struct kind_of_board {
    const char *name, *form;
    weft_board_kind kind;
    bool has_count, has_dictionary;
    int fewest_sizes, most_sizes, fewest_across;
    const char *dictionary;
} kind_of_board;

static const kind_of_board kinds[] = {
    {"plate", "plate:OPENING_MM", WEFT_BOARD_PLATE, false, false, 1, 1, 0, "4X4_50"},
    {"chessboard", "chessboard:COLUMNSxROWS:SQUARE_MM", WEFT_BOARD_CHESSBOARD, true, false, 1, 1, 3, ""},
    {"charuco", "charuco:COLUMNSxROWS:SQUARE_MM,MARKER_MM[:DICTIONARY]", WEFT_BOARD_CHARUCO, true, true, 2, 2, 3,
     "4X4_50"},
    {"aruco", "aruco:COLUMNSxROWS:MARKER_MM,GAP_MM[:DICTIONARY]", WEFT_BOARD_MARKERS, true, true, 1, 2, 1, "4X4_50"},
    {"apriltag", "apriltag:COLUMNSxROWS:TAG_MM,GAP_MM[:DICTIONARY]", WEFT_BOARD_MARKERS, true, true, 1, 2, 1, "36h11"},
};

static const kind_of_board *find_kind(const char *name)
{
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (strcmp(name, kinds[i].name) == 0)
            return &kinds[i];
    return NULL;
}

static bool parse_count(const char *text, int fewest, weft_board *board)
{
    int used = 0;
    return sscanf(text, "%dx%d%n", &board->columns, &board->rows, &used) == 2 && !text[used] &&
           board->columns >= fewest && board->rows >= fewest && board->columns <= MOST_ACROSS &&
           board->rows <= MOST_ACROSS;
}

static bool parse_size(const char **text, double *size_mm)
{
    char *end;
    *size_mm = strtod(*text, &end);
    bool is_size = end != *text && *size_mm >= 0 && *size_mm <= largest_mm;
    *text = end;
    return is_size;
}

static bool parse_sizes(const char *text, const kind_of_board *kind, weft_board *board)
{
    if (!parse_size(&text, &board->size_mm) || !(board->size_mm > 0))
        return false;
    if (*text == ',' && kind->most_sizes == 2) {
        text++;
        return parse_size(&text, &board->second_mm) && !*text;
    }
    return !*text && kind->fewest_sizes == 1;
}

/* OpenCV's own names begin with DICT_, and a name of AprilTag may stand without that word. */
static bool set_dictionary(const char *name, weft_board *board)
{
    if (strncasecmp(name, "DICT_", 5) == 0)
        name += 5;
    snprintf(board->dictionary, sizeof board->dictionary, "%s", name);
    if (!weft_marker_dictionary_size(board->dictionary))
        snprintf(board->dictionary, sizeof board->dictionary, "APRILTAG_%s", name);
    return weft_marker_dictionary_size(board->dictionary) > 0;
}

static int marker_count(const weft_board *b)
{
    int cells = b->columns * b->rows;
    return b->kind == WEFT_BOARD_CHARUCO ? cells / 2 : b->kind == WEFT_BOARD_MARKERS && cells > 1 ? cells : 0;
}

static weft_code check(const weft_board *b, weft_error *error)
{
    if (b->kind == WEFT_BOARD_CHARUCO && !(b->second_mm > 0 && b->second_mm < b->size_mm))
        return weft_fail(error, WEFT_BAD_USAGE, "--board %s: a marker of %g mm does not fit a square of %g mm", b->text,
                         b->second_mm, b->size_mm);
    if (b->kind == WEFT_BOARD_MARKERS && b->columns * b->rows > 1 && !(b->second_mm > 0))
        return weft_fail(error, WEFT_BAD_USAGE, "--board %s: needs the gap between markers", b->text);
    if (marker_count(b) > weft_marker_dictionary_size(b->dictionary))
        return weft_fail(error, WEFT_BAD_USAGE, "--board %s: its %d markers are more than the dictionary %s has",
                         b->text, marker_count(b), b->dictionary);
    return WEFT_OK;
}

/* Splits a copy at its colons. */
static int split(char *text, char *part[MAX_PARTS + 1])
{
    int count = 0;
    for (char *at = text; at && count <= MAX_PARTS;) {
        part[count++] = at;
        at = strchr(at, ':');
        if (at)
            *at++ = '\0';
    }
    return count;
}

weft_code weft_board_parse(const char *text, weft_board *board, weft_error *error)
{
    char copy[sizeof board->text], *part[MAX_PARTS + 1];
    *board = (weft_board){0};
    if (strlen(text) >= sizeof copy)
        return weft_fail(error, WEFT_BAD_USAGE, "--board '%s' is too long", text);
    memcpy(copy, text, strlen(text) + 1);
    memcpy(board->text, text, strlen(text) + 1);
    int count = split(copy, part);
    const kind_of_board *kind = find_kind(part[0]);
    if (!kind)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--board needs plate, chessboard, charuco, aruco or apriltag and its sizes, not '%s'", text);
    board->kind = kind->kind;
    int next = 1;
    bool is_read = (!kind->has_count || (next < count && parse_count(part[next++], kind->fewest_across, board))) &&
                   next < count && parse_sizes(part[next++], kind, board) &&
                   count - next <= (kind->has_dictionary ? 1 : 0);
    if (!is_read)
        return weft_fail(error, WEFT_BAD_USAGE, "--board needs %s, not '%s'", kind->form, text);
    const char *dictionary = next < count ? part[next] : kind->dictionary;
    if (*kind->dictionary && !set_dictionary(dictionary, board))
        return weft_fail(error, WEFT_BAD_USAGE, "--board %s: there is no dictionary '%s' of markers", text, dictionary);
    return check(board, error);
}

int weft_board_point_limit(const weft_board *b)
{
    switch (b->kind) {
    case WEFT_BOARD_PLATE:
        return 4 * WEFT_SHEET_MARKER_COUNT;
    case WEFT_BOARD_CHESSBOARD:
    case WEFT_BOARD_CHARUCO:
        return b->columns * b->rows;
    case WEFT_BOARD_MARKERS:
        break;
    }
    return 4 * b->columns * b->rows;
}

#include "compare/tradeoff/label_place.h"

#include <stdint.h>

/* Of the font of the page, rather too much. */
static const double letter_width = 7, ascent = 11, descent = 4, line_height = 15;

enum { LINES = 12 };

static bool overlap(const weft_label_box *a, const weft_label_box *b)
{
    return a->left < b->right && b->left < a->right && a->top < b->bottom && b->top < a->bottom;
}

static size_t count_below(const weft_label_box *box, const weft_label_box *other, size_t count)
{
    size_t below = 0;
    for (size_t i = 0; i < count; i++)
        below += overlap(box, &other[i]);
    return below;
}

static bool is_free(const weft_label_box *box, double width, double height, const weft_label_obstacles *obstacles)
{
    return count_below(box, obstacles->taken, obstacles->taken_count) == 0 && box->left >= 0 && box->right <= width &&
           box->top >= 0 && box->bottom <= height;
}

static weft_label_place place_at(double x, double y, double length, bool on_the_left)
{
    weft_label_place place = {.x = x, .y = y, .ends_there = on_the_left};
    place.box = (weft_label_box){on_the_left ? x - length : x, y - ascent, on_the_left ? x : x + length, y + descent};
    return place;
}

/* Below, above, then line by line further below and above. */
static double base_line(double y, double radius, int line)
{
    double away = line / 2 * line_height;
    return line % 2 == 0 ? y + radius + 10 + away : y - radius - 1 - away;
}

weft_label_place weft_label_place_choose(double x, double y, double radius, size_t letters, double width, double height,
                                         const weft_label_obstacles *obstacles)
{
    double length = letter_width * (double)letters;
    bool is_right = x > width / 2;
    size_t fewest = SIZE_MAX;
    weft_label_place best = place_at(x + (is_right ? -1 : 1) * (radius + 7), base_line(y, radius, 0), length, is_right);
    for (int i = 0; i < 2 * LINES; i++) {
        bool on_the_left = i % 2 == 0 ? is_right : !is_right;
        weft_label_place place =
            place_at(x + (on_the_left ? -1 : 1) * (radius + 7), base_line(y, radius, i / 2), length, on_the_left);
        size_t discs = count_below(&place.box, obstacles->disc, obstacles->disc_count);
        if (discs < fewest && is_free(&place.box, width, height, obstacles)) {
            fewest = discs;
            best = place;
        }
    }
    return best;
}

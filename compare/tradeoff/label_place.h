/* Where the labels of a plot stand, so that none lies on another, and on as few points as can be. */
#ifndef WEFT_COMPARE_TRADEOFF_LABEL_PLACE_H
#define WEFT_COMPARE_TRADEOFF_LABEL_PLACE_H

#include <stdbool.h>
#include <stddef.h>

/* In pixels of the plot, downwards. */
typedef struct weft_label_box {
    double left, top, right, bottom;
} weft_label_box;

typedef struct weft_label_place {
    double x, y; /* of the end of its base line that is next to its point */
    bool ends_there;
    weft_label_box box;
} weft_label_place;

/* What a label must not lie on, and what it had better not. Not owned. */
typedef struct weft_label_obstacles {
    const weft_label_box *taken, *disc;
    size_t taken_count, disc_count;
} weft_label_obstacles;

/* The place for a text of so many letters beside a disc of `radius` at (x, y), in a plot of `width`, whose axis lies at
 * `height`: below or above the disc, towards the middle of the plot or away from it, else further below or above: of
 * those that lie on nothing that is taken and within the plot the first that lies on the fewest discs; the first of all
 * where there is none. Pure. */
weft_label_place weft_label_place_choose(double x, double y, double radius, size_t letters, double width, double height,
                                         const weft_label_obstacles *obstacles);

#endif

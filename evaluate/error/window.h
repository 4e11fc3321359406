/* A dataset that is a window of another, through the heights of which it is seen. */
#ifndef WEFT_EVALUATE_ERROR_WINDOW_H
#define WEFT_EVALUATE_ERROR_WINDOW_H

#include "reflectance/relief/relief.h"

/* Where the texels of a dataset lie in a larger one. */
typedef struct weft_predicted_window {
    int x, y;                      /* the first */
    int whole_width, whole_height; /* texels */
} weft_predicted_window;

/* The taps of a view (weft_relief_taps) from texel (x, y) of the window of width x height texels, in coordinates of the
 * window. What lies beyond the middles of its outermost texels is not known: NaN. A window that is the whole repeats.
 * Thread-safe. */
void weft_window_taps(const weft_relief *relief, const weft_predicted_window *window, int width, int height, int x,
                      int y, weft_vec3 view, const int index[3], const weft_real weight[3], weft_relief_tap tap[3]);

#endif

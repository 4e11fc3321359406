#include "evaluate/error/window.h"

#include <math.h>
#include <stdbool.h>

static weft_real coordinate_in_window(weft_real whole, int first, int count, int texels)
{
    if (count == texels)
        return whole;
    weft_real place = (whole - floor(whole)) * texels - first;
    bool inside = place >= (weft_real)0.5 && place <= count - (weft_real)0.5;
    return inside ? place / count : (weft_real)NAN;
}

void weft_window_taps(const weft_relief *relief, const weft_predicted_window *window, int width, int height, int x,
                      int y, weft_vec3 view, const int index[3], const weft_real weight[3], weft_relief_tap tap[3])
{
    weft_real u = (window->x + x + (weft_real)0.5) / window->whole_width;
    weft_real v = 1 - (window->y + y + (weft_real)0.5) / window->whole_height;
    weft_relief_taps(relief, 1, u, v, view, index, weight, tap);
    for (int i = 0; i < 3; i++) {
        tap[i].u = coordinate_in_window(tap[i].u, window->x, width, window->whole_width);
        tap[i].v = 1 - coordinate_in_window(1 - tap[i].v, window->y, height, window->whole_height);
    }
}

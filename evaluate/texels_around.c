#include "evaluate/texels_around.h"

#include <math.h>

static int wrapped(int index, int count)
{
    return ((index % count) + count) % count;
}

weft_texels_around weft_texels_around_place(const weft_dataset_layout *layout, weft_real u, weft_real v)
{
    weft_texels_around found;
    double x = (u - floor(u)) * layout->width - 0.5, y = (1 - (v - floor(v))) * layout->height - 0.5;
    int left = (int)floor(x), upper = (int)floor(y);
    for (int i = 0; i < 4; i++) {
        found.weight[i] = (i & 1 ? x - left : left + 1 - x) * (i & 2 ? y - upper : upper + 1 - y);
        found.x[i] = wrapped(left + (i & 1), layout->width);
        found.y[i] = wrapped(upper + (i >> 1), layout->height);
    }
    return found;
}

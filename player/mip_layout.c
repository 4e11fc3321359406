#include "player/mip_layout.h"

static int larger(int a, int b)
{
    return a > b ? a : b;
}

weft_mip_layout weft_mip_layout_of(int width, int height, int level_count, int border)
{
    weft_mip_layout layout = {.level_count = level_count};
    int column = 0, row = 0;
    for (int level = 0; level < level_count; level++) {
        layout.area[level] = (weft_mip_area){column + border, row + border, width, height};
        layout.width = larger(layout.width, column + width + 2 * border);
        layout.height = larger(layout.height, row + height + 2 * border);
        row = level == 0 ? 0 : row + height + 2 * border;
        column = level == 0 ? width + 2 * border : column;
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return layout;
}

int weft_mip_level_count(int width, int height)
{
    int count = 1;
    for (; (width > 1 || height > 1) && count < WEFT_MIP_LEVELS; count++) {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return count;
}

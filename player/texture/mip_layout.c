#include "player/texture/mip_layout.h"

#include "base/integers.h"

static int rounded_up(int size, int block)
{
    return (size + block - 1) / block * block;
}

/* Level 1 decides how wide the part at the right of level 0 is; the smaller ones stand below it in shelves. */
weft_mip_layout weft_mip_layout_of(int width, int height, int level_count, int border, int block)
{
    weft_mip_layout layout = {.level_count = level_count};
    int x = 0, y = 0, left = 0, right = 0, below = 0;
    for (int level = 0; level < level_count; level++) {
        int across = rounded_up(width + border, block), down = rounded_up(height + border, block);
        if (level == 1)
            right = x + across;
        if (level > 1 && x + across > right) {
            x = left;
            y = below;
        }
        layout.area[level] = (weft_mip_area){x, y, width, height};
        layout.width = weft_larger(layout.width, x + across);
        layout.height = weft_larger(layout.height, y + down);
        if (level == 0)
            left = across;
        else if (x == left)
            below = y + down;
        x += across;
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

void weft_mip_layout_areas(const weft_mip_layout *layout, float area[WEFT_MIP_LEVELS][4])
{
    for (int level = 0; level < layout->level_count; level++) {
        weft_mip_area a = layout->area[level];
        area[level][0] = (float)a.x;
        area[level][1] = (float)a.y;
        area[level][2] = (float)a.width;
        area[level][3] = (float)a.height;
    }
}

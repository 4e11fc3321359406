/* How many tiles of a weave lie on a material. */
#include "reflectance/weave/weave.h"

static const double cells_across = 12;

/* How far a layout is from square cells and from `cells_across`; 0 is perfect. */
static double layout_error(const weft_weave *weave, int tiles_x, int tiles_y)
{
    double cells_x = tiles_x * weave->tile_width, cells_y = tiles_y * weave->tile_height;
    double stretch = log(cells_x / cells_y), size = log(sqrt(cells_x * cells_y) / cells_across);
    return 4 * stretch * stretch + size * size;
}

weft_weave_layout weft_weave_whole_tiles(const weft_weave *weave)
{
    weft_weave_layout layout = {0};
    double best = INFINITY;
    for (int y = 1; y <= cells_across; y++) {
        for (int x = 1; x <= cells_across; x++) {
            double candidate = layout_error(weave, x, y);
            if (candidate < best) {
                best = candidate;
                layout.tiles_u = x;
                layout.tiles_v = y;
            }
        }
    }
    return layout;
}

weft_weave_layout weft_weave_lay_out(const weft_weave *weave, double tiles_u, double tiles_v)
{
    if (tiles_u > 0 && tiles_v > 0)
        return (weft_weave_layout){.tiles_u = tiles_u, .tiles_v = tiles_v};
    return weave->layout.tiles_u > 0 ? weave->layout : weft_weave_whole_tiles(weave);
}

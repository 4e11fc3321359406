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

double weft_weave_cell_pitch_mm(const weft_weave *weave)
{
    return weave->cell_pitch_mm > 0 ? weave->cell_pitch_mm : WEFT_WEAVE_CELL_PITCH_MM;
}

static int greatest_common_divisor(int a, int b)
{
    return b == 0 ? a : greatest_common_divisor(b, a % b);
}

weft_weave_layout weft_weave_square(const weft_weave *weave)
{
    int common = greatest_common_divisor(weave->tile_width, weave->tile_height);
    return (weft_weave_layout){.tiles_u = weave->tile_height / common, .tiles_v = weave->tile_width / common};
}

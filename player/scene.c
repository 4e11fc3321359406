#include "player/scene.h"

const char *weft_mode_name(weft_mode mode)
{
    static const char *const name[WEFT_MODE_COUNT] = {"raw", "compressed", "analytic"};
    return name[mode];
}

weft_scene weft_scene_default(void)
{
    return (weft_scene){
        .orbit = {weft_rad_of_deg(-70), weft_rad_of_deg(28), 3.6},
        .light = {{{weft_rad_of_deg(45), weft_rad_of_deg(-110)}, {1, 1, 1}}},
        .light_count = 1,
        .environment_strength = 1,
        .exposure = 1,
        .repeat = 8,
        .pane_count = 1,
        .pane = {WEFT_MODE_COMPRESSED},
        .divider = 0.5,
        .lobe = {true, true, true},
        .view_table = true,
        .light_table = true,
        .table_bits = 8,
        .labels = true,
    };
}

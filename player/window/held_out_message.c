#include "player/window/held_out_message.h"

#include <stdio.h>

bool weft_draws_whole_material(const weft_scene *scene, int components, bool has_heights)
{
    if (has_heights && !scene->relief)
        return false;
    if (components > 0)
        return scene->components >= components;
    bool is_whole = scene->view_table && scene->light_table;
    for (int lobe = 0; lobe < WEFT_SCENE_MAX_LOBES; lobe++)
        is_whole = is_whole && scene->lobe[lobe];
    return is_whole;
}

void weft_held_out_message(const weft_hold_out *h, char line[WEFT_HOLD_OUT_LINE])
{
    int used = snprintf(line, WEFT_HOLD_OUT_LINE, "error %s: compressed %.1f %%", weft_hold_out_about(h),
                        100 * h->material.all.relative_rmse);
    if (h->photographs.all.count > 0)
        snprintf(line + used, WEFT_HOLD_OUT_LINE - (size_t)used, ", the photographs interpolated %.1f %%",
                 100 * h->photographs.all.relative_rmse);
}

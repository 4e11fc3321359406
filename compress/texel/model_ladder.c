#include "compress/texel/model_ladder.h"

enum { DIFFUSE_BYTES = 3 * 2, LOBE_BYTES = 3 * 4 * 2, VIEW_BYTES = 4 };

int weft_texel_model_bytes(weft_texel_model model, int view_count)
{
    return DIFFUSE_BYTES + model.lobe_count * LOBE_BYTES + (model.table ? VIEW_BYTES * view_count : 0);
}

/* Keeps the models sorted; of equal size the one that came first stays first. */
static void insert(weft_model_ladder *ladder, weft_texel_model model, int view_count)
{
    int at = ladder->count++, bytes = weft_texel_model_bytes(model, view_count);
    for (; at > 0 && weft_texel_model_bytes(ladder->model[at - 1], view_count) > bytes; at--)
        ladder->model[at] = ladder->model[at - 1];
    ladder->model[at] = model;
}

weft_model_ladder weft_model_ladder_make(const weft_fit_options *whole, int view_count)
{
    weft_model_ladder ladder = {0};
    for (int table = 0; table <= whole->table; table++) {
        for (int lobes = 0; lobes <= whole->lobe_count; lobes++)
            insert(&ladder, (weft_texel_model){lobes, table}, view_count);
    }
    return ladder;
}

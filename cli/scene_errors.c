#include "cli/scene_errors.h"

#include "study/visible_error.h"

#include <stdio.h>
#include <string.h>

static void append(char text[SCENE_ERRORS_SIZE], weft_mode mode, const weft_prediction_error *e)
{
    size_t used = strlen(text);
    snprintf(text + used, SCENE_ERRORS_SIZE - used, "%s%s %.1f %% (median %.1f, 80th percentile %.1f)",
             used > 0 ? ", " : "from raw: ", weft_mode_name(mode), 100 * e->relative_rmse, 100 * e->median_relative,
             100 * e->percentile80_relative);
}

weft_code scene_errors_print(weft_player *player, const weft_scene *scene, int width, int height,
                             char text[SCENE_ERRORS_SIZE], weft_error *error)
{
    text[0] = 0;
    int panes = weft_scene_panes(scene), pane_width = scene->layout == WEFT_LAYOUT_PANES ? width / panes : width;
    if (!weft_player_has(player, WEFT_MODE_RAW) || pane_width < 1)
        return WEFT_OK;
    for (int i = 0; i < panes; i++) {
        weft_prediction_error e;
        if (scene->pane[i] == WEFT_MODE_RAW)
            continue;
        WEFT_TRY(weft_visible_error_measure(player, scene, scene->pane[i], pane_width, height, &e, error));
        append(text, scene->pane[i], &e);
    }
    return WEFT_OK;
}

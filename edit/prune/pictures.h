/* Pictures of a scene at some moments of its path, and how far those of a pruned material are from them. Private to
 * edit/prune. */
#ifndef WEFT_EDIT_PRUNE_PICTURES_H
#define WEFT_EDIT_PRUNE_PICTURES_H

#include "edit/prune/prune.h"
#include "player/draw/player.h"

typedef struct weft_prune_pictures {
    weft_player *player;
    const weft_reach_scene *scene;
    bool whole; /* pictures as they are written; else a few frames of each */
    int count;
    double time_s[WEFT_PRUNE_MOMENTS];
    weft_image shown[WEFT_PRUNE_MOMENTS]; /* sRGB */
    uint8_t *covered[WEFT_PRUNE_MOMENTS]; /* [height][width] 1: the mesh */
} weft_prune_pictures;

/* Draws them with the material that the player has, at `count` times. The caller frees with weft_prune_pictures_free,
 * also on failure. Errors: those of drawing. */
weft_code weft_prune_pictures_draw(weft_player *player, const weft_reach_scene *scene, bool whole, const double *time_s,
                                   int count, weft_prune_pictures *pictures, weft_error *error);
void weft_prune_pictures_free(weft_prune_pictures *pictures);

/* Draws them again, with the first `components` components of what the player has now, and compares: over all of them,
 * the RMSE of the pixels of the mesh, and the mean of FLIP over these. Errors: those of drawing. */
weft_code weft_prune_pictures_compare(const weft_prune_pictures *pictures, int components, weft_prune_error *result,
                                      weft_error *error);

#endif

/* What a window says of the error of its material on what that was not fitted to. Pure. */
#ifndef WEFT_PLAYER_WINDOW_HELD_OUT_WORDS_H
#define WEFT_PLAYER_WINDOW_HELD_OUT_WORDS_H

#include "btf/material/held_out.h"
#include "player/scene/scene.h"

/* Whether a scene draws all that was measured of a material with so many components: all of them or, where there are
 * none, all lobes with their tables; through its heights where it has some. */
bool weft_draws_whole_material(const weft_scene *scene, int components, bool has_heights);

/* "error on directions that were not fitted: compressed 20.2 %, the photographs interpolated 33.6 %". */
void weft_held_out_message(const weft_hold_out *held_out, char line[WEFT_HOLD_OUT_LINE]);

#endif

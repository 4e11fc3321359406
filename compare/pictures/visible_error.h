/* How far what the player shows of a model is from what it shows of the data. */
#ifndef WEFT_COMPARE_PICTURES_VISIBLE_ERROR_H
#define WEFT_COMPARE_PICTURES_VISIBLE_ERROR_H

#include "base/numeric/error_summary.h"
#include "player/draw/player.h"

/* Whether a pixel shows the mesh with light on it. Pure. */
bool weft_surface_is_lit(const weft_surface_sample *sample);

/* Over all channels of the lit pixels of the mesh, `surface` [height][width] as weft_player_read_surface gives it.
 * Both pictures linear and of one size. Errors: WEFT_SYSTEM for memory. */
weft_code weft_visible_error_of(const weft_image *data, const weft_image *model, const weft_surface_sample *surface,
                                weft_error_summary *result, weft_error *error);

/* Draws one frame of the scene in mode raw and one in `mode`, each width x height pixels and alone, and compares them;
 * panes and labels of the scene do not matter. The player must have both. Errors: those of drawing. */
weft_code weft_visible_error_measure(weft_player *player, const weft_scene *scene, weft_mode mode, int width,
                                     int height, weft_error_summary *result, weft_error *error);

#endif

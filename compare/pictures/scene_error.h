/* How far the models in a scene are from the dataset beside them. */
#ifndef WEFT_COMPARE_PICTURES_SCENE_ERROR_H
#define WEFT_COMPARE_PICTURES_SCENE_ERROR_H

#include "base/numeric/error_summary.h"
#include "player/draw/player.h"
#include "player/settings/settings.h"

/* ---- Visible error ---- */

/* How far what the player shows of a model is from what it shows of the data. */

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

enum { WEFT_SCENE_ERROR_SIZE = 256 };

/* A line such as "from raw: compressed 4.2 % (median 3.1, 80th percentile 8.0; PSNR 33.1 dB)" with the error
 * (base/numeric/error_summary.h) of every model that is shown, over the lit pixels of the mesh; "" where the player
 * has no dataset or shows no model. width x height: of the whole picture. Errors: those of drawing. */
weft_code weft_scene_error_describe(weft_player *player, const weft_scene *scene, int width, int height,
                                    char text[WEFT_SCENE_ERROR_SIZE], weft_error *error);

/* How far the picture would be from the one lit by every light of the environment map without that: a line with the
 * relative RMSE over the pixels of the mesh, for the first mode that is shown, at a quarter of the size; "" unless the
 * scene asks for the reference. Errors: those of drawing. */
weft_code weft_environment_error_describe(weft_player *player, const weft_settings *settings,
                                          char text[WEFT_SCENE_ERROR_SIZE], weft_error *error);

#endif

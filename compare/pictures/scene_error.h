/* How far the models in a scene are from the dataset beside them. */
#ifndef WEFT_COMPARE_PICTURES_SCENE_ERROR_H
#define WEFT_COMPARE_PICTURES_SCENE_ERROR_H

#include "player/settings/settings.h"

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

/* How bright a picture is to be, and how much of it was measured. */
#ifndef WEFT_PLAYER_SETTINGS_EXPOSURE_H
#define WEFT_PLAYER_SETTINGS_EXPOSURE_H

#include "player/settings/scene_options.h"

/* Exposes the scene by a small picture of its first mode, unless the request gave an exposure or began from another
 * picture. The exposure stays 1, which shows reflectance, where it leaves the brightest 2 % of the mesh between half of
 * white and white; otherwise it brings them to 0.9. A picture that glares all over is not made darker than a mean
 * (geometric) of 0.1, and cloth before a ground, beside which it looks as dark as it is, not brighter than
 * one of 0.17. *changed: the exposure is no
 * longer 1. Needs what weft_player_draw does. Errors: those of it. */
weft_code weft_expose(const weft_scene_request *request, weft_player *player, weft_scene *scene, bool *changed,
                      weft_error *error);

/* Says in `text` (WEFT_MESSAGE_SIZE) how much of the mesh is seen or lit from directions that were not measured, by the
 * mode shown first; "" for less than 1 %, and where the mode does not say what was. Errors: as above. */
weft_code weft_describe_unmeasured(const weft_scene_request *request, weft_player *player, const weft_scene *scene,
                                   char text[WEFT_MESSAGE_SIZE], weft_error *error);

#endif

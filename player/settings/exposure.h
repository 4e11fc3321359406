/* How bright a picture is to be, and how much of it was measured. */
#ifndef WEFT_PLAYER_SETTINGS_EXPOSURE_H
#define WEFT_PLAYER_SETTINGS_EXPOSURE_H

#include "player/settings/settings.h"

/* The exposure of a picture whose pixels are as bright as value [count], which it puts into ascending order. Two
 * numbers decide: `bright`, the mean of the brightest 5 % without the brightest 1 %, which are glints, and the
 * geometric mean.
 *
 * - It is 1, which shows reflectance, where `bright` is between 0.7 and 1. Otherwise it brings `bright` to the nearer
 * of these.
 * - It makes nothing darker than a geometric mean of 0.1.
 * - It makes cloth before a ground, beside which cloth looks as dark as it is, not brighter than one of 0.17.
 *
 * It is continuous: pictures that differ by a small factor get exposures that differ by no more than that factor. So
 * the same cloth by two models is about as bright. A picture without light gets 1. Thread-safe for different arrays. */
double weft_exposure_for_picture(float *value, size_t count, bool has_ground);

/* Exposes the scene by a small picture of its first mode, unless an option gave the exposure, or the settings began
 * from another picture. *changed: the exposure is no longer 1. Needs what weft_player_draw does. Errors: those of it.
 */
weft_code weft_expose(const weft_settings *settings, weft_player *player, weft_scene *scene, bool *changed,
                      weft_error *error);

/* Says in `text` (WEFT_MESSAGE_SIZE) how much of the mesh is seen or lit from directions that were not measured, by the
 * mode shown first; "" for less than 1 %, and where the mode does not say what was. Errors: as above. */
weft_code weft_describe_unmeasured(const weft_settings *settings, weft_player *player, const weft_scene *scene,
                                   char text[WEFT_MESSAGE_SIZE], weft_error *error);

#endif

/* Where a picture begins that nobody has given a camera or a light: inside of what was measured. */
#ifndef WEFT_PLAYER_SETTINGS_FIRST_LOOK_H
#define WEFT_PLAYER_SETTINGS_FIRST_LOOK_H

#include "player/settings/settings.h"

/* Chooses what no option gave. A picture of cloth stands in the studio (player/scene/surroundings.h). The
 * default camera and light stay where its material, or else its dataset, was measured from such directions. If not, a
 * mesh that nobody named is the plane, because all sides of a drape are seen and lit from everywhere; the light, where
 * none was given, stands as in one of the photographs, and the camera as slant as in it. A plane is otherwise looked
 * down on. Tells whether there is but one view. A file that cannot be read is left to its reader to name; one that does
 * not say what was measured changes nothing. Errors: WEFT_SYSTEM for memory. */
weft_code weft_first_look(weft_settings *settings, weft_error *error);

/* Moves the camera of such a picture away until all of the mesh is in it, with a margin. */
void weft_first_fit(weft_settings *settings, const weft_mesh *mesh);

#endif

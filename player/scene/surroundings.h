/* Light to look at cloth in, computed: a studio, an overcast and a clear sky.
 *
 * Each is a map of radiance (player/scene/environment.h says how it lies) and, apart from it, the light that casts the
 * sharpest shadow: the large soft box or the sun. Skies: ISO 15469 / CIE S 011 (2003). Pure: no OpenGL. */
#ifndef WEFT_PLAYER_SCENE_SURROUNDINGS_H
#define WEFT_PLAYER_SCENE_SURROUNDINGS_H

#include "base/picture/image.h"
#include "player/scene/scene.h"

/* "studio", "overcast", "sky" and NULL. */
extern const char *const weft_surroundings_names[];

bool weft_surroundings_are(const char *name);

/* The map, 256 x 128, without the key light. The caller frees. Errors: WEFT_BAD_USAGE for another name, WEFT_SYSTEM. */
weft_code weft_surroundings_map(const char *name, weft_image *map, weft_error *error);

/* Lights `scene` by the environment of that name: its key light, if it has one, takes the place of the scene's. */
void weft_surroundings_light(const char *name, weft_scene *scene);

#endif

/* A smooth cloth in a computed environment, small, for the tests of its light. */
#ifndef WEFT_TESTS_PLAYER_STUDIO_STUDIO_H
#define WEFT_TESTS_PLAYER_STUDIO_STUDIO_H

#include "../stage.h"
#include "player/scene/environment.h"

enum { WIDTH = 240, HEIGHT = 160, PIXELS = WIDTH * HEIGHT };

/* The map of a computed environment. The caller frees it. */
weft_image studio_map(const char *name);

/* Puts a mesh of that name on the stage, with a material of one smooth texel. */
void studio_show(weft_player *player, const char *mesh_name);

/* A scene in that environment, with its key light, shadows and ground. */
weft_scene studio_scene(weft_player *player, const char *name, int regions);

/* WIDTH x HEIGHT, linear. The caller frees it. */
weft_image studio_picture(weft_player *player, const weft_scene *scene);

#endif

/* What distant lights do not see of a mesh, as depth maps. */
#ifndef WEFT_PLAYER_DRAW_SHADOW_H
#define WEFT_PLAYER_DRAW_SHADOW_H

#include "base/vector.h"
#include "player/gl/gl.h"

#include <stdbool.h>

/* Those of the key light, then those of the environment (player/draw/lighting.h). */
enum { WEFT_SHADOW_LAYERS = 12 };

typedef struct weft_shadow_map {
    GLuint buffer, depth;
    GLuint program;                         /* of cloth without holes */
    float of_world[WEFT_SHADOW_LAYERS][16]; /* column-major: to the map's texture coordinates and depth */
    weft_vec3 light[WEFT_SHADOW_LAYERS];    /* that it was drawn for; zero: none */
    float share[WEFT_SHADOW_LAYERS];        /* of its side that a layer uses: half for soft shadows */
    double texel;                           /* its side in the world, of a layer that uses all of it */
} weft_shadow_map;

/* The caller frees with weft_shadow_map_free, also on failure. Errors: WEFT_SYSTEM. */
weft_code weft_shadow_map_create(weft_shadow_map *map, weft_error *error);
void weft_shadow_map_free(weft_shadow_map *map);

/* Between the two, what is drawn casts shadows into a layer: distant light from `light` (unit) on a ball of `radius`
 * about `centre`, by `program`, which is in use then and has its clip_of_world. The framebuffer and viewport in use
 * before are the caller's to restore. False where the layer holds this light's shadows already, as finely at least, and
 * nothing is to be drawn; weft_shadow_map_forget makes it draw again. */
bool weft_shadow_map_begin(weft_shadow_map *map, int layer, bool is_soft, weft_vec3 light, weft_vec3 centre,
                           double radius, GLuint program);
void weft_shadow_map_end(void);

void weft_shadow_map_forget(weft_shadow_map *map);

/* Sets shadow_map, shadow_of_world, shadow_share and shadow_texel of player/draw/shaders/surface.glsl. */
void weft_shadow_map_bind(const weft_shadow_map *map, GLuint program, int unit);

#endif

/* Components on the GPU (shader: player/draw/shaders/factorised.glsl). */
#ifndef WEFT_PLAYER_TEXTURE_COMPONENT_TEXTURE_H
#define WEFT_PLAYER_TEXTURE_COMPONENT_TEXTURE_H

#include "btf/material/components.h"
#include "player/gl/gl.h"
#include "player/texture/mip_layout.h"

#include <stdbool.h>
#include <stddef.h>

/* All zero without components. Coefficients are signed bytes and the maps half floats, both filtered by the hardware.
 */
typedef struct weft_component_texture {
    GLuint coefficient, bounds, map;
    GLuint map_of_view, view; /* the maps of the stored views by themselves, and their directions; 0 unless they are
                                 looked through heights from */
    int view_count;
    weft_mip_layout layout, bounds_layout;
    int group_count, light_side, view_side;
    int incidence_power; /* of l . h in maps over half vectors: 1 or 2; 0: the maps are over the light */
    float least_cosine;
} weft_component_texture;

/* Uploads what `components` hold, and with `entry_of_view` [view_count] what is needed to look from their views: the
 * entry of each in the table of views (NULL: not needed). Errors: WEFT_SYSTEM where the driver's textures are too
 * small, and for memory. The caller frees with weft_component_texture_free, also on failure. */
weft_code weft_component_texture_upload(const weft_components *components, const int *entry_of_view,
                                        weft_component_texture *texture, weft_error *error);
void weft_component_texture_free(weft_component_texture *texture);

/* Of graphics memory; *shared receives what does not grow with the number of texels. */
size_t weft_component_texture_bytes(const weft_component_texture *texture, size_t *shared);

/* Sets the uniforms of factorised.glsl, from texture unit `unit` on (four of them), and on `view_unit`; `program` is in
 * use. */
void weft_component_texture_bind(const weft_component_texture *texture, GLuint program, int unit, int view_unit);

#endif

/* A compressed material on the GPU (shader: player/draw/shaders/compressed.glsl). */
#ifndef WEFT_PLAYER_TEXTURE_MATERIAL_TEXTURE_H
#define WEFT_PLAYER_TEXTURE_MATERIAL_TEXTURE_H

#include "btf/material/components.h"
#include "btf/material/material.h"
#include "btf/material/visibility.h"
#include "player/gl/gl.h"
#include "player/texture/direction_map.h"
#include "player/texture/mip_layout.h"
#include "player/texture/relief_map.h"

#include <stdbool.h>
#include <stddef.h>

/* ---- Components (shader: player/draw/shaders/factorised.glsl) ---- */

/* All zero without components. Coefficients are signed bytes and the maps half floats, both filtered by the hardware.
 */
typedef struct weft_component_texture {
    GLuint coefficient, bounds, map;
    GLuint map_of_view, view; /* the maps of the stored views by themselves, and their directions; 0 unless they are
                                 looked through heights from */
    int view_count;
    weft_mip_layout layout, bounds_layout;
    int group_count, light_side, view_side;
    bool over_half_vector, kriged; /* maps; else over the light, smooth */
    float exponent, incidence_power, cosine_power, least_incidence, least_cosine; /* btf/material/components.h */
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

/* ---- The material ---- */

/* T or S: a picture of all levels for each direction. */
typedef struct weft_table_texture {
    GLuint name;
    int count;   /* of directions; 0 without the table */
    int columns; /* directions side by side in a layer */
} weft_table_texture;

/* The maps of what a scene reaches of a pruned material (shader: player/draw/shaders/shade.frag.glsl). */
typedef struct weft_visibility_texture {
    GLuint maps; /* 0: there are none */
    int finer_levels, coarser_levels, level_count;
} weft_visibility_texture;

/* The texels are packed into words of 32 bits, four a layer: what they share with their neighbours in memory is what
 * one fetch brings. Layer 0: the rotation from the axes of the surface to those of the texel, as a unit quaternion of
 * signed 16-bit fractions (x, y; z, w), and the diffuse term and the ceiling in half floats (r, g; b, ceiling). Layer 1
 * + i: lobes 2i and 2i + 1, counted 3 lobe + channel, as half floats (Cx, Cy; Cz, N). */
typedef struct weft_material_texture {
    GLuint texel; /* 0 without lobes */
    weft_table_texture table, light_table;
    weft_direction_texture directions; /* set 0: views, set 1: lights, set 2: stored views that it is looked at from */
    weft_mip_layout layout;
    weft_component_texture components;
    weft_relief_texture relief;         /* of the components */
    weft_visibility_texture visibility; /* what it holds, where it was pruned */
    int lobe_count;
    bool opaque;
} weft_material_texture;

/* Uploads all levels as they are. Errors: WEFT_SYSTEM where the driver's textures are too small; WEFT_BAD_INPUT for
 * directions that cannot be triangulated. The caller frees with weft_material_texture_free, also on failure. */
weft_code weft_material_texture_upload(const weft_material *material, weft_material_texture *texture,
                                       weft_error *error);
void weft_material_texture_free(weft_material_texture *texture);

/* Of graphics memory, without the directions. */
size_t weft_material_texture_bytes(const weft_material_texture *texture);

/* Sets the uniforms of compressed.glsl, or if `factorised`, for which the material must have components, those of
 * factorised.glsl; `program` is in use. */
void weft_material_texture_bind(const weft_material_texture *texture, GLuint program, bool factorised);

/* Binds the maps to `unit`. */
void weft_visibility_texture_bind(const weft_visibility_texture *texture, GLuint program, int unit);

#endif

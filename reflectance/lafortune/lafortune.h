/* Lafortune lobes with a view table (Daubert, Lensch, Heidrich, Seidel 2001, eq. 1 and 2). Pure functions.
 * GLSL twin: reflectance/lafortune/lafortune.glsl. */
#ifndef WEFT_REFLECTANCE_LAFORTUNE_LAFORTUNE_H
#define WEFT_REFLECTANCE_LAFORTUNE_LAFORTUNE_H

#include "btf/direction/triangulation.h"
#include "btf/material/material.h"

/* One lobe of one colour channel: max(0, Cx l_x v_x + Cy l_y v_y + Cz l_z v_z)^N. */
typedef struct weft_lobe {
    weft_real cx, cy, cz, n;
} weft_lobe;

/* a^n without NaN or overflow: 0 for a < 0; 0 for a = 0 and n > 0; 1 for a = 0 and n = 0; n log a is capped so that the
 * result stays finite. */
weft_real weft_lobe_power(weft_real a, weft_real n);

/* rho + sum of lobes, for directions in the frame of the texel; no T and no cosine. */
weft_real weft_lafortune(weft_real rho, const weft_lobe *lobes, int lobe_count, weft_vec3 light, weft_vec3 view);

/* T for one view and channel: sum f r / sum f^2 over lights (eq. 4), accumulated in double; 1 where sum f^2 = 0. */
weft_real weft_view_table_fit(const weft_real *f, const weft_real *r, int count);

typedef struct weft_rgba {
    weft_real r, g, b, a;
} weft_rgba;

/* sum of weights times values [count]: interpolation in a table. */
weft_rgba weft_view_table_interpolate(const weft_rgba *values, const weft_barycentric *at);

/* `value`, scaled so that no channel is above `ceiling`; its hue stays. 0: there is no ceiling. */
weft_rgba weft_under_ceiling(weft_rgba value, weft_real ceiling);

/* ---- A texel of a material ---- */

/* Where the tables of a material know their values; a member is NULL without its table. */
typedef struct weft_table_directions {
    weft_triangulation *views, *lights;
} weft_table_directions;

/* Triangulates material->view and material->light. The caller frees. Errors: WEFT_BAD_INPUT for directions that cannot
 * be triangulated, WEFT_SYSTEM; then nothing is left to free. */
weft_code weft_table_directions_create(const weft_material *material, weft_table_directions *directions,
                                       weft_error *error);
void weft_table_directions_free(weft_table_directions *directions);

/* BRDF x pi (r, g, b) and opacity of texel (x, y) of a level, for light and view in the frame of the surface; 0 where
 * the view is below the horizon, black with its opacity where only the light is, and where the material has no lobes.
 * `directions` are those of the material. The reference of the player's shader. */
weft_rgba weft_material_texel(const weft_material *material, const weft_table_directions *directions, int level, int x,
                              int y, weft_vec3 light, weft_vec3 view);

/* The same at texture coordinates (u, v), repeated; bilinear between evaluated texels, trilinear between evaluated
 * levels (level >= 0 may be fractional; it is clamped to the last). */
weft_rgba weft_material_sample(const weft_material *material, const weft_table_directions *directions, weft_real level,
                               weft_real u, weft_real v, weft_vec3 light, weft_vec3 view);

#endif

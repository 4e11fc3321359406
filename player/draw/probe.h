/* What lies under one pixel of the picture drawn last, and the reflectance there over a hemisphere. */
#ifndef WEFT_PLAYER_DRAW_PROBE_H
#define WEFT_PLAYER_DRAW_PROBE_H

#include "player/draw/player.h"
#include "reflectance/lafortune/lafortune.h"

/* Directions in the axes of the surface; place: texture coordinates of the material, level. */
typedef struct weft_probe {
    bool on_mesh;
    weft_mode mode;
    weft_vec3 light, view; /* of the key light */
    double u, v, level;
    int texel_x, texel_y, texel_level; /* the one whose centre is nearest, at the nearest level; row 0 at the top */
    double radiance[3];                /* linear, as the canvas has it: with exposure */
} weft_probe;

/* Reads pixel (x, y) from the upper left corner of what weft_player_draw drew last, and its radiance from `canvas`.
 * Every pane must have been drawn with this scene and the size of the canvas. Errors: WEFT_SYSTEM. */
weft_code weft_probe_read(weft_player *player, const weft_scene *scene, const weft_canvas *canvas, int x, int y,
                          weft_probe *probe, weft_error *error);

/* Draws BRDF x pi at the probe's place and level, as the shader of its mode has it, into two discs of directions: over
 * lights for the probe's view, and over views for its light. Radius: the sine of half the angle from the normal, so
 * that areas are solid angles; +x to the right. Colours are those of the screen (the scene's exposure and tone); beside
 * the discs nothing. */
typedef struct weft_probe_plots {
    int size; /* pixels of each side */
    GLuint buffer, linear, shown, shown_buffer, program, vertex_array;
} weft_probe_plots;

/* The caller frees with weft_probe_plots_free, also on failure. Errors: WEFT_SYSTEM. */
weft_code weft_probe_plots_create(int size, weft_probe_plots *plots, weft_error *error);
void weft_probe_plots_free(weft_probe_plots *plots);

/* plots->shown, RGBA, 2 size x size texels, gets lights left and views right. Framebuffer and viewport in use are the
 * caller's to restore. Errors: WEFT_SYSTEM. */
weft_code weft_probe_plots_draw(weft_probe_plots *plots, weft_player *player, const weft_scene *scene,
                                const weft_probe *probe, weft_error *error);

/* BRDF x pi of the probe's own place, light and view, as the discs have it there but exactly, without exposure: value
 * [3]. Overwrites what was drawn into the discs. Framebuffer and viewport in use are the caller's to restore. Errors:
 * WEFT_SYSTEM. */
weft_code weft_probe_value(weft_probe_plots *plots, weft_player *player, const weft_scene *scene,
                           const weft_probe *probe, double value[3], weft_error *error);

/* ---- The model of one texel of lobes, read from the graphics card: the numbers that draw it ---- */

/* Of one lobe for one view, as luminance: f(l) = a (l . d)^N with a unit vector d, a = |C v|^N T(v). */
typedef struct weft_lobe_shape {
    weft_vec3 direction;   /* d, in the axes of the surface */
    double half_width_rad; /* from d to where the lobe has half its height: acos(2^(-1/N)) */
    double albedo;         /* of it alone for this view, under a light from everywhere: 1/pi the integral of f l_z */
} weft_lobe_shape;

/* For one view. Channels are red, green, blue. */
typedef struct weft_texel {
    int width, height; /* of its level */
    weft_frame frame;  /* in the axes of the surface */
    double diffuse[3];
    bool has_lobes; /* a diffuse term, and so many lobes; else the rest is 0 */
    int lobe_count;
    weft_lobe lobe[WEFT_MATERIAL_MAX_LOBES][3];
    weft_lobe_shape shape[WEFT_MATERIAL_MAX_LOBES];
    bool has_view_table, has_light_table;
    double view_table[3], light_table[3]; /* T of the view, S of the light; 1 without */
} weft_texel;

/* Texel (x, y) of a level, row 0 at the top; light and view in the axes of the surface. Errors: WEFT_BAD_USAGE where
 * there is no compressed material or no such texel; WEFT_SYSTEM. */
weft_code weft_texel_read(const weft_player *player, int level, int x, int y, weft_vec3 light, weft_vec3 view,
                          weft_texel *texel, weft_error *error);

/* The shape of a lobe: its exponent is that of green, its direction and height those of the mean of the channels. `n`
 * of 0 has no width: pi / 2. `frame`, `view`: in the axes of the surface; `table`: T. Pure. */
weft_lobe_shape weft_lobe_shape_of(const weft_lobe lobe[3], const weft_frame *frame, weft_vec3 view,
                                   const double table[3]);

#endif

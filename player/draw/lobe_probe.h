/* What the model of one texel of the compressed material says, read from the graphics card: the numbers that draw it.
 */
#ifndef WEFT_PLAYER_DRAW_LOBE_PROBE_H
#define WEFT_PLAYER_DRAW_LOBE_PROBE_H

#include "player/draw/player.h"
#include "reflectance/lafortune/lafortune.h"

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

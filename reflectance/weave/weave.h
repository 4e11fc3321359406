/* A weave: a tile of yarn segments (Irawan and Marschner 2012, section 4) and its file
 * (docs/reference/weave-format.md). */
#ifndef WEFT_REFLECTANCE_WEAVE_WEAVE_H
#define WEFT_REFLECTANCE_WEAVE_WEAVE_H

#include "base/status.h"
#include "base/text/block_parser.h"
#include "reflectance/woven/woven.h"

#include <stdint.h>

typedef struct weft_yarn {
    weft_segment segment;
    bool warp;                    /* else weft */
    weft_real center_u, center_v; /* tile units, may lie outside [0, 1] */
    weft_rgb kd, ks;
    bool admissible; /* false: no highlight, its diffuse term stays */
    /* Derived when the weave is read: */
    weft_prepared_segment prepared;
    int alike;                    /* index of the first yarn with the same segment and type: the same f_s */
    weft_real min_umax, max_umax; /* where the inclination noise keeps umax, rad */
    weft_real cell_fraction;      /* F: cells of the pattern with this yarn / all cells */
    weft_real area_weight;        /* aw: (warp_area + weft_area) / area of this kind of yarn; 0 where that area is 0 */
} weft_yarn;

/* How tiles lie on a material whose texture coordinates (u, v) go from 0 to 1: U = tiles_u u - corner_u, V = tiles_v v
 * - corner_v. At (corner_u, corner_v), in tiles from the lower left corner of the material, one tile begins. */
typedef struct weft_weave_layout {
    double tiles_u, tiles_v;
    double corner_u, corner_v;
} weft_weave_layout;

typedef struct weft_weave {
    char name[128];
    int tile_width, tile_height; /* cells */
    weft_real warp_area, weft_area;
    /* dWarpUmaxOverDWarp, dWarpUmaxOverDWeft, dWeftUmaxOverDWarp, dWeftUmaxOverDWeft */
    weft_real inclination_noise_deg[4];
    weft_real fineness;       /* intensity noise: fineness x fineness rectangles per segment; 0 = off */
    weft_real period;         /* of the inclination noise, cells; 0 = off */
    double cell_pitch_mm;     /* side of a cell; 0: its file does not say (weft_weave_cell_pitch_mm) */
    int *pattern;             /* [tile_height][tile_width] 0-based index into yarn; first row = top of the tile */
    weft_weave_layout layout; /* on the material that it was fitted to; 0 tiles: its file does not say */
    int yarn_count;
    weft_yarn *yarn;
    weft_real specular_scale; /* s: makes the bihemispherical reflectance of the specular part 1 for ks = 1 */
} weft_weave;

/* Reads a weave file and computes specular_scale. `parameters` [parameter_count] fill in `$name`s. `warning` (may be
 * NULL) receives one line, empty if all is well, that names segments the model does not have. The caller frees with
 * weft_weave_free. Errors: WEFT_BAD_INPUT "FILE:LINE:COLUMN: what is wrong". */
weft_code weft_weave_read(const char *path, const weft_parameter *parameters, int parameter_count, weft_weave *weave,
                          char warning[WEFT_MESSAGE_SIZE], weft_error *error);
/* The same from text in memory; `path` only names it in messages. */
weft_code weft_weave_parse(const char *text, const char *path, const weft_parameter *parameters, int parameter_count,
                           weft_weave *weave, char warning[WEFT_MESSAGE_SIZE], weft_error *error);
void weft_weave_free(weft_weave *weave);

/* Derives again what follows from the segments, colours and areas of the yarns, after they have been changed. */
void weft_weave_update(weft_weave *weave);
/* The same but for the specular scale, which takes long and stays as it was. */
void weft_weave_update_yarns(weft_weave *weave);

/* A weave of its own, freed with weft_weave_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_weave_copy(const weft_weave *from, weft_weave *to, weft_error *error);

/* Writes a weave as a file that weft_weave_read reads back to the same numbers; `comment` (may be NULL; without the end
 * of a comment in it) comes first. Atomic. Errors: WEFT_SYSTEM. */
weft_code weft_weave_write(const char *path, const weft_weave *weave, const char *comment, weft_error *error);

/* The constant s (0 where no segment is admissible) by a deterministic quadrature: the same value for any number of
 * threads. Part of weft_weave_read. */
weft_real weft_weave_specular_scale(const weft_weave *weave);

/* Whole tiles for a square material: about twelve square cells across. Pure. */
weft_weave_layout weft_weave_whole_tiles(const weft_weave *weave);

/* How a weave lies on a material: tiles_u x tiles_v from the lower left corner where these are above 0, else as its
 * file says, else in whole tiles. Pure. */
weft_weave_layout weft_weave_lay_out(const weft_weave *weave, double tiles_u, double tiles_v);

/* Side of a cell as the file states it, else WEFT_WEAVE_CELL_PITCH_MM: 40 threads a centimetre where yarns are one cell
 * wide, a cloth for shirts. Pure. */
#define WEFT_WEAVE_CELL_PITCH_MM 0.25
double weft_weave_cell_pitch_mm(const weft_weave *weave);

/* The smallest square of whole tiles, for cloth that lies on no material: its cells are square. Pure. */
weft_weave_layout weft_weave_square(const weft_weave *weave);

/* Where a point of the cloth lies: U along x, V along y, tile units, any sign. */
typedef struct weft_weave_point {
    int yarn;                  /* index */
    weft_real x, y;            /* in the frame of the segment, cells */
    weft_real umax_offset_rad; /* noise: added to umax of the segment, which stays admissible */
    weft_real intensity;       /* noise: multiplies the highlight */
} weft_weave_point;

/* Without noise: offset 0, intensity 1. `seed` 0 = no noise. Pure; the noise belongs to the segments of the endless
 * cloth, so it does not repeat with the tile. */
weft_weave_point weft_weave_locate(const weft_weave *weave, weft_real U, weft_real V, uint64_t seed);

/* Equally likely values that stand for the umax_offset_rad of all segments of a yarn, ascending: the means of as many
 * classes of 512 segments far apart. All 0 without inclination noise, or where there is no such segment. Pure. */
enum { WEFT_WEAVE_OFFSETS = 8 };
void weft_weave_umax_offsets(const weft_weave *weave, int yarn, weft_real offset_rad[WEFT_WEAVE_OFFSETS]);

/* intensity aw T(x, y) at a located point: the specular texture without s and ks. `light`, `view` in the frame of the
 * cloth. */
weft_real weft_weave_specular(const weft_weave *weave, const weft_weave_point *point, weft_vec3 light, weft_vec3 view);

/* kd/pi + ks s times a specular value of that yarn: the BRDF, 1/sr, where both directions are above the horizon. */
weft_rgb weft_weave_shade(const weft_weave *weave, const weft_yarn *yarn, weft_real specular);

/* BRDF in 1/sr: kd/pi + ks s aw T; 0 where either direction is below the horizon. */
weft_rgb weft_weave_brdf(const weft_weave *weave, const weft_weave_point *point, weft_vec3 light, weft_vec3 view);

/* Mean over the tile, without noise: sum_k F_k (kd/pi + ks s aw f_s). */
weft_rgb weft_weave_mean_brdf(const weft_weave *weave, weft_vec3 light, weft_vec3 view);
/* Its specular part sum_k F_k aw f_s (without s and ks). */
weft_real weft_weave_mean_specular(const weft_weave *weave, weft_vec3 light, weft_vec3 view);

#endif

/* A stitch: one tile of cloth as yarns in space, and its file (docs/reference/stitch-format.md). Lengths are in mm;
 * frame as in base/vector.h with the origin at the lower left corner of the tile. */
#ifndef WEFT_GEOMETRY_STITCH_STITCH_H
#define WEFT_GEOMETRY_STITCH_STITCH_H

#include "base/status.h"
#include "base/vector.h"

enum {
    WEFT_STITCH_MAX_POINTS = 4096, /* of all yarns together */
    WEFT_STITCH_MAX_YARNS = 256,
    WEFT_STITCH_MAX_COPIES = 1024, /* of all yarns together */
    WEFT_STITCH_MAX_PLIES = 12
};

/* How the surface of a yarn reflects (geometry/yarn/fibre.h). */
typedef struct weft_fibre {
    weft_rgb diffuse;        /* albedo */
    weft_rgb specular;       /* multiplies the highlight; diffuse + specular <= 1 */
    weft_real highlight_rad; /* gamma: width of the highlight along the fibre */
    weft_real refractive_index;
} weft_fibre;

/* Where something stands in the file, from 1. */
typedef struct weft_text_place {
    int line, column;
} weft_text_place;

/* One yarn along a spline through its points, and its displaced copies. */
typedef struct weft_stitch_yarn {
    int point_count;
    weft_vec3 *point;       /* [point_count]; the last is the first, whole tiles further on, where the yarn repeats */
    weft_text_place *place; /* [point_count] */
    int copy_count;
    weft_vec3 *copy;      /* [copy_count] displacements; the yarn itself is there only if {0, 0, 0} is one of them */
    int tiles_x, tiles_y; /* from the first point to the last */
    weft_real radius_side, radius_up; /* semi-axes of the cross-section, in the plane of the cloth and out of it */
    int plies;
    weft_real twist, fibre_twist; /* turns per mm: of the plies round the yarn, of the fibres round their ply */
    weft_fibre fibre;
} weft_stitch_yarn;

typedef struct weft_stitch {
    char name[128];
    weft_real width, height; /* of the tile */
    int resolution;          /* cells of the grid across the width */
    weft_real blend;         /* how far two places of one yarn flow together where they touch; 0 = not at all */
    int yarn_count;
    weft_stitch_yarn *yarn;
} weft_stitch;

/* Reads a stitch and checks that its yarns repeat with the tile, are thick enough for the grid and neither bend
 * tighter than their radius nor run through each other. The caller frees with weft_stitch_free. Errors: WEFT_BAD_INPUT
 * "FILE:LINE:COLUMN: what is wrong". */
weft_code weft_stitch_read(const char *path, weft_stitch *stitch, weft_error *error);

/* The same from text in memory; `path` only names it in messages. */
weft_code weft_stitch_parse(const char *text, const char *path, weft_stitch *stitch, weft_error *error);
void weft_stitch_free(weft_stitch *stitch);

#endif

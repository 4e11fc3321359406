/* Which segments of yarn pass near a place: a periodic grid of buckets. Private to this folder. */
#ifndef WEFT_GEOMETRY_STITCH_SEGMENT_GRID_H
#define WEFT_GEOMETRY_STITCH_SEGMENT_GRID_H

#include "geometry/stitch/stitch.h"

#include <stddef.h>

/* ---- Skeletons ---- */

typedef struct weft_yarn_station {
    weft_vec3 at, tangent, side, up;
    weft_real arclength; /* from the first station of the strand, mm */
    int point;           /* control point at or before it */
} weft_yarn_station;

/* One copy of a yarn. Its last station is the first of its next repeat. */
typedef struct weft_yarn_strand {
    int yarn, first_station, station_count;
    weft_real turns_per_mm; /* twist, rounded so that the plies repeat with the tile */
} weft_yarn_strand;

typedef struct weft_yarn_skeleton {
    const weft_stitch *stitch; /* not owned */
    int station_count, strand_count;
    weft_yarn_station *station;
    weft_yarn_strand *strand;
} weft_yarn_skeleton;

/* Places stations no further apart than a sixth of the smaller radius. The caller frees with weft_yarn_skeleton_free.
 * Errors: WEFT_BAD_INPUT for more yarn than a tile can hold, or yarn that stands upright, where side is undefined;
 * they name `path` and the control point. WEFT_SYSTEM. */
weft_code weft_yarn_skeleton_create(const weft_stitch *stitch, const char *path, weft_yarn_skeleton *skeleton,
                                    weft_error *error);
void weft_yarn_skeleton_free(weft_yarn_skeleton *skeleton);

/* The failure "PATH:LINE:COLUMN: message" at a control point of a yarn. */
weft_code weft_stitch_fail_at(const weft_stitch *stitch, const char *path, int yarn, int point, weft_error *error,
                              const char *format, ...) __attribute__((format(printf, 6, 7)));

/* A segment, from a station to the next of its strand, shifted by whole tiles. */
typedef struct weft_near_segment {
    int strand, station;
    int tiles_x, tiles_y;
} weft_near_segment;

typedef struct weft_segment_grid {
    const weft_yarn_skeleton *skeleton; /* not owned */
    weft_real bottom, top;              /* beyond these no yarn is near */
    int count[3];                       /* buckets */
    weft_vec3 bucket;                   /* size of one */
    size_t *start;                      /* [count product + 1] */
    weft_near_segment *segment;         /* [start of the end], in the order of strands and stations */
} weft_segment_grid;

/* Lists every segment in all buckets within `margin` of its yarn's larger radius. The caller frees with
 * weft_segment_grid_free. Errors: WEFT_BAD_INPUT where the lists would be too long, naming `path`; WEFT_SYSTEM. */
weft_code weft_segment_grid_create(const weft_yarn_skeleton *skeleton, weft_real margin, const char *path,
                                   weft_segment_grid *grid, weft_error *error);
void weft_segment_grid_free(weft_segment_grid *grid);

/* The place in the tile, x in [0, width) and y in [0, height). Pure. */
weft_vec3 weft_place_in_tile(const weft_stitch *stitch, weft_vec3 place);

/* The segments near a place in the tile: *count of them. Pure. */
const weft_near_segment *weft_segments_near(const weft_segment_grid *grid, weft_vec3 place_in_tile, size_t *count);

/* A station in the tile of a segment. Pure. */
static inline weft_vec3 station_place(const weft_segment_grid *grid, const weft_near_segment *segment, int station)
{
    const weft_stitch *stitch = grid->skeleton->stitch;
    weft_vec3 at = grid->skeleton->station[station].at;
    return weft_vec3_of(at.x + segment->tiles_x * stitch->width, at.y + segment->tiles_y * stitch->height, at.z);
}

/* ---- Check ---- */

/* Whether the yarns are solids: none bends tighter than its radius, stands upright or runs through another. */
weft_code weft_stitch_check(const weft_stitch *stitch, const char *path, weft_error *error);

#endif

/* The skeletons of a stitch: every yarn as stations along its spline, with the frame of the cross-section at each.
 *
 * The spline is the centripetal Catmull-Rom curve through the control points (Barry and Goldman 1988; Yuksel, Schaefer
 * and Keyser 2011), as cubic Bezier pieces; it goes on periodically beyond both ends. The cross-section is oriented by
 * the normal of the cloth: side = unit(z x tangent), up = tangent x side. Private to the room. */
#ifndef WEFT_GEOMETRY_STITCH_SKELETON_H
#define WEFT_GEOMETRY_STITCH_SKELETON_H

#include "geometry/stitch/stitch.h"

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

#endif

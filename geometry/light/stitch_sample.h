/* A stitch as a sample under a camera and a lamp: endless cloth below the plane z = 0, which its highest places touch,
 * with the lower left corner of a tile at the origin. */
#ifndef WEFT_GEOMETRY_LIGHT_STITCH_SAMPLE_H
#define WEFT_GEOMETRY_LIGHT_STITCH_SAMPLE_H

#include "geometry/stitch/stitch.h"

#include <stdint.h>

enum { WEFT_STITCH_SAMPLE_MAX_BOUNCES = 15 };

typedef struct weft_stitch_sample weft_stitch_sample;

/* Reads a stitch file and makes its surface. Light is followed over `bounces`, at most
 * WEFT_STITCH_SAMPLE_MAX_BOUNCES. The caller frees. Errors: those of weft_stitch_read and weft_tile_mesh_create. */
weft_code weft_stitch_sample_read(const char *path, int bounces, weft_stitch_sample **result, weft_error *error);
void weft_stitch_sample_free(weft_stitch_sample *sample);

/* Owned by the sample. */
const weft_stitch *weft_stitch_sample_stitch(const weft_stitch_sample *sample);

/* How many bounces its paths have at most. Pure. */
int weft_stitch_sample_bounces(const weft_stitch_sample *sample);

/* A vertex of a path of light from the camera: what is kept of it until the lamp is known. */
typedef struct weft_seen_vertex {
    float at[3]; /* in the tile, mm; z below the plane */
    float normal[3], tangent[3];
    float view[3];       /* toward the vertex before, or the camera */
    float throughput[3]; /* of the path up to here */
    int32_t yarn;
} weft_seen_vertex;

/* Follows path `index` of the sequence `key` along the view ray through (x_mm, y_mm, 0), `view` pointing to the camera.
 * Writes its vertices, at most 1 + bounces, and returns their number: 0 where the ray meets no cloth. Thread-safe; the
 * same arguments give the same numbers. */
int weft_stitch_sample_see(const weft_stitch_sample *sample, weft_real x_mm, weft_real y_mm, weft_vec3 view,
                           uint64_t key, uint32_t index, weft_seen_vertex *vertex);

/* Radiance along a path under a far light toward `light`, whose irradiance across its direction is pi: an estimate of
 * BRDF x pi x cosine, shadows and bounces included. Thread-safe. */
weft_rgb weft_stitch_sample_light(const weft_stitch_sample *sample, const weft_seen_vertex *vertex, int count,
                                  weft_vec3 light);

#endif

/* The acquisition of a dataset from a stitch (Daubert et al. 2001, section 4): points on a plane, that of the paper the
 * top face of the tile's bounding box, projected along each view, and what the cloth there sends back under each light.
 */
#ifndef WEFT_GEOMETRY_ACQUISITION_ACQUISITION_H
#define WEFT_GEOMETRY_ACQUISITION_ACQUISITION_H

#include "base/progress.h"
#include "geometry/yarn/tile_mesh.h"

#include <stdint.h>

typedef struct weft_acquisition_options {
    int width, height; /* texels; the tile is cut into so many */
    int bounces;
    double noise; /* aim for the standard error of a view's samples, RMS, relative to the RMS of the samples: 0.01 */
    uint64_t seed;
    double plane_mm; /* height of the plane of the texels above the top face: 0 or less */
} weft_acquisition_options;

typedef struct weft_acquisition_report {
    double noise;           /* reached: the largest of all views, estimated from independent batches of paths */
    double paths_per_texel; /* mean over texels and views */
    double covered;         /* mean opacity */
} weft_acquisition_report;

/* The directions of views and lights when none are given: 64, evenly spread (a Fibonacci spiral) over the part of the
 * hemisphere within 80 degrees of the normal. */
enum { WEFT_ACQUISITION_DIRECTIONS = 64 };
weft_vec3 weft_acquisition_direction(int index);

/* The mean height of what is seen of the cloth straight from above, in mm above the top face, of a grid of places
 * across the tile; 0 where nothing is seen. Errors: WEFT_SYSTEM. */
weft_code weft_acquisition_mean_height(const weft_stitch *stitch, const weft_tile_mesh *mesh, double *height_mm,
                                       weft_error *error);

/* Simulates all pairs of `direction` [direction_count] as view and light, all of them above the horizon, and writes the
 * dataset `path` with opacity: image view x direction_count + light. A sample is reflectance times cosine of the whole
 * texel, holes included as black. The frame of a texel is the average over all views of what they see of its cloth:
 * normal of the surface, direction of the fibres. Work is shared: one path serves all lights, and texels get as many
 * paths as their variance needs. The same for any number of threads. Errors: WEFT_BAD_USAGE for directions, a size
 * or a plane that make no sense; WEFT_SYSTEM; those of the dataset writer. */
weft_code weft_acquire(const weft_stitch *stitch, const weft_tile_mesh *mesh, const weft_vec3 *direction,
                       int direction_count, const weft_acquisition_options *options, const char *path,
                       const weft_progress *progress, weft_acquisition_report *report, weft_error *error);

#endif

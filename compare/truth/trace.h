/* Pictures of draped cloth from geometry, traced through the player's camera. */
#ifndef WEFT_COMPARE_TRUTH_TRACE_H
#define WEFT_COMPARE_TRUTH_TRACE_H

#include "base/picture/image.h"
#include "base/progress.h"
#include "geometry/drape/draped_cloth.h"
#include "player/mesh/mesh.h"
#include "player/scene/scene.h"

/* A mesh as a surface for cloth of which `repeat` tiles, each tile_width mm wide, lie along one unit of its texture
 * coordinate u; its unit of length, which is that of its coordinates, becomes repeat x tile_width mm. */
typedef struct weft_truth_base {
    weft_base_surface surface;
    weft_base_vertex *vertex; /* [surface.vertex_count] */
    double mm_per_unit;
} weft_truth_base;

/* The triangles stay those of `mesh`. The caller frees with weft_truth_base_free. Errors: WEFT_SYSTEM. */
weft_code weft_truth_base_create(const weft_mesh *mesh, double repeat, double tile_width_mm, weft_truth_base *base,
                                 weft_error *error);
void weft_truth_base_free(weft_truth_base *base);

typedef struct weft_trace_options {
    int width, height, paths; /* of a pixel, rounded up to whole batches */
    int bounces;
    double reach_mm; /* of the picture `near` */
    uint64_t seed;
} weft_trace_options;

/* Linear pictures, see weft_draped_radiance. */
typedef struct weft_traced {
    weft_image all, near;
    double noise; /* standard error of the pixels that show cloth, RMS, relative to their RMS; of `all` */
} weft_traced;

/* What the camera and the first light of `scene` make of the cloth, the mean over square pixels as the player's is;
 * open places show `background`, of the size asked for. `mesh` is what the cloth was laid over. The same for any number
 * of threads. The caller frees with weft_traced_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_trace(const weft_draped_cloth *cloth, const weft_mesh *mesh, double mm_per_unit, const weft_scene *scene,
                     const weft_trace_options *options, const weft_image *background, const weft_progress *progress,
                     weft_traced *traced, weft_error *error);
void weft_traced_free(weft_traced *traced);

#endif

/* What of a material the pictures of a scene can ever visibility, found with bounds: for every triangle and every span
 * of the camera's path, small enough, a cap that holds all directions to the eye, one for each light, and the least and
 * largest footprint of a pixel. Nothing is sampled, so that nothing between two samples is missed. What the mesh hides,
 * and shadows, take nothing away: that keeps more than is needed, never less. */
#ifndef WEFT_EDIT_PRUNE_VISIBILITY_H
#define WEFT_EDIT_PRUNE_VISIBILITY_H

#include "base/progress.h"
#include "btf/material/material.h"
#include "player/mesh/mesh.h"
#include "player/settings/key_frames.h"

enum {
    WEFT_VISIBILITY_SIDE = 64,      /* cells along a side of the maps of views and of lights */
    WEFT_VISIBILITY_PAIR_SIDE = 32, /* of those of views and lights together */
    WEFT_VISIBILITY_PAIR_CELLS = WEFT_VISIBILITY_PAIR_SIDE * WEFT_VISIBILITY_PAIR_SIDE
};

/* A scene as it is drawn: weft_scene_load has set its `repeat`. */
typedef struct weft_prune_scene {
    const weft_mesh *mesh;
    const weft_path *path; /* NULL: the scene stands still */
    weft_scene scene;
    int width, height, samples; /* of a picture */
} weft_prune_scene;

typedef struct weft_visibility {
    int level_count;
    int width[WEFT_MATERIAL_MAX_LEVELS], height[WEFT_MATERIAL_MAX_LEVELS];
    uint8_t *texel[WEFT_MATERIAL_MAX_LEVELS];   /* [height][width] 1: a pixel may read it */
    long texel_count[WEFT_MATERIAL_MAX_LEVELS]; /* how many are 1 */
    /* Cells of the square of directions (btf/direction/square_map.h), in the axes of the surface; 1: reached */
    uint8_t view[WEFT_VISIBILITY_SIDE * WEFT_VISIBILITY_SIDE], light[WEFT_VISIBILITY_SIDE * WEFT_VISIBILITY_SIDE];
    uint8_t *pair;                /* [view cell][light cell] of the coarser maps */
    double product[3][3][2];      /* least and largest light[i] view[j] */
    double level_low, level_high; /* of any pixel */
    long span_count;              /* spans that the path was cut into */
} weft_visibility;

/* The caller frees with weft_visibility_free. Errors: WEFT_BAD_INPUT where nothing of the mesh can be seen, or it has
 * no texture coordinates that differ; WEFT_SYSTEM. */
weft_code weft_visibility_find(const weft_prune_scene *scene, const weft_material *material,
                               const weft_progress *progress, weft_visibility *visibility, weft_error *error);
void weft_visibility_free(weft_visibility *visibility);

#endif

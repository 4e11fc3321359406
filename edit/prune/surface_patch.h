/* A part of a triangle of a mesh as one camera span sees it: bounds of what a pixel on it has. Private to edit/prune.
 */
#ifndef WEFT_EDIT_PRUNE_SURFACE_PATCH_H
#define WEFT_EDIT_PRUNE_SURFACE_PATCH_H

#include "edit/prune/camera_span.h"

#include <stdbool.h>

/* Attributes of a vertex, or of a point between three: all are linear there. */
typedef struct weft_patch_corner {
    weft_vec3 position, normal, tangent;
    double handedness;
    double u, v; /* texture coordinates of the material, repeated */
} weft_patch_corner;

typedef struct weft_patch {
    weft_patch_corner corner[3];
    /* The plane, which halves have in common */
    weft_vec3 normal;                      /* unit, toward the side that the triangle runs counter-clockwise on */
    double least_stretch, largest_stretch; /* texels for a unit of length on it, by direction */
} weft_patch;

/* Sets the plane. False where the triangle has next to no area. */
bool weft_patch_set_plane(weft_patch *patch, double texels_u, double texels_v);

/* The quarter `part` of 0..3. Pure. */
weft_patch weft_patch_quarter(const weft_patch *patch, int part);

/* What a span sees of a patch. */
typedef struct weft_patch_bounds {
    bool visible;                 /* some of it may be in the picture */
    bool front, back;             /* seen from that side */
    bool is_large, is_bent;       /* seen from the eye, or in its axes: quarters would say more */
    double level_low, level_high; /* log2 of the footprint of a pixel, in texels */
    weft_direction_cap view;      /* in the axes of its front */
    weft_direction_cap light[WEFT_SCENE_MAX_LIGHTS];
} weft_patch_bounds;

/* Pure. */
weft_patch_bounds weft_patch_bounds_of(const weft_patch *patch, const weft_camera_span *span);

/* The same direction in the axes of the back: mirrored, as a player does it. Pure. */
weft_direction_cap weft_cap_behind(const weft_direction_cap *cap);

#endif

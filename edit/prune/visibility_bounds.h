/* Bounds of what a span of the camera's path sees of a triangle, and the marks that they leave. Private to edit/prune.
 */
#ifndef WEFT_EDIT_PRUNE_VISIBILITY_BOUNDS_H
#define WEFT_EDIT_PRUNE_VISIBILITY_BOUNDS_H

#include "base/vector.h"
#include "edit/prune/visibility.h"
#include "player/scene/scene.h"

#include <stdbool.h>

/* ---- Camera span ---- */

/* Camera and lights of a scene between two moments of its path, with bounds: all that lies between two scenes whose
 * values are the least and the largest there (weft_path_span). */

/* All unit vectors within an angle of an axis. */
typedef struct weft_direction_cap {
    weft_vec3 axis;
    double angle_rad;
} weft_direction_cap;

typedef struct weft_camera_span {
    weft_vec3 eye;                  /* in the middle of the span */
    double eye_shift;               /* the eye is never further from there */
    weft_orbit_axes axes;           /* of the picture, unit, in the middle of the span */
    double turn_rad;                /* they are never turned further than that */
    double half_width, half_height; /* of the picture at unit distance */
    double pixel;                   /* side of a pixel there */
    double nearest;                 /* what is nearer along the view is not drawn */
    int light_count;                /* lights that are not black */
    weft_direction_cap light[WEFT_SCENE_MAX_LIGHTS];
} weft_camera_span;

/* `low` and `high` bound the scene; centre and radius are those of the mesh. Pure. */
weft_camera_span weft_camera_span_of(const weft_scene *low, const weft_scene *high, weft_vec3 centre, double radius,
                                     int width, int height);

/* How far, in radians or shares of the distance, anything moves within the span: what spans are halved by. Under an
 * environment lights do not count, as there is light from everywhere. Pure. */
double weft_camera_span_width(const weft_scene *low, const weft_scene *high);

/* ---- Surface patch ---- */

/* A part of a triangle of a mesh as one camera span sees it: bounds of what a pixel on it has. Private to edit/prune.
 */

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

/* ---- Reach marks ---- */

/* What a visibility takes note of. Private to edit/prune. */

/* All texels that a pixel between the levels may read whose texture coordinates lie in a box; a border around it, in
 * materials, is read, too. */
typedef struct weft_visibility_box {
    double low[2], high[2];
    double border[2];
} weft_visibility_box;
void weft_visibility_mark_texels(weft_visibility *visibility, const weft_visibility_box *box, int first_level,
                                 int last_level);

/* A cap of views and one of lights, seen together, in the axes of the surface. What of the lights lies below the
 * horizon is left out; views are held above it as a player holds them. */
void weft_visibility_mark_pair(weft_visibility *visibility, const weft_direction_cap *view,
                               const weft_direction_cap *light);

/* A cap of views whose lights do not matter; and then light from everywhere for all views. */
void weft_visibility_mark_view(weft_visibility *visibility, const weft_direction_cap *view);
void weft_visibility_light_all(weft_visibility *visibility);

#endif

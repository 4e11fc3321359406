/* A material seen through its heights (reflectance/relief/relief.h): its stored views, which are those of its
 * components, and what each of them sees of the surface. */
#ifndef WEFT_REFLECTANCE_RELIEF_MATERIAL_RELIEF_H
#define WEFT_REFLECTANCE_RELIEF_MATERIAL_RELIEF_H

#include "btf/direction/triangulation.h"
#include "btf/material/material.h"
#include "reflectance/relief/relief.h"

/* Freed with weft_material_relief_free. Immutable, so that any number of threads may look through it. */
typedef struct weft_material_relief {
    weft_relief relief; /* of no view where the material is not seen through heights */
    float *height_mm;   /* its values */
    weft_vec3 *view;    /* [relief.view_count] the stored views */
    weft_triangulation *views;
    int level_count; /* the finest levels that are seen so */
} weft_material_relief;

/* What `material` is to be seen through; nothing where it has no heights or no components. The material is not kept.
 * Errors: WEFT_BAD_INPUT for views that cannot be triangulated, WEFT_SYSTEM. */
weft_code weft_material_relief_create(const weft_material *material, weft_material_relief *result, weft_error *error);
void weft_material_relief_free(weft_material_relief *relief);

/* How much of a value at `level` is seen through the heights, 0 .. 1: all on the finest levels, none on the coarse
 * ones. Pure. */
weft_real weft_material_relief_share(const weft_material_relief *relief, weft_real level);

/* The stored views around `view`, index [3] (-1: none), and where each saw the point that lies at (u, v) in it.
 * Thread-safe. */
void weft_material_relief_taps(const weft_material_relief *relief, weft_real u, weft_real v, weft_vec3 view,
                               int index[3], weft_relief_tap tap[3]);

#endif

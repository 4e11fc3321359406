/* Photographs of a surface with depth, seen through its heights: where a ray meets the surface, and what each stored
 * view knows of that place. GLSL twin: reflectance/relief/relief.glsl.
 *
 * A point at height h above texture coordinates p is seen by a view of direction v at the texture coordinates
 *
 *     q = p - h s(v),    s(v) = (v.x / v.z / width, v.y / v.z / height)
 *
 * of the plane that the texels lie on (relief mapping: Policarpo, Oliveira and Comba 2005). So the values of a view are
 * read at q, and the neighbouring views of a direction are blended where they see the same point. */
#ifndef WEFT_REFLECTANCE_RELIEF_RELIEF_H
#define WEFT_REFLECTANCE_RELIEF_RELIEF_H

#include "base/status.h"
#include "base/vector.h"

#include <stdint.h>

enum { WEFT_RELIEF_STEPS = 16, WEFT_RELIEF_BISECTIONS = 3 };

/* Steeper slopes than those of a view at this cosine are not followed: beyond, heights are mostly hidden. */
#define WEFT_RELIEF_LEAST_COSINE 0.2

/* Heights of a material that repeats. Row 0 is the top row (v near 1). */
typedef struct weft_height_field {
    int width, height;          /* places; 1 x 1 is a plane */
    const float *value;         /* [height][width] mm above the plane of the texels; not owned */
    float low, high;            /* the least and the greatest of them */
    double width_mm, height_mm; /* of the material */
} weft_height_field;

/* Finds low and high. Pure. */
weft_height_field weft_height_field_of(const float *value, int width, int height, double width_mm, double height_mm);

/* Bilinear, repeated. Pure. */
weft_real weft_height_at(const weft_height_field *field, weft_real u, weft_real v);

/* Texture coordinates that the sight line of a view moves for a mm of height: s(v). Pure. */
void weft_relief_slope(const weft_height_field *field, weft_vec3 view, weft_real slope[2]);

/* The height at which the sight line of a view through (u, v) of the plane first meets the surface from above: steps
 * of a sixteenth of the range, then bisections, then the chord of what is left. A line that slips through is taken to
 * meet the surface at its lowest. Pure. */
weft_real weft_relief_march(const weft_height_field *field, weft_real u, weft_real v, const weft_real slope[2]);

/* What every stored view sees of a height field. */
typedef struct weft_relief {
    weft_height_field field; /* its values are not owned */
    int view_count;
    weft_real (*slope)[2]; /* [view_count] */
    uint8_t *seen; /* [view_count][field.height][field.width] the height seen through the middle of a place, from low
                      (0) to high (255) */
} weft_relief;

/* Marches through every place for every view. The caller frees with weft_relief_free. Errors: WEFT_SYSTEM. */
weft_code weft_relief_create(const weft_height_field *field, const weft_vec3 *view, int view_count, weft_relief *relief,
                             weft_error *error);
void weft_relief_free(weft_relief *relief);

/* The heights that one view sees: seen [height][width]. Pure. */
void weft_relief_see(const weft_height_field *field, weft_vec3 view, uint8_t *seen);

/* Where a neighbouring view is read, and what it counts for. */
typedef struct weft_relief_tap {
    weft_real u, v, weight;
} weft_relief_tap;

/* Taps of three neighbouring views (index -1: none) for a view through (u, v) of the plane; `weight` are their
 * barycentric weights. Those of the taps add up to 1: a view counts less the further above the surface point what it
 * sees there lies. All heights count `share` of themselves (0: none, as on coarse levels). Thread-safe. */
void weft_relief_taps(const weft_relief *relief, weft_real share, weft_real u, weft_real v, weft_vec3 view,
                      const int index[3], const weft_real weight[3], weft_relief_tap tap[3]);

#endif

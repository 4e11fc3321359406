/* Which directions were measured: what a picture needs to know to begin where the data are. */
#ifndef WEFT_BTF_DATASET_MEASURED_H
#define WEFT_BTF_DATASET_MEASURED_H

#include "btf/dataset/dataset.h"

#include <jansson.h>

/* A cone that holds all directions that were measured, from anywhere on the material. */
typedef struct weft_cone {
    weft_vec3 axis; /* unit: the mean direction from the middle of the material */
    double angle_rad;
} weft_cone;

typedef struct weft_measured {
    weft_cone view, light;
    weft_vec3 first_view, first_light; /* of one image: close to the mean of all, and off the mirror where one is */
} weft_measured;

/* Pure. */
weft_measured weft_measured_of(const weft_dataset_layout *layout);

/* Whether a direction of any length lies in the cone, to half a degree. Pure. */
bool weft_cone_holds(const weft_cone *cone, weft_vec3 direction);

/* {"view": [x, y, z, degrees], "light": the same, "first_view": [x, y, z], "first_light": the same}, as the metadata of
 * a material keep it under "measured" (docs/reference/weft-format.md). NULL where memory is short. */
json_t *weft_measured_pack(const weft_measured *measured);

/* From the metadata of a material, JSON text or NULL; *known is false where they do not say it. Errors: WEFT_SYSTEM for
 * memory. */
weft_code weft_measured_parse(const char *metadata, bool *known, weft_measured *measured, weft_error *error);

#endif

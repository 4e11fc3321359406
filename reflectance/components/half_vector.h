/* The half vector of a light and a view above the horizon, unit; the normal where they are opposite. */
#ifndef WEFT_REFLECTANCE_COMPONENTS_HALF_VECTOR_H
#define WEFT_REFLECTANCE_COMPONENTS_HALF_VECTOR_H

#include "base/vector.h"

static inline weft_vec3 weft_half_vector(weft_vec3 light, weft_vec3 view)
{
    weft_vec3 sum = weft_add(light, view);
    return weft_length(sum) > (weft_real)1e-6 ? weft_unit(sum) : weft_vec3_of(0, 0, 1);
}

#endif

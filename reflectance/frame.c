#include "reflectance/lafortune.h"

/* |a x b| below this for unit vectors: parallel as far as single precision can tell. */
#define PARALLEL 1e-6

/* A vector that is not nearly parallel to the unit vector `normal`: x, or y where x is. */
static weft_vec3 axis_beside(weft_vec3 normal)
{
    weft_real across_x = sqrt(normal.y * normal.y + normal.z * normal.z);
    return across_x < (weft_real)PARALLEL ? weft_vec3_of(0, 1, 0) : weft_vec3_of(1, 0, 0);
}

static weft_vec3 without_component(weft_vec3 a, weft_vec3 unit)
{
    return weft_subtract(a, weft_scale(unit, weft_dot(a, unit)));
}

weft_frame weft_frame_of_vectors(weft_vec3 normal, weft_vec3 tangent)
{
    weft_frame frame = {.normal = weft_unit(normal)};
    weft_vec3 projected = without_component(weft_unit(tangent), frame.normal);
    if (!(weft_length(projected) >= (weft_real)PARALLEL))
        projected = without_component(axis_beside(frame.normal), frame.normal);
    frame.tangent = weft_unit(projected);
    frame.bitangent = weft_cross(frame.normal, frame.tangent);
    return frame;
}

weft_vec3 weft_frame_local(const weft_frame *frame, weft_vec3 direction)
{
    return weft_vec3_of(weft_dot(direction, frame->tangent), weft_dot(direction, frame->bitangent),
                        weft_dot(direction, frame->normal));
}

#include "btf/frame_sum.h"

void weft_frame_sum_add(weft_frame_sum *sum, weft_vec3 normal, weft_vec3 tangent, weft_real weight)
{
    sum->normal = weft_add(sum->normal, weft_scale(normal, weight));
    sum->xx += weight * tangent.x * tangent.x;
    sum->yy += weight * tangent.y * tangent.y;
    sum->zz += weight * tangent.z * tangent.z;
    sum->xy += weight * tangent.x * tangent.y;
    sum->yz += weight * tangent.y * tangent.z;
    sum->zx += weight * tangent.z * tangent.x;
}

void weft_frame_sum_merge(weft_frame_sum *sum, const weft_frame_sum *other, weft_real factor)
{
    sum->normal = weft_add(sum->normal, weft_scale(other->normal, factor));
    sum->xx += factor * other->xx;
    sum->yy += factor * other->yy;
    sum->zz += factor * other->zz;
    sum->xy += factor * other->xy;
    sum->yz += factor * other->yz;
    sum->zx += factor * other->zx;
}

static weft_vec3 apply_moments(const weft_frame_sum *sum, weft_vec3 v)
{
    return weft_vec3_of(sum->xx * v.x + sum->xy * v.y + sum->zx * v.z, sum->xy * v.x + sum->yy * v.y + sum->yz * v.z,
                        sum->zx * v.x + sum->yz * v.y + sum->zz * v.z);
}

weft_frame weft_frame_of_sum(const weft_frame_sum *sum)
{
    weft_vec3 normal = sum->normal;
    normal.z = normal.z > 0 ? normal.z : 0;
    if (!(weft_length(normal) > 0))
        return weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_frame plane = weft_frame_of_normal(weft_unit(normal), 0);
    weft_vec3 along = apply_moments(sum, plane.tangent), across = apply_moments(sum, plane.bitangent);
    /* The larger eigenvector of the moments in the plane. */
    weft_real cross = weft_dot(plane.tangent, across);
    weft_real difference = weft_dot(plane.tangent, along) - weft_dot(plane.bitangent, across);
    return weft_frame_of_normal(plane.normal, atan2(2 * cross, difference) / 2);
}

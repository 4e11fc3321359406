#include "btf/direction/frame.h"

/* |a x b| below this for unit vectors: parallel as far as single precision can tell. */
#define PARALLEL 1e-6

static weft_vec3 project(weft_vec3 axis, weft_vec3 normal)
{
    return weft_subtract(axis, weft_scale(normal, weft_dot(axis, normal)));
}

weft_frame weft_frame_of_normal(weft_vec3 normal, weft_real azimuth_rad)
{
    weft_vec3 along = project(weft_vec3_of(1, 0, 0), normal);
    if (weft_length(along) < (weft_real)PARALLEL)
        along = project(weft_vec3_of(0, 1, 0), normal);
    along = weft_unit(along);
    weft_vec3 across = weft_cross(normal, along);
    weft_vec3 tangent = weft_add(weft_scale(along, cos(azimuth_rad)), weft_scale(across, sin(azimuth_rad)));
    return (weft_frame){normal, tangent, weft_cross(normal, tangent)};
}

/* A vector that is not nearly parallel to the unit vector `normal`: x, or y where x is. */
static weft_vec3 axis_beside(weft_vec3 normal)
{
    weft_real across_x = sqrt(normal.y * normal.y + normal.z * normal.z);
    return across_x < (weft_real)PARALLEL ? weft_vec3_of(0, 1, 0) : weft_vec3_of(1, 0, 0);
}

weft_frame weft_frame_of_vectors(weft_vec3 normal, weft_vec3 tangent)
{
    weft_frame frame = {.normal = weft_unit(normal)};
    weft_vec3 projected = project(weft_unit(tangent), frame.normal);
    if (!(weft_length(projected) >= (weft_real)PARALLEL))
        projected = project(axis_beside(frame.normal), frame.normal);
    frame.tangent = weft_unit(projected);
    frame.bitangent = weft_cross(frame.normal, frame.tangent);
    return frame;
}

weft_vec3 weft_frame_local(const weft_frame *frame, weft_vec3 direction)
{
    return weft_vec3_of(weft_dot(direction, frame->tangent), weft_dot(direction, frame->bitangent),
                        weft_dot(direction, frame->normal));
}

/* ---- Codes ---- */

static const weft_real code_scale = 32767;

static int16_t code_of(weft_real value)
{
    return (int16_t)lround(weft_clamp(value, -1, 1) * code_scale);
}

static weft_vec3 decode_normal(const int16_t code[2])
{
    weft_real x = code[0] / code_scale, y = code[1] / code_scale;
    weft_real z_squared = 1 - x * x - y * y;
    return weft_unit(weft_vec3_of(x, y, z_squared > 0 ? sqrt(z_squared) : 0));
}

weft_frame weft_frame_decode(const int16_t code[3])
{
    return weft_frame_of_normal(decode_normal(code), code[2] / code_scale * (weft_real)WEFT_PI);
}

void weft_frame_encode(const weft_frame *frame, int16_t code[3])
{
    code[0] = code_of(frame->normal.x);
    code[1] = code_of(frame->normal.y);
    /* The azimuth is measured in the frame that the decoder will start from. */
    weft_frame start = weft_frame_of_normal(decode_normal(code), 0);
    weft_real azimuth_rad = atan2(weft_dot(frame->tangent, start.bitangent), weft_dot(frame->tangent, start.tangent));
    code[2] = code_of(azimuth_rad / (weft_real)WEFT_PI);
}

/* ---- Averages ---- */

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

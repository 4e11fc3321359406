/* Codes of the frame of a texel (docs/reference/weft-format.md, 3.3). */
#include "btf/material.h"

static const weft_real code_scale = 32767;

static int16_t code_of(weft_real value)
{
    return (int16_t)lround(weft_clamp(value, -1, 1) * code_scale);
}

static weft_vec3 project(weft_vec3 axis, weft_vec3 normal)
{
    return weft_subtract(axis, weft_scale(normal, weft_dot(axis, normal)));
}

weft_frame weft_frame_of_normal(weft_vec3 normal, weft_real azimuth_rad)
{
    weft_vec3 along = project(weft_vec3_of(1, 0, 0), normal);
    if (weft_length(along) < (weft_real)1e-6)
        along = project(weft_vec3_of(0, 1, 0), normal);
    along = weft_unit(along);
    weft_vec3 across = weft_cross(normal, along);
    weft_vec3 tangent = weft_add(weft_scale(along, cos(azimuth_rad)), weft_scale(across, sin(azimuth_rad)));
    return (weft_frame){normal, tangent, weft_cross(normal, tangent)};
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

// Lafortune lobes in the frame of a texel: twin of reflectance/lafortune.c and btf/frame.c.
// Common subset of GLSL 3.30 core and GLSL ES 3.00; needs highp float.

struct Frame {
    vec3 normal, tangent, bitangent;
};

// log of the largest lobe value.
const float LOBE_MAX_EXPONENT = 69.0775528;

// a^n: 0 for a < 0; 0 for a = 0 and n > 0; 1 for a = 0 and n = 0; finite in any case.
float lobe_power(float a, float n)
{
    if (a > 0.0)
        return exp(min(n * log(a), LOBE_MAX_EXPONENT));
    return a == 0.0 && n == 0.0 ? 1.0 : 0.0;
}

// `lobe` holds Cx, Cy, Cz, N.
float lobe_value(vec4 lobe, vec3 light, vec3 view)
{
    return lobe_power(dot(lobe.xyz, light * view), lobe.w);
}

vec3 frame_project(vec3 axis, vec3 normal)
{
    return axis - normal * dot(axis, normal);
}

// The tangent is x projected on the plane of `normal` (y where x is parallel to it), turned by `azimuth_rad`.
Frame frame_of_normal(vec3 normal, float azimuth_rad)
{
    vec3 along = frame_project(vec3(1.0, 0.0, 0.0), normal);
    if (length(along) < 1e-6)
        along = frame_project(vec3(0.0, 1.0, 0.0), normal);
    along = normalize(along);
    vec3 across = cross(normal, along);
    vec3 tangent = along * cos(azimuth_rad) + across * sin(azimuth_rad);
    return Frame(normal, tangent, cross(normal, tangent));
}

// n_x, n_y and azimuth / pi, each times 32767.
Frame frame_decode(ivec3 code)
{
    vec3 value = vec3(code) / 32767.0;
    vec3 normal = normalize(vec3(value.xy, sqrt(max(0.0, 1.0 - dot(value.xy, value.xy)))));
    return frame_of_normal(normal, value.z * 3.14159265);
}

vec3 frame_local(Frame frame, vec3 direction)
{
    return vec3(dot(direction, frame.tangent), dot(direction, frame.bitangent), dot(direction, frame.normal));
}

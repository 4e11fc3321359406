// Lafortune lobes in the frame of a texel: twin of reflectance/lafortune/lafortune.c.
// Common subset of GLSL 3.30 core and GLSL ES 3.00; needs highp float.

// Binary logarithm of the largest lobe value.
const float LOBE_MAX_EXPONENT = 99.6578428;

// a^n: 0 for a < 0; for a = 0 that of the smallest normal number, 1 where n = 0; finite in any case.
float lobe_power(float a, float n)
{
    float power = exp2(min(n * log2(max(a, 1.2e-38)), LOBE_MAX_EXPONENT));
    return a >= 0.0 ? power : 0.0;
}

// Scaled so that no channel is above `ceiling`; 0: there is no ceiling.
vec3 under_ceiling(vec3 value, float ceiling)
{
    float largest = max(value.r, max(value.g, value.b));
    return ceiling > 0.0 && largest > ceiling ? min(value * (ceiling / largest), ceiling) : value;
}

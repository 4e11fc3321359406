// Texture value of one yarn segment of woven cloth: twin of reflectance/woven/woven.c, mirror.h and segment.c.
// Common subset of GLSL 3.30 core and GLSL ES 3.00; needs highp float.

const float WOVEN_PI = 3.14159265358979;
const float WOVEN_MIN_UMAX = 1e-7;
const float WOVEN_MIN_HALF_SQUARED = 1e-12;
const float WOVEN_MIN_ACROSS = 1e-15;
const float WOVEN_MIN_COSINE_SUM = 1e-30;

// A prepared segment: every number of weft_prepared_segment that the texture needs.
struct Segment {
    float alpha, beta, delta, phase_scale;
    float cot_psi, inverse_sin_psi; // inverse_sin_psi = 0: filament
    float umax, kappa;
    float width, size; // size = length of the segment
    float highlight_width;
    float radius_share; // of umax where the spine that gives the radius of a filament ends
};

struct Spine {
    float umax, sin_umax, cos_umax, shape, scale;
};

// A point of the yarn that mirrors light into view.
struct Mirror {
    float sin_u, cos_u, sin_v, cos_v;
    float light_share, view_share, cosine_sum;
};

Spine segment_spine(Segment segment, float umax)
{
    float sine = sin(umax);
    float cosine = max(cos(umax), 0.0);
    float shape = (1.0 + segment.kappa) + segment.kappa * (cosine / sine);
    float end = shape < 0.0 ? (1.0 + segment.kappa) * (cosine + sine) * (cosine - shape * sine)
                            : cosine * cosine + shape * shape * sine * sine;
    // Not below 0: the sine of a shader may be the larger one by rounding.
    float half_length = 0.5 * max(segment.size - segment.width * sine, 0.0);
    return Spine(umax, sine, cosine, shape, half_length / sine * sqrt(end));
}

// Radius of curvature at u; inside = umax - |u|.
float spine_radius(Segment segment, Spine spine, float inside, float sin_u, float cos_u)
{
    float sin_abs_u = abs(sin_u);
    float end = (1.0 + segment.kappa) * (spine.sin_umax + spine.cos_umax);
    cos_u = max(cos_u, spine.cos_umax);
    float e = spine.shape < 0.0
                  ? (sin(max(inside, 0.0)) + end * sin_abs_u) / spine.sin_umax * (cos_u - spine.shape * sin_abs_u)
                  : cos_u * cos_u + spine.shape * spine.shape * sin_u * sin_u;
    return spine.scale / (e * sqrt(e));
}

float filament_radius(Segment segment, Spine spine, float u, float sin_u, float cos_u)
{
    if (!(segment.radius_share < 1.0))
        return spine_radius(segment, spine, spine.umax - abs(u), sin_u, cos_u);
    float end = max(spine.umax * segment.radius_share, WOVEN_MIN_UMAX);
    float at = min(abs(u), end);
    return spine_radius(segment, segment_spine(segment, end), end - at, sin(at), cos(at));
}

// Whether n(u, v) is on the upper half of the yarn and faces both directions; fills the shares.
bool faces_both(inout Mirror at, vec3 light, vec3 view)
{
    if (!(at.cos_v > 0.0))
        return false;
    vec3 normal = vec3(at.sin_v, at.sin_u * at.cos_v, at.cos_u * at.cos_v);
    float c1 = dot(normal, light);
    float c2 = dot(normal, view);
    at.cosine_sum = c1 + c2;
    if (!(c1 > 0.0 && c2 > 0.0 && at.cosine_sum > WOVEN_MIN_COSINE_SUM))
        return false;
    at.light_share = c1 / at.cosine_sum;
    at.view_share = c2 / at.cosine_sum;
    return true;
}

// Staple: solves for v.
bool staple_mirror(float cot_psi, float half_x, float along, float across, inout Mirror at)
{
    float norm = sqrt(half_x * half_x + across * across);
    float projected = cot_psi * along;
    if (!(abs(projected) < norm))
        return false;
    float cosine = projected / norm;
    float sine = sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0));
    at.sin_v = (half_x * sine - across * cosine) / norm;
    at.cos_v = (half_x * cosine + across * sine) / norm;
    return true;
}

float prepared_phase(Segment segment, vec3 light, vec3 view)
{
    float x = clamp(-dot(light, view), -1.0, 1.0);
    return segment.alpha + exp(segment.beta * x - abs(segment.beta)) * segment.phase_scale;
}

float yarn_area(Segment segment, float radius, float cos_v)
{
    float yarn_radius = 0.5 * segment.width;
    return yarn_radius * (radius + yarn_radius * cos_v);
}

// By the distance to the end, which does not cancel where the fade ends.
float filament_fade(float delta, float umax, float u)
{
    if (!(delta > 0.0))
        return 1.0;
    float inside = clamp((umax - abs(u)) / (delta * umax), 0.0, 1.0);
    return inside * inside * (3.0 - 2.0 * inside);
}

bool inside_band(float x, float centre, float width, float rectangle)
{
    float limit = 0.5 * (rectangle - width);
    return abs(x - clamp(centre, -limit, limit)) < 0.5 * width;
}

float staple_texture(Segment segment, float umax, vec2 place, vec3 halfway, vec3 light, vec3 view)
{
    float u = 2.0 * umax * place.y / segment.size;
    Mirror at = Mirror(sin(u), cos(u), 0.0, 0.0, 0.0, 0.0, 0.0);
    float along = halfway.y * at.cos_u - halfway.z * at.sin_u;
    float across = halfway.y * at.sin_u + halfway.z * at.cos_u;
    if (!staple_mirror(segment.cot_psi, halfway.x, along, across, at) || !faces_both(at, light, view))
        return 0.0;
    float centre = segment.width * (atan(at.sin_v, at.cos_v) / WOVEN_PI);
    if (!inside_band(place.x, centre, segment.highlight_width * segment.width, segment.width))
        return 0.0;
    Spine spine = segment_spine(segment, umax);
    float radius = spine_radius(segment, spine, umax - abs(u), at.sin_u, at.cos_u);
    float integrand = yarn_area(segment, radius, at.cos_v) * segment.inverse_sin_psi *
                      (at.light_share * at.view_share) * prepared_phase(segment, light, view);
    return 2.0 * umax * integrand / segment.highlight_width;
}

float filament_texture(Segment segment, float umax, vec2 place, vec3 halfway, vec3 light, vec3 view)
{
    float across = sqrt(halfway.y * halfway.y + halfway.z * halfway.z);
    float u = atan(halfway.y, halfway.z);
    if (!(across > WOVEN_MIN_ACROSS && abs(u) < umax))
        return 0.0;
    float centre = segment.size * (u / (2.0 * umax));
    if (!inside_band(place.y, centre, segment.highlight_width * segment.size, segment.size))
        return 0.0;
    float v = WOVEN_PI * (place.x / segment.width);
    Mirror at = Mirror(halfway.y / across, halfway.z / across, sin(v), cos(v), 0.0, 0.0, 0.0);
    if (!faces_both(at, light, view))
        return 0.0;
    Spine spine = segment_spine(segment, umax);
    float radius = filament_radius(segment, spine, u, at.sin_u, at.cos_u);
    float attenuation = at.light_share * at.view_share * at.cosine_sum * filament_fade(segment.delta, umax, u);
    float integrand = yarn_area(segment, radius, at.cos_v) / across * attenuation * prepared_phase(segment, light, view);
    return WOVEN_PI * integrand / segment.highlight_width;
}

// T at `place` = (x, y) of the segment rectangle; light and view in the frame of the segment.
float prepared_texture(Segment segment, float umax, vec2 place, vec3 light, vec3 view)
{
    vec3 halfway = light + view;
    bool inside = abs(place.x) <= 0.5 * segment.width && abs(place.y) <= 0.5 * segment.size;
    if (!inside || !(light.z > 0.0 && view.z > 0.0 && dot(halfway, halfway) >= WOVEN_MIN_HALF_SQUARED))
        return 0.0;
    umax = min(umax, 0.5 * WOVEN_PI);
    if (segment.inverse_sin_psi == 0.0)
        return filament_texture(segment, umax, place, halfway, light, view);
    return staple_texture(segment, umax, place, halfway, light, view);
}

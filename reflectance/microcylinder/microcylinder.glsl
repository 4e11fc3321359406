// Cloth of microcylinder threads: twin of reflectance/microcylinder/microcylinder.c and cloth.c.
// Common subset of GLSL 3.30 core and GLSL ES 3.00; needs highp float.

const float THREAD_MAX_TILT = 89.9 * 3.14159265358979 / 180.0;
const float THREAD_MIN_COS_THETA_DIFFERENCE = 1e-6;
const float THREAD_MIN_PLANE_SQUARED = 1e-36;
const float THREAD_INVERSE_SQRT_PI = 0.564189583547756;
const float CLOTH_MIN_LIGHT_COSINE = 1e-6;

// axis 0 = x, 1 = y.
struct ThreadTangent {
    int axis;
    float cos_tilt, sin_tilt;
};

struct ThreadOptics {
    float eta, gamma_s, gamma_v, kd;
    vec3 albedo;
};

struct ThreadAngles {
    float theta_light, theta_view, theta_half;
    float cos_theta_light, cos_theta_view;
    float cos_theta_difference;
    float phi_difference;
    float cos_phi_light, cos_phi_view;
    float cos_half_phi;
};

ThreadTangent thread_tangent_of(int axis, float tilt_rad)
{
    float tilt = clamp(tilt_rad, -THREAD_MAX_TILT, THREAD_MAX_TILT);
    return ThreadTangent(axis, cos(tilt), sin(tilt));
}

// Cosine and sine of the angle of (x, y), 0 for one whose square has no digits left; size is the length of (x, y).
vec2 plane_angle_of(float x, float y, out float size)
{
    float square = x * x + y * y;
    size = sqrt(square);
    return square > THREAD_MIN_PLANE_SQUARED ? vec2(x, y) / size : vec2(1.0, 0.0);
}

// atan(0, 0) is undefined in GLSL.
float angle_of(float y, float x)
{
    return x == 0.0 && y == 0.0 ? 0.0 : atan(y, x);
}

float absolute_difference(vec2 a, vec2 b)
{
    return angle_of(abs(a.x * b.y - a.y * b.x), a.x * b.x + a.y * b.y);
}

// x = sin theta, y = cos theta, zw = cosine and sine of phi.
vec4 thread_direction_of(ThreadTangent tangent, vec3 d)
{
    float along = tangent.axis == 0 ? d.x : d.y;
    float across = tangent.axis == 0 ? d.y : -d.x;
    float cos_theta;
    vec2 phi = plane_angle_of(tangent.cos_tilt * d.z - tangent.sin_tilt * along, across, cos_theta);
    return vec4(tangent.cos_tilt * along + tangent.sin_tilt * d.z, cos_theta, phi);
}

ThreadAngles thread_angles_of(ThreadTangent tangent, vec3 light, vec3 view)
{
    vec4 incoming = thread_direction_of(tangent, light);
    vec4 outgoing = thread_direction_of(tangent, view);
    float theta_light = angle_of(incoming.x, incoming.y);
    float theta_view = angle_of(outgoing.x, outgoing.y);
    float theta_size;
    float phi_size;
    plane_angle_of(incoming.y + outgoing.y, incoming.x + outgoing.x, theta_size);
    plane_angle_of(incoming.z + outgoing.z, incoming.w + outgoing.w, phi_size);
    return ThreadAngles(theta_light, theta_view, 0.5 * (theta_light + theta_view), incoming.y, outgoing.y,
                        min(0.5 * theta_size, 1.0), absolute_difference(incoming.zw, outgoing.zw), incoming.z,
                        outgoing.z, min(0.5 * phi_size, 1.0));
}

// eta times the cosine of refraction; negative under total reflection.
float refracted_cosine(float c, float eta)
{
    float square = (eta - 1.0) * (eta + 1.0) + c * c;
    return square > 0.0 ? sqrt(square) : -1.0;
}

float fresnel_reflectance(float c, float eta)
{
    float refracted = refracted_cosine(c, eta);
    if (!(c > 0.0 && refracted > 0.0))
        return 1.0;
    float across = (c - refracted) / (c + refracted);
    float along = (eta * eta * c - refracted) / (eta * eta * c + refracted);
    return 0.5 * (across * across + along * along);
}

float fresnel_transmittance(float c, float eta)
{
    float refracted = refracted_cosine(c, eta);
    if (!(c > 0.0 && refracted > 0.0))
        return 0.0;
    float across = c + refracted;
    float along = eta * c + refracted / eta;
    return 2.0 * c * refracted * (1.0 / (across * across) + 1.0 / (along * along));
}

float thread_gaussian(float x, float width)
{
    float scaled = x / width;
    return exp(-scaled * scaled);
}

float thread_normalised_gaussian(float x, float width)
{
    return thread_gaussian(x, width) * (THREAD_INVERSE_SQRT_PI / width);
}

float thread_surface(ThreadOptics optics, ThreadAngles angles)
{
    float incidence = angles.cos_theta_difference * angles.cos_half_phi;
    return fresnel_reflectance(incidence, optics.eta) * angles.cos_half_phi *
           thread_normalised_gaussian(angles.theta_half, optics.gamma_s);
}

float thread_volume(ThreadOptics optics, ThreadAngles angles)
{
    float cosines = angles.cos_theta_light + angles.cos_theta_view;
    if (!(cosines > 0.0))
        return 0.0;
    float transmitted = fresnel_transmittance(angles.cos_theta_light, optics.eta) *
                        fresnel_transmittance(angles.cos_theta_view, optics.eta);
    float lobe = (1.0 - optics.kd) * thread_normalised_gaussian(angles.theta_half, optics.gamma_v) + optics.kd;
    return transmitted * lobe / cosines;
}

vec3 thread_scattering(ThreadOptics optics, ThreadAngles angles)
{
    float cosine = angles.cos_theta_difference;
    if (!(cosine >= THREAD_MIN_COS_THETA_DIFFERENCE))
        return vec3(0.0);
    float surface = thread_surface(optics, angles) / (cosine * cosine);
    float volume = thread_volume(optics, angles) / (cosine * cosine);
    return vec3(surface) + volume * optics.albedo;
}

float joint_visibility(float correlation, float light, float view)
{
    float y = max(light, 0.0);
    float z = max(view, 0.0);
    return (1.0 - correlation) * y * z + correlation * min(y, z);
}

float thread_shadowing(ThreadAngles angles, float sigma)
{
    return joint_visibility(thread_gaussian(angles.phi_difference, sigma), angles.cos_phi_light, angles.cos_phi_view);
}

float thread_projection(int axis, float sigma, vec3 light, vec3 view)
{
    float size;
    vec2 incoming = plane_angle_of(light.z, axis == 0 ? light.x : light.y, size);
    vec2 outgoing = plane_angle_of(view.z, axis == 0 ? view.x : view.y, size);
    return joint_visibility(thread_gaussian(absolute_difference(incoming, outgoing), sigma), incoming.x, outgoing.x);
}

// ---- Cloth, from the table that weft_microcylinder_table writes ----

const int CLOTH_THREADS = 2;
const int CLOTH_THREAD_TEXELS = 3 + 64;

vec4 cloth_texel(sampler2D table, int index)
{
    return texelFetch(table, ivec2(index, 0), 0);
}

// Sum over the tangents of the thread that begins at texel `first` of f_s M cos(theta_light).
vec3 thread_sum(sampler2D table, int first, float sigma, vec3 light, vec3 view)
{
    vec4 head = cloth_texel(table, first);
    vec4 shape = cloth_texel(table, first + 1);
    ThreadOptics optics = ThreadOptics(shape.x, shape.y, shape.z, shape.w, cloth_texel(table, first + 2).rgb);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < int(head.y); i++) {
        vec4 tilt = cloth_texel(table, first + 3 + i);
        ThreadAngles angles = thread_angles_of(ThreadTangent(int(head.x), tilt.x, tilt.y), light, view);
        float shadowing = thread_shadowing(angles, sigma);
        if (shadowing > 0.0)
            sum += shadowing * angles.cos_theta_light * thread_scattering(optics, angles);
    }
    return sum;
}

// K; as_printed selects WEFT_CLOTH_AS_PRINTED, else WEFT_CLOTH_BY_AREA.
vec3 microcylinder_scattering(sampler2D table, bool as_printed, vec3 light, vec3 view)
{
    vec4 head = cloth_texel(table, 0);
    if (!(head.x > 0.0 && light.z > 0.0 && view.z > 0.0))
        return vec3(0.0);
    vec3 k = vec3(0.0);
    float met = as_printed ? 0.0 : head.z * view.z;
    for (int j = 0; j < CLOTH_THREADS; j++) {
        int first = 1 + j * CLOTH_THREAD_TEXELS;
        vec4 thread = cloth_texel(table, first);
        float projection = thread_projection(int(thread.x), head.y, light, view);
        met += projection * (as_printed ? thread.y : thread.z);
        k += projection * thread.z / (as_printed ? 1.0 : thread.y) * thread_sum(table, first, head.y, light, view);
    }
    return met > 0.0 ? k / met : vec3(0.0);
}

vec3 microcylinder_brdf(sampler2D table, bool as_printed, vec3 light, vec3 view)
{
    return microcylinder_scattering(table, as_printed, light, view) / max(light.z, CLOTH_MIN_LIGHT_COSINE);
}

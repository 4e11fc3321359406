// What every mode needs to know of the surface behind a pixel (written by surface.frag.glsl), and of the light on it.
// Constants defined by player/draw/programs.c: MAX_LIGHTS, LEVEL_COLOURS, LIGHT_COUNT (of lights that are evaluated),
// ONE_LIGHT, CHOSEN_LIGHTS: 0, or how many of the environment are evaluated, by chance, in the place of all of it;
// STOCHASTIC, SHADOWS, and PLOT: 0 for the picture; else a disc of directions at one place of the material, 1 of
// lights, 2 of views (player/draw/probe.h).
uniform sampler2D surface_rotation;
uniform sampler2D surface_place;
uniform sampler2D surface_sides;
uniform vec3 ray_right, ray_up, ray_forward; // the ray through a pixel: x right + y up + forward
uniform vec2 pane_origin;
uniform vec3 eye;
uniform mat4 shadow_of_world[SHADOW_LAYERS];
uniform highp sampler2DArrayShadow shadow_map; // of places in the first light, then of directions of the environment
uniform float shadow_texel;                    // of the map, in the world, where a layer uses all of it
uniform float shadow_share[SHADOW_LAYERS];     // of its side that a layer uses
uniform vec3 sample_direction[SHADOW_LAYERS - KEY_PLACES];
uniform int shadow_taps; // 1 or 4
uniform int key_count;   // places in the first light from which shadows fall: 0, 1 or KEY_PLACES
uniform int scene_count; // lights of the scene; the lights after them are the environment
uniform int interleave_count; // sets of environment lights, one for each index of a pixel
uniform int sample_count; // directions of the environment; 0: it casts no shadows
uniform float least_visibility; // of the environment, anywhere
uniform int light_count;
uniform vec3 light_direction[MAX_LIGHTS];  // world, unit, toward the light
uniform vec3 light_irradiance[MAX_LIGHTS]; // on a surface that faces it, over pi
uniform float sequence;                    // [0, 1), of the frame: where its random choices begin

uniform vec3 probe_light, probe_view; // in the axes of the surface
uniform vec3 probe_place;              // texture coordinates and level
uniform float plot_size;               // pixels

struct SurfacePoint {
    mat3 axes;       // of the surface in the world: x along u, y along v, the normal
    vec3 view;       // in these axes
    vec2 coordinate; // texture coordinates of the material, repeated
    float level;     // log2 of the pixel's footprint in texels, may be negative
    vec4 sides;      // of the sample, texels: across, up; 0: the level does not follow from it
    float key_share; // of the first light that is not in shadow
    float env_share; // of the environment's light, about
    float chance;    // in [0, 1)
    int interleave;  // index of the pixel: which lights of the environment it gets
    ivec2 chosen;       // where CHOSEN_LIGHTS: lights of the environment,
    vec2 chosen_weight; // and what each of them counts
};

// Interpolated normals may turn away from the eye at a silhouette; the view is kept just above the horizon.
vec3 above_horizon(vec3 view)
{
    return normalize(vec3(view.xy, max(view.z, 0.02)));
}

// Interleaved gradient noise (Jimenez 2014), moved by the frame: neighbours in the picture and in time differ.
float chance_at(vec2 place)
{
    float noise = fract(52.9829189 * fract(dot(place, vec2(0.06711056, 0.00583715))));
    return fract(noise + sequence);
}

float pixel_chance()
{
    return chance_at(gl_FragCoord.xy);
}

// Equal areas: z = 1 - r^2. Beside the disc z is negative.
vec3 plotted_direction()
{
    vec2 place = 2.0 * (gl_FragCoord.xy - pane_origin) / plot_size - 1.0;
    float square = dot(place, place);
    return vec3(place * sqrt(max(2.0 - square, 0.0)), 1.0 - square);
}

SurfacePoint plotted_point()
{
    SurfacePoint point;
    point.axes = mat3(1.0);
    point.view = PLOT == 2 ? plotted_direction() : probe_view;
    point.view.z = max(point.view.z, 0.0);
    point.coordinate = probe_place.xy;
    point.level = probe_place.z;
    point.sides = vec4(0.0);
    point.key_share = point.env_share = 1.0;
    point.chance = 0.0;
    point.interleave = 0;
    return point;
}

// True with probability `share`; what is left of the chance is uniform again.
bool happens(inout float chance, float share)
{
    bool yes = chance < share;
    chance = yes ? chance / share : (chance - share) / (1.0 - share);
    return yes;
}

// A place is looked up a little before its surface: by the reach of the comparisons in texels of the map, or its own
// facets, which the interpolated normal smooths over, would shade it.
vec3 place_in_shadow(vec3 position, vec3 normal, int layer)
{
    return (shadow_of_world[layer] * vec4(position + 2.5 * shadow_texel / shadow_share[layer] * normal, 1.0)).xyz;
}

bool is_in_map(vec3 at)
{
    return all(lessThan(abs(at.xy - 0.5), vec2(0.499)));
}

// Four or sixteen comparisons, bilinear by the hardware: an edge of one texel of the map or of about three. Software
// rasterisers pass over a loop that no pixel takes, not over a branch.
float unshadowed_share(vec3 position, vec3 normal, int layer, int taps)
{
    vec3 at = place_in_shadow(position, normal, layer);
    int count = is_in_map(at) ? taps : 0;
    float texel = taps > 1 ? 1.5 / float(textureSize(shadow_map, 0).x) : 0.0;
    float seen = float(taps - count);
    for (int i = 0; i < count; i++) {
        vec2 shift = (vec2(float(i % 2), float(i / 2)) - 0.5) * texel;
        seen += texture(shadow_map, vec4(at.xy * shadow_share[layer] + shift, float(layer), at.z));
    }
    return seen / float(taps);
}

// Of the first light. Where its places are many, their edges lie apart, and one comparison does for each.
float key_share_of(vec3 position, vec3 normal)
{
    float seen = 0.0;
    for (int i = 0; i < key_count; i++)
        seen += unshadowed_share(position, normal, i, key_count > 1 ? 1 : shadow_taps);
    return key_count > 0 ? seen / float(key_count) : 1.0;
}

// Visibility of a few directions of the environment, weighted by the cosine.
float environment_visibility(vec3 position, vec3 normal)
{
    float seen = 1e-3, all_of_it = 1e-3;
    for (int i = 0; i < sample_count; i++) {
        float cosine = max(dot(sample_direction[i], normal), 0.0);
        all_of_it += cosine;
        seen += cosine * unshadowed_share(position, normal, KEY_PLACES + i, 1);
    }
    return max(seen / all_of_it, least_visibility);
}

void find_shadows(vec3 position, inout SurfacePoint point)
{
    point.key_share = point.env_share = 1.0;
    if (!SHADOWS)
        return;
    point.key_share = key_share_of(position, point.axes[2]);
    point.env_share = environment_visibility(position, point.axes[2]);
}

// About what a light of the environment brings to a surface. Grazing light counts for more than its cosine: it is what
// cloth may throw back many times as much of, and a pixel that chose it by a rare chance would glare.
float brightness_of(int light, vec3 normal)
{
    float cosine = dot(light_direction[light], normal);
    return cosine > 0.0 ? dot(light_irradiance[light], vec3(1.0)) * (cosine + 0.25) : 0.0;
}

// As many as CHOSEN_LIGHTS, as likely as they are bright there, and at even steps of their sum: each pixel has its share
// of the bright and of the dark ones.
void choose_lights(inout SurfacePoint point)
{
    float all_of_them = 0.0;
    for (int i = scene_count; i < light_count; i++)
        all_of_them += brightness_of(i, point.axes[2]);
    vec2 wanted = (chance_at(gl_FragCoord.xy + vec2(47.0, 17.0)) + vec2(0.0, 1.0)) * all_of_them / float(CHOSEN_LIGHTS);
    point.chosen = ivec2(scene_count);
    point.chosen_weight = vec2(0.0);
    float passed = 0.0;
    for (int i = scene_count; i < light_count; i++) {
        float here = brightness_of(i, point.axes[2]);
        bvec2 is_it = lessThanEqual(vec2(passed), wanted);
        if (is_it.x && here > 0.0) {
            point.chosen.x = i;
            point.chosen_weight.x = all_of_them / (float(CHOSEN_LIGHTS) * here);
        }
        if (is_it.y && here > 0.0) {
            point.chosen.y = i;
            point.chosen_weight.y = all_of_them / (float(CHOSEN_LIGHTS) * here);
        }
        passed += here;
    }
}

// The upper ones look random.
uint random_bits(uvec2 place)
{
    uint bits = place.x * 0x9E3779B1u ^ place.y * 0x85EBCA77u;
    return (bits ^ bits >> 15) * 0x2C1B3C6Du;
}

// Index 0 to 7 of a pixel in its block of 4 x 2. Each is next to the one that it completes most (player/draw/lighting.h).
// From block to block the indices are exchanged, all at once: a fixed order would be a visible hatch.
int interleave_index()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int index = (pixel.x & 1) * 4 + ((pixel.x >> 1 ^ pixel.y) & 1) * 2 + (pixel.y & 1);
    return index ^ int(random_bits(uvec2(pixel >> ivec2(2, 1))) >> 29);
}

SurfacePoint surface_point()
{
    if (PLOT != 0)
        return plotted_point();
    vec2 pixel = gl_FragCoord.xy / vec2(textureSize(surface_place, 0));
    vec4 place = textureLod(surface_place, pixel, 0.0);
    vec2 at = gl_FragCoord.xy - pane_origin;
    vec3 ray = at.x * ray_right + at.y * ray_up + ray_forward;
    SurfacePoint point;
    point.axes = axes_of_quaternion(textureLod(surface_rotation, pixel, 0.0));
    point.axes[1] *= sign(place.w);
    point.view = above_horizon(-normalize(ray) * point.axes);
    point.coordinate = place.xy;
    point.level = place.z;
    point.sides = textureLod(surface_sides, pixel, 0.0);
    find_shadows(eye + abs(place.w) * ray, point);
    point.chance = STOCHASTIC ? pixel_chance() : 0.0;
    point.interleave = interleave_count > 1 ? interleave_index() % interleave_count : 0;
    if (CHOSEN_LIGHTS > 0)
        choose_lights(point);
    return point;
}

// The number of the one that is evaluated as the `i`-th.
int light_at(SurfacePoint point, int i)
{
    if (CHOSEN_LIGHTS > 0)
        return i < scene_count ? i : i == scene_count ? point.chosen.x : point.chosen.y;
    return i < scene_count ? i : scene_count + (i - scene_count) * interleave_count + point.interleave;
}

float weight_at(SurfacePoint point, int i)
{
    return CHOSEN_LIGHTS == 0 || i < scene_count ? 1.0 : i == scene_count ? point.chosen_weight.x : point.chosen_weight.y;
}

// Of the world, unit, toward the light.
vec3 world_light(int light)
{
    return PLOT == 0 ? light_direction[light] : PLOT == 1 ? plotted_direction() : probe_light;
}

vec3 surface_light(SurfacePoint point, int i)
{
    return world_light(light_at(point, i)) * point.axes;
}

float unshaded_share(SurfacePoint point, int light)
{
    return light >= scene_count ? point.env_share : light == 0 ? point.key_share : 1.0;
}

// Over pi, with the cosine; 0 below the horizon of the surface.
vec3 surface_irradiance(SurfacePoint point, int i)
{
    if (PLOT != 0)
        return vec3(1.0); // without the cosine: BRDF x pi
    int light = light_at(point, i);
    float cosine = max(dot(light_direction[light], point.axes[2]), 0.0);
    return light_irradiance[light] * cosine * unshaded_share(point, light) * weight_at(point, i);
}

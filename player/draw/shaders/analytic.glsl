// Analytic cloth: the woven texture where a sample resolves the yarns, the mean of the tile where it does not. A sample
// is a pixel, or the part of it that one of the frames of its mean stands for.
// Constant defined by player/draw/programs.c: NOISE, STAPLES, FILAMENTS.
// C twins: weft_weave_brdf and weft_weave_tabulated_mean.
uniform sampler2D weave_table;
uniform sampler2D weave_means;
uniform vec2 weave_tiles;     // for one material
uniform vec2 weave_corner;    // where a tile begins, tiles from that of the material
uniform uvec2 noise_seed;     // low and high bits
uniform int chosen_places;    // where STOCHASTIC

// log2 of the footprint in cells where the texture begins to fade, and where the mean is all there is.
const float FADE_BEGIN = -1.0;
const float FADE_END = 1.0;
// How many times longer than wide a footprint may be and be sampled along its length; how many places at most on a side.
const float LONGEST = 4.0;
const float MOST_PLACES = 3.0;

float fade_at(float level)
{
    return clamp((level - FADE_BEGIN) / (FADE_END - FADE_BEGIN), 0.0, 1.0);
}

// log2 of the footprint's width in cells, or of what its length leaves where that is too long.
float footprint_width(SurfacePoint point)
{
    float across = length(point.sides.xy), up = length(point.sides.zw), area = determinant(mat2(point.sides.xy, point.sides.zw));
    float longer = max(across, up);
    return longer > 0.0 ? log2(max(abs(area) / longer, longer / LONGEST)) : point.level;
}

// Two places a cell, so that a yarn is not missed.
ivec2 places_of(SurfacePoint point)
{
    vec2 sides = vec2(length(point.sides.xy), length(point.sides.zw));
    return ivec2(clamp(ceil(2.0 * sides), 1.0, MOST_PLACES));
}

// With noise the cloth does not repeat with the material: the tiles of each copy count on from those before. Where a
// pixel does not resolve the cells of the intensity noise their mean is left, so that nothing sparkles.
WeavePoint cloth_place(SurfacePoint point, vec2 aside)
{
    vec2 cells = aside.x * point.sides.xy + aside.y * point.sides.zw;
    vec2 at = point.coordinate + cells / (weave_tiles * weave_texel(weave_table, 0).xy);
    vec2 coordinate = fract(at) * weave_tiles - weave_corner;
    if (!NOISE)
        return weave_locate(weave_table, coordinate, uvec2(0u));
    coordinate += floor(at) * ceil(weave_tiles);
    WeavePoint place = weave_locate(weave_table, coordinate, noise_seed);
    vec2 size = weave_yarn_texel(weave_table, place.yarn, 2).xy;
    float fineness = weave_texel(weave_table, 1).x;
    if (fineness > 0.0)
        place.intensity = mix(place.intensity, 1.0, fade_at(point.level - log2(min(size.x, size.y) / fineness)));
    return place;
}

// Over pi, times the light, of the yarns at one place.
vec3 place_radiance(SurfacePoint point, vec2 aside)
{
    WeavePoint place = cloth_place(point, aside);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        vec3 irradiance = surface_irradiance(point, i);
        if (irradiance != vec3(0.0))
            sum += irradiance * weave_brdf(weave_table, place, surface_light(point, i), point.view);
    }
    return sum;
}

// The mean of places on a grid across the footprint, or of a few places anywhere in it.
vec3 yarn_radiance(SurfacePoint point)
{
    vec3 sum = vec3(0.0);
    if (STOCHASTIC) {
        vec2 first = vec2(point.chance, 113.0 * point.chance);
        for (int i = 0; i < chosen_places; i++)
            sum += place_radiance(point, fract(first + float(i) * vec2(0.75487767, 0.56984029)) - 0.5);
        return sum / float(chosen_places);
    }
    ivec2 count = places_of(point);
    for (int i = 0; i < count.x * count.y; i++)
        sum += place_radiance(point, (vec2(i % count.x, i / count.x) + 0.5) / vec2(count) - 0.5);
    return sum / float(count.x * count.y);
}

vec3 mean_radiance(SurfacePoint point)
{
    int kinds = textureSize(weave_means, 0).y;
    vec3 diffuse = weave_mean_diffuse(weave_means);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        vec3 irradiance = surface_irradiance(point, i);
        vec3 light = surface_light(point, i);
        vec3 value = light.z > 0.0 ? diffuse : vec3(0.0);
        int count = irradiance != vec3(0.0) ? kinds : 0;
        for (int k = 0; k < count; k++)
            value += weave_mean_of_kind(weave_means, weave_kind(weave_means, k), light, point.view);
        sum += irradiance * value;
    }
    return sum;
}

vec4 radiance(SurfacePoint point)
{
    float fade = fade_at(footprint_width(point));
    if (STOCHASTIC)
        fade = happens(point.chance, fade) ? 1.0 : 0.0;
    vec3 sum = vec3(0.0);
    if (fade > 0.0)
        sum += fade * mean_radiance(point);
    if (fade < 1.0)
        sum += (1.0 - fade) * yarn_radiance(point);
    return vec4(sum * WOVEN_PI, 1.0);
}

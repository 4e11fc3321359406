// Analytic cloth: the woven texture where a pixel resolves the yarns, the mean of the tile where it does not.
// Constant defined by player/draw/programs.c: NOISE.
// C twins: weft_weave_brdf and weft_weave_mean_brdf (tabulated, see player/texture/weave_texture.h).
uniform sampler2D weave_table;
uniform sampler2D weave_mean; // column: light, row: view; BRDF in 1/sr
uniform vec2 weave_tiles;     // for one material
uniform vec2 weave_corner;    // where a tile begins, tiles from that of the material
uniform uvec2 noise_seed;     // low and high bits

// log2 of the footprint in cells where the texture begins to fade, and where the mean is all there is.
const float FADE_BEGIN = -1.0;
const float FADE_END = 1.0;

vec3 mean_brdf(Corners lights, Corners views)
{
    vec3 sum = vec3(0.0);
    for (int v = 0; v < 3; v++) {
        for (int l = 0; l < 3; l++) {
            float weight = views.weight[v] * lights.weight[l];
            sum += weight * texelFetch(weave_mean, ivec2(lights.label[l], views.label[v]), 0).rgb;
        }
    }
    return sum;
}

float fade_at(float level)
{
    return clamp((level - FADE_BEGIN) / (FADE_END - FADE_BEGIN), 0.0, 1.0);
}

// With noise the cloth does not repeat with the material: the tiles of each copy count on from those before. Where a
// pixel does not resolve the cells of the intensity noise their mean is left, so that nothing sparkles.
WeavePoint cloth_place(SurfacePoint point)
{
    vec2 coordinate = fract(point.coordinate) * weave_tiles - weave_corner;
    if (!NOISE)
        return weave_locate(weave_table, coordinate, uvec2(0u));
    coordinate += floor(point.coordinate) * ceil(weave_tiles);
    WeavePoint place = weave_locate(weave_table, coordinate, noise_seed);
    vec2 size = weave_yarn_texel(weave_table, place.yarn, 2).xy;
    float fineness = weave_texel(weave_table, 1).x;
    if (fineness > 0.0)
        place.intensity = mix(place.intensity, 1.0, fade_at(point.level - log2(min(size.x, size.y) / fineness)));
    return place;
}

vec4 radiance(SurfacePoint point)
{
    float fade = fade_at(point.level);
    if (STOCHASTIC)
        fade = happens(point.chance, fade) ? 1.0 : 0.0;
    Corners views = find_corners(0, point.view);
    WeavePoint place = cloth_place(point);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        vec3 irradiance = surface_irradiance(point, i);
        if (irradiance == vec3(0.0))
            continue;
        vec3 light = surface_light(point, i);
        vec3 brdf = vec3(0.0);
        if (fade > 0.0)
            brdf = fade * mean_brdf(find_corners(0, light), views);
        if (fade < 1.0)
            brdf += (1.0 - fade) * weave_brdf(weave_table, place, light, point.view);
        sum += irradiance * brdf;
    }
    return vec4(sum * WOVEN_PI, 1.0);
}

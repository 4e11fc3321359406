// A tile of yarn segments: twin of reflectance/weave/locate.c and brdf.c.
// Needs woven.glsl before it, and a texture filled by weft_weave_table (its layout: reflectance/weave/shader_table.h).
// Common subset of GLSL 3.30 core and GLSL ES 3.00; needs highp float, int and sampler2D.

const int WEAVE_TABLE_WIDTH = 256;
const int WEAVE_TABLE_HEADER = 3;
const int WEAVE_TABLE_YARN = 6;
const uint WEAVE_STREAM_INTENSITY = 1u;
const uint WEAVE_STREAM_WARP = 2u;
const uint WEAVE_STREAM_WEFT = 3u;

struct WeavePoint {
    int yarn;
    vec2 place; // x, y in the frame of the segment, cells
    float umax_offset_rad;
    float intensity;
};

vec4 weave_texel(sampler2D table, int index)
{
    return texelFetch(table, ivec2(index % WEAVE_TABLE_WIDTH, index / WEAVE_TABLE_WIDTH), 0);
}

vec4 weave_yarn_texel(sampler2D table, int yarn, int part)
{
    return weave_texel(table, WEAVE_TABLE_HEADER + WEAVE_TABLE_YARN * yarn + part);
}

uint weave_mixed(uint x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

// `seed` holds the low and the high 32 bits.
uint weave_start(uvec2 seed, uint stream)
{
    return weave_mixed(weave_mixed(weave_mixed(stream) + seed.x) + seed.y);
}

uint weave_fold(uint hash, int value)
{
    return weave_mixed(hash + uint(value));
}

float weave_unit_interval(uint hash)
{
    return (float(hash >> 8) + 0.5) / 16777216.0;
}

// `quarter`: centre of the segment on the endless cloth, in quarters of a cell. `place`: in [0, 1]^2 of the segment.
float weave_intensity_noise(uvec2 seed, ivec2 quarter, bool warp, float fineness, vec2 place)
{
    uint hash = weave_start(seed, WEAVE_STREAM_INTENSITY);
    hash = weave_fold(weave_fold(hash, quarter.x), quarter.y);
    hash = weave_fold(hash, warp ? 1 : 0);
    ivec2 cell = ivec2(floor(place * fineness));
    hash = weave_fold(weave_fold(hash, cell.x), cell.y);
    return -log(weave_unit_interval(hash));
}

float weave_yarn_noise(uvec2 seed, ivec2 quarter, bool along_warp, float period)
{
    int yarn = (along_warp ? quarter.x : quarter.y) >> 2;
    float position = float(along_warp ? quarter.y : quarter.x) / 4.0 / period;
    float knot = floor(position);
    float t = position - knot;
    uint hash = weave_fold(weave_start(seed, along_warp ? WEAVE_STREAM_WARP : WEAVE_STREAM_WEFT), yarn);
    float before = 2.0 * weave_unit_interval(weave_fold(hash, int(knot))) - 1.0;
    float after = 2.0 * weave_unit_interval(weave_fold(hash, int(knot) + 1)) - 1.0;
    float fade = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    return 2.0 * (before * t + fade * (after * (t - 1.0) - before * t));
}

void weave_add_noise(sampler2D table, uvec2 seed, vec2 tile, vec2 tile_size, inout WeavePoint point)
{
    vec4 noise = weave_texel(table, 1);
    vec4 amplitude = weave_texel(table, 2);
    vec4 fibre = weave_yarn_texel(table, point.yarn, 1);
    vec4 size = weave_yarn_texel(table, point.yarn, 2);
    vec4 centre = weave_yarn_texel(table, point.yarn, 3);
    bool warp = centre.z > 0.5;
    vec2 middle = vec2(tile.x + centre.x, centre.y - tile.y) * tile_size;
    ivec2 quarter = ivec2(floor(4.0 * middle + 0.5));
    if (noise.y > 0.0) {
        vec2 share = warp ? amplitude.xy : amplitude.zw;
        float offset = share.x * weave_yarn_noise(seed, quarter, true, noise.y) +
                       share.y * weave_yarn_noise(seed, quarter, false, noise.y);
        float largest = weave_yarn_texel(table, point.yarn, 4).w;
        point.umax_offset_rad = clamp(fibre.z + offset, centre.w, largest) - fibre.z;
    }
    if (noise.x > 0.0)
        point.intensity = weave_intensity_noise(seed, quarter, warp, noise.x, point.place / size.xy + 0.5);
}

// Where a point of the cloth lies; `coordinate` = (U, V) in tile units. seed = (0, 0): no noise.
WeavePoint weave_locate(sampler2D table, vec2 coordinate, uvec2 seed)
{
    vec2 tile_size = weave_texel(table, 0).xy;
    vec2 down = vec2(coordinate.x, 1.0 - coordinate.y); // V counts upward, rows of the pattern downward
    vec2 tile = floor(down);
    vec2 local = (down - tile) * tile_size;
    ivec2 cell = min(ivec2(local), ivec2(tile_size) - 1);
    int index = cell.y * int(tile_size.x) + cell.x;
    int pattern_start = WEAVE_TABLE_HEADER + WEAVE_TABLE_YARN * int(weave_texel(table, 0).z);
    int yarn = int(weave_texel(table, pattern_start + index / 4)[index % 4]);
    vec4 centre = weave_yarn_texel(table, yarn, 3);
    vec2 d = local - vec2(centre.x, 1.0 - centre.y) * tile_size;
    WeavePoint point = WeavePoint(yarn, centre.z > 0.5 ? vec2(d.x, -d.y) : vec2(d.y, d.x), 0.0, 1.0);
    if (seed != uvec2(0u) && weave_yarn_texel(table, yarn, 2).w > 0.0)
        weave_add_noise(table, seed, tile, tile_size, point);
    return point;
}

Segment weave_segment(sampler2D table, int yarn)
{
    vec4 a = weave_yarn_texel(table, yarn, 0);
    vec4 b = weave_yarn_texel(table, yarn, 1);
    vec4 c = weave_yarn_texel(table, yarn, 2);
    float radius_share = weave_yarn_texel(table, yarn, 5).w;
    return Segment(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, radius_share);
}

// intensity aw T; light and view in the frame of the cloth.
float weave_specular(sampler2D table, WeavePoint point, vec3 light, vec3 view)
{
    float area_weight = weave_yarn_texel(table, point.yarn, 2).w;
    if (!(area_weight > 0.0))
        return 0.0;
    Segment segment = weave_segment(table, point.yarn);
    bool warp = weave_yarn_texel(table, point.yarn, 3).z > 0.5;
    vec3 l = warp ? light : vec3(-light.y, light.x, light.z);
    vec3 v = warp ? view : vec3(-view.y, view.x, view.z);
    return point.intensity * area_weight *
           prepared_texture(segment, segment.umax + point.umax_offset_rad, point.place, l, v);
}

// BRDF in 1/sr; 0 where either direction is below the horizon.
vec3 weave_brdf(sampler2D table, WeavePoint point, vec3 light, vec3 view)
{
    if (!(light.z > 0.0 && view.z > 0.0))
        return vec3(0.0);
    vec3 kd = weave_yarn_texel(table, point.yarn, 4).rgb;
    vec3 scaled_ks = weave_yarn_texel(table, point.yarn, 5).rgb;
    return kd / WOVEN_PI + scaled_ks * weave_specular(table, point, light, view);
}

// The compressed material: lobes with a view and a light table, evaluated per texel, then interpolated between texels
// and levels. C twin: weft_material_sample. All levels lie side by side in each texture (player/texture/mip_layout.h).
// Constants defined by player/draw/programs.c: LOBES, VIEW_TABLE, LIGHT_TABLE.
uniform usampler2DArray material_texel;      // packed, see player/texture/material_texture.h
uniform float lobe_share[3];                 // 1, or 0 to do without
uniform float view_table_share, light_table_share;

vec3 lobes_value(vec4 lobe[3 * LOBES + 2], vec3 light)
{
    vec3 value = vec3(0.0);
    for (int i = 0; i < 3 * LOBES; i++)
        value[i % 3] += lobe_share[i / 3] * lobe_power(dot(lobe[i].xyz, light), lobe[i].w);
    return value;
}

// Two signed fractions of 32767, the lower half first.
vec2 fractions_of(uint word)
{
    return vec2(ivec2(int(word) << 16, int(word)) >> 16) * (1.0 / 32767.0);
}

// Two half floats, the lower half first (unpackHalf2x16 is not in GLSL 3.30). A subnormal one counts steps of 2^-24: as a
// subnormal float it would be lost on devices that take those for 0.
vec2 halves_of(uint word)
{
    ivec2 bits = ivec2(int(word) << 16, int(word)) >> 16, magnitude = bits & 0x7fff;
    vec2 normal = intBitsToFloat((magnitude << 13) + 0x38000000), steps = vec2(magnitude) * 5.9604644775390625e-8;
    vec2 value = mix(normal, steps, lessThan(magnitude, ivec2(0x400)));
    return intBitsToFloat(floatBitsToInt(value) | (bits & int(0x80000000u)));
}

// `texel` is its middle, in sizes of the texture.
vec4 texel_value(vec2 texel, SurfacePoint point, Entries views)
{
    uvec4 base = textureLod(material_texel, vec3(texel, 0.0), 0.0);
    mat3 axes = axes_of_quaternion(vec4(fractions_of(base.x), fractions_of(base.y))); // in those of the surface
    vec3 view = point.view * axes;
    vec2 blue_and_ceiling = halves_of(base.w);
    vec3 diffuse = vec3(halves_of(base.z), blue_and_ceiling.x);
    vec4 lobe[3 * LOBES + 2];
    for (int i = 0; i < 3 * LOBES; i += 2) {
        uvec4 pair = textureLod(material_texel, vec3(texel, float(1 + i / 2)), 0.0);
        lobe[i] = vec4(vec3(halves_of(pair.x), halves_of(pair.y).x) * view, halves_of(pair.y).y);
        lobe[i + 1] = vec4(vec3(halves_of(pair.z), halves_of(pair.w).x) * view, halves_of(pair.w).y);
    }
    // One light is turned into the axes of the surface, once for all texels; for many, the axes of the texel into the
    // world.
    axes = ONE_LIGHT ? axes : point.axes * axes;
    vec4 table = vec4(1.0);
    if (VIEW_TABLE)
        table = table_value(material_table, texel, views);
    vec3 of_view = mix(vec3(1.0), table.rgb, view_table_share), sum = vec3(0.0);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        vec3 irradiance = surface_irradiance(point, i);
        if (irradiance == vec3(0.0))
            continue;
        vec3 light = ONE_LIGHT ? surface_light(point, i) : world_light(i);
        vec3 value = of_view * (diffuse + lobes_value(lobe, light * axes));
        if (LIGHT_TABLE) {
            Entries lights = table_entries(find_corners(1, surface_light(point, i)), light_table_columns);
            value *= mix(vec3(1.0), table_value(material_light_table, texel, lights).rgb, light_table_share);
        }
        sum += irradiance * under_ceiling(value, blue_and_ceiling.y);
    }
    return vec4(sum, table.a);
}

vec4 level_value(int level, SurfacePoint point, Entries views)
{
    vec4 area = level_area[level];
    // Wrapped before it is scaled, so that far repeats keep their precision. Row 0 is the top: v near 1.
    vec2 position = fract(vec2(point.coordinate.x, -point.coordinate.y)) * area.zw - 0.5;
    vec2 corner = floor(position);
    vec2 share = position - corner;
    vec2 low = (area.xy + mod(corner, area.zw) + 0.5) * texel_step;
    vec2 high = (area.xy + mod(corner + 1.0, area.zw) + 0.5) * texel_step;
    if (STOCHASTIC) {
        bool right = happens(point.chance, share.x);
        bool below = happens(point.chance, share.y);
        return texel_value(vec2(right ? high.x : low.x, below ? high.y : low.y), point, views);
    }
    vec4 top = mix(texel_value(low, point, views), texel_value(vec2(high.x, low.y), point, views), share.x);
    vec4 bottom = mix(texel_value(vec2(low.x, high.y), point, views), texel_value(high, point, views), share.x);
    return mix(top, bottom, share.y);
}

// The part of the cloth, as it is seen, that is no hole.
float opacity(SurfacePoint point)
{
    if (!VIEW_TABLE)
        return 1.0;
    float level = clamp(point.level, 0.0, float(level_count - 1));
    Entries views = table_entries(find_corners(0, point.view), table_columns);
    return opacity_between(int(level), fract(level), point.coordinate, views);
}

vec4 radiance(SurfacePoint point)
{
    Entries views;
    if (VIEW_TABLE)
        views = table_entries(find_corners(0, point.view), table_columns);
    float level = clamp(point.level, 0.0, float(level_count - 1));
    int fine = int(level);
    float share = level - float(fine);
    if (STOCHASTIC)
        return level_value(happens(point.chance, share) ? fine + 1 : fine, point, views);
    vec4 value = level_value(fine, point, views);
    if (share > 0.0)
        value = mix(value, level_value(fine + 1, point, views), share);
    return value;
}

// The compressed material: lobes with a view and a light table, evaluated per texel, then interpolated between texels
// and levels. C twin: weft_material_sample. All levels lie side by side in each texture (player/mip_layout.h).
// Constants defined by player/programs.c: LOBES, VIEW_TABLE, LIGHT_TABLE.
uniform usampler2DArray material_texel;      // packed, see player/material_texture.h
uniform sampler2DArray material_table;       // views in columns, then layers
uniform sampler2DArray material_light_table; // lights alike
uniform bool lobe_on[3];
uniform float view_table_share, light_table_share; // 1, or 0 to do without
uniform float table_steps;                         // 255, or fewer to see T and S in fewer bits
uniform int level_count;
uniform ivec2 table_tiles; // columns and their width
uniform ivec2 light_table_tiles;
uniform ivec4 level_area[16]; // x, y, width, height

vec3 table_coded(vec3 code)
{
    code = floor(code * table_steps + 0.5) / table_steps;
    return code * code;
}

vec4 table_value(ivec2 texel, Corners views)
{
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 3; i++) {
        int layer = views.label[i] / table_tiles.x;
        int column = views.label[i] - layer * table_tiles.x;
        vec4 code = texelFetch(material_table, ivec3(texel.x + column * table_tiles.y, texel.y, layer), 0);
        sum += views.weight[i] * vec4(table_coded(code.rgb), code.a);
    }
    return vec4(mix(vec3(1.0), sum.rgb, view_table_share), sum.a);
}

vec3 light_table_value(ivec2 texel, Corners lights)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 3; i++) {
        int layer = lights.label[i] / light_table_tiles.x;
        int column = lights.label[i] - layer * light_table_tiles.x;
        ivec3 place = ivec3(texel.x + column * light_table_tiles.y, texel.y, layer);
        sum += lights.weight[i] * table_coded(texelFetch(material_light_table, place, 0).rgb);
    }
    return mix(vec3(1.0), sum, light_table_share);
}

vec3 lobes_value(vec4 lobe[3 * LOBES + 2], vec3 light)
{
    vec3 value = vec3(0.0);
    for (int i = 0; i < 3 * LOBES; i++)
        value[i % 3] += lobe_power(dot(lobe[i].xyz, light), lobe[i].w);
    return value;
}

// Two signed fractions of 32767, the lower half first.
vec2 fractions_of(uint word)
{
    return vec2(ivec2(int(word) << 16, int(word)) >> 16) / 32767.0;
}

// Two half floats, the lower half first (unpackHalf2x16 is not in GLSL 3.30).
vec2 halves_of(uint word)
{
    uvec2 bits = uvec2(word, word >> 16);
    return uintBitsToFloat((bits & 0x8000u) << 16 | (bits & 0x7fffu) << 13) * 5.192296858534828e33;
}

vec4 texel_value(ivec2 texel, SurfacePoint point, Corners views)
{
    uvec4 base = texelFetch(material_texel, ivec3(texel, 0), 0);
    mat3 axes = axes_of_quaternion(vec4(fractions_of(base.x), fractions_of(base.y))); // in those of the surface
    vec3 view = point.view * axes;
    vec3 diffuse = vec3(halves_of(base.z), halves_of(base.w).x);
    vec4 lobe[3 * LOBES + 2];
    for (int i = 0; i < 3 * LOBES; i += 2) {
        uvec4 pair = texelFetch(material_texel, ivec3(texel, 1 + i / 2), 0);
        lobe[i] = vec4(vec3(halves_of(pair.x), halves_of(pair.y).x) * view, halves_of(pair.y).y);
        lobe[i + 1] = vec4(vec3(halves_of(pair.z), halves_of(pair.w).x) * view, halves_of(pair.w).y);
    }
    for (int i = 0; i < 3 * LOBES; i++)
        lobe[i] = lobe_on[i / 3] ? lobe[i] : vec4(0.0, 0.0, 0.0, 1.0);
    axes = point.axes * axes;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        vec3 irradiance = surface_irradiance(point, i);
        if (irradiance == vec3(0.0))
            continue;
        if (LIGHT_TABLE)
            irradiance *= light_table_value(texel, find_corners(1, surface_light(point, i)));
        sum += irradiance * (diffuse + lobes_value(lobe, world_light(i) * axes));
    }
    vec4 table = VIEW_TABLE ? table_value(texel, views) : vec4(1.0);
    return vec4(sum * table.rgb, table.a);
}

vec4 level_value(int level, SurfacePoint point, Corners views)
{
    ivec4 area = level_area[level];
    vec2 size = vec2(area.zw);
    // Wrapped before it is scaled, so that far repeats keep their precision. Row 0 is the top: v near 1.
    vec2 position = fract(vec2(point.coordinate.x, -point.coordinate.y)) * size - 0.5;
    vec2 corner = floor(position);
    vec2 share = position - corner;
    ivec2 low = ivec2(mod(corner, size));
    ivec2 high = ivec2(mod(corner + 1.0, size));
    ivec2 origin = area.xy;
    if (STOCHASTIC) {
        bool right = happens(point.chance, share.x);
        bool below = happens(point.chance, share.y);
        return texel_value(origin + ivec2(right ? high.x : low.x, below ? high.y : low.y), point, views);
    }
    vec4 top = mix(texel_value(origin + low, point, views),
                   texel_value(origin + ivec2(high.x, low.y), point, views), share.x);
    vec4 bottom = mix(texel_value(origin + ivec2(low.x, high.y), point, views),
                      texel_value(origin + high, point, views), share.x);
    return mix(top, bottom, share.y);
}

vec4 radiance(SurfacePoint point)
{
    Corners views = Corners(ivec3(0), vec3(1.0, 0.0, 0.0));
    if (VIEW_TABLE)
        views = find_corners(0, point.view);
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

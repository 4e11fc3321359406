// The compressed material: lobes and view table, evaluated per texel, then interpolated between texels and levels.
// C twin: weft_material_sample. All levels lie side by side in each texture (player/mip_layout.h).
uniform isampler2D material_frame;
uniform sampler2D material_diffuse;
uniform sampler2DArray material_lobe;  // layer = 3 lobe + channel
uniform sampler2DArray material_table; // views in columns, then layers
uniform int lobe_count;
uniform int level_count;
uniform bool has_table;
uniform ivec2 table_tiles;       // columns and their width
uniform ivec4 level_area[16];    // x, y, width, height

vec4 table_value(ivec2 texel, Corners views)
{
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 3; i++) {
        int layer = views.label[i] / table_tiles.x;
        int column = views.label[i] - layer * table_tiles.x;
        vec4 code = texelFetch(material_table, ivec3(texel.x + column * table_tiles.y, texel.y, layer), 0);
        sum += views.weight[i] * vec4(code.rgb * code.rgb, code.a);
    }
    return sum;
}

vec4 texel_value(ivec2 texel, vec3 light, vec3 view, Corners views)
{
    Frame frame = frame_decode(texelFetch(material_frame, texel, 0).xyz);
    vec3 l = frame_local(frame, light);
    vec3 v = frame_local(frame, view);
    vec3 value = texelFetch(material_diffuse, texel, 0).rgb;
    for (int lobe = 0; lobe < lobe_count; lobe++) {
        for (int channel = 0; channel < 3; channel++)
            value[channel] += lobe_value(texelFetch(material_lobe, ivec3(texel, 3 * lobe + channel), 0), l, v);
    }
    vec4 table = has_table ? table_value(texel, views) : vec4(1.0);
    return vec4(value * table.rgb, table.a);
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
    vec4 top = mix(texel_value(origin + low, point.light, point.view, views),
                   texel_value(origin + ivec2(high.x, low.y), point.light, point.view, views), share.x);
    vec4 bottom = mix(texel_value(origin + ivec2(low.x, high.y), point.light, point.view, views),
                      texel_value(origin + high, point.light, point.view, views), share.x);
    return mix(top, bottom, share.y);
}

vec4 reflectance(SurfacePoint point)
{
    Corners views = Corners(ivec3(0), vec3(1.0, 0.0, 0.0));
    if (has_table)
        views = find_corners(0, point.view);
    float level = clamp(point.level, 0.0, float(level_count - 1));
    int fine = int(level);
    vec4 value = level_value(fine, point, views);
    float share = level - float(fine);
    if (share > 0.0)
        value = mix(value, level_value(fine + 1, point, views), share);
    return value;
}

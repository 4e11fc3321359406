// The compressed material: lobes with a view and a light table, evaluated per texel, then interpolated between texels and levels.
// C twin: weft_material_sample. All levels lie side by side in each texture (player/mip_layout.h).
uniform isampler2D material_frame;
uniform sampler2D material_diffuse;
uniform sampler2DArray material_lobe;  // layer = 3 lobe + channel
uniform sampler2DArray material_table; // views in columns, then layers
uniform sampler2DArray material_light_table; // lights alike
uniform int lobe_count;
uniform int level_count;
uniform bool has_table;
uniform bool has_light_table;
uniform ivec2 table_tiles;       // columns and their width
uniform ivec2 light_table_tiles;
uniform ivec4 level_area[16];    // x, y, width, height

// What is the same for all texels under one light and view.
struct TableCorners {
    Corners view, light;
};

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

vec3 light_table_value(ivec2 texel, Corners lights)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 3; i++) {
        int layer = lights.label[i] / light_table_tiles.x;
        int column = lights.label[i] - layer * light_table_tiles.x;
        ivec3 place = ivec3(texel.x + column * light_table_tiles.y, texel.y, layer);
        vec3 code = texelFetch(material_light_table, place, 0).rgb;
        sum += lights.weight[i] * code * code;
    }
    return sum;
}

vec4 texel_value(ivec2 texel, vec3 light, vec3 view, TableCorners corners)
{
    Frame frame = frame_decode(texelFetch(material_frame, texel, 0).xyz);
    vec3 l = frame_local(frame, light);
    vec3 v = frame_local(frame, view);
    vec3 value = texelFetch(material_diffuse, texel, 0).rgb;
    for (int lobe = 0; lobe < lobe_count; lobe++) {
        for (int channel = 0; channel < 3; channel++)
            value[channel] += lobe_value(texelFetch(material_lobe, ivec3(texel, 3 * lobe + channel), 0), l, v);
    }
    vec4 table = has_table ? table_value(texel, corners.view) : vec4(1.0);
    vec3 lit = has_light_table ? light_table_value(texel, corners.light) : vec3(1.0);
    return vec4(value * lit * table.rgb, table.a);
}

vec4 level_value(int level, SurfacePoint point, TableCorners corners)
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
    vec4 top = mix(texel_value(origin + low, point.light, point.view, corners),
                   texel_value(origin + ivec2(high.x, low.y), point.light, point.view, corners), share.x);
    vec4 bottom = mix(texel_value(origin + ivec2(low.x, high.y), point.light, point.view, corners),
                      texel_value(origin + high, point.light, point.view, corners), share.x);
    return mix(top, bottom, share.y);
}

vec4 reflectance(SurfacePoint point)
{
    Corners first = Corners(ivec3(0), vec3(1.0, 0.0, 0.0));
    TableCorners corners = TableCorners(first, first);
    if (has_table)
        corners.view = find_corners(0, point.view);
    if (has_light_table)
        corners.light = find_corners(1, point.light);
    float level = clamp(point.level, 0.0, float(level_count - 1));
    int fine = int(level);
    vec4 value = level_value(fine, point, corners);
    float share = level - float(fine);
    if (share > 0.0)
        value = mix(value, level_value(fine + 1, point, corners), share);
    return value;
}

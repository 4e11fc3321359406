// The tables T and S of a material, and its opacity, which is coded in T. All levels lie side by side in each texture
// (player/texture/mip_layout.h).
// Fetched by textureLod at the middle of texels: software rasterisers take longer over texelFetch, which may name a
// level.
uniform sampler2DArray material_table;       // views in columns, then components
uniform sampler2DArray material_light_table; // lights alike
uniform int level_count;
uniform vec2 texel_step; // 1 / size of the texture of all levels
uniform float table_columns, light_table_columns;
uniform vec4 level_area[16]; // x, y, width, height

// Where three entries of a table are: the tile, in widths of the texture, and the layer.
struct Entries {
    vec3 column, layer, weight;
    float tile;
};

Entries table_entries(Corners corners, float columns)
{
    vec3 label = vec3(corners.label);
    vec3 layer = floor((label + 0.5) / columns);
    return Entries(label / columns - layer, layer, corners.weight, 1.0 / columns);
}

vec4 table_value(sampler2DArray table, vec2 texel, Entries entries)
{
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 3; i++) {
        vec2 place = vec2(texel.x * entries.tile + entries.column[i], texel.y);
        vec4 code = textureLod(table, vec3(place, entries.layer[i]), 0.0);
        sum += entries.weight[i] * vec4(code.rgb * code.rgb, code.a);
    }
    return sum;
}

float opacity_of_level(int level, vec2 coordinate, Entries views)
{
    vec4 area = level_area[level];
    vec2 position = fract(vec2(coordinate.x, -coordinate.y)) * area.zw - 0.5;
    vec2 corner = floor(position), share = position - corner;
    vec2 low = (area.xy + mod(corner, area.zw) + 0.5) * texel_step;
    vec2 high = (area.xy + mod(corner + 1.0, area.zw) + 0.5) * texel_step;
    float top = mix(table_value(material_table, low, views).a,
                    table_value(material_table, vec2(high.x, low.y), views).a, share.x);
    float bottom = mix(table_value(material_table, vec2(low.x, high.y), views).a,
                       table_value(material_table, high, views).a, share.x);
    return mix(top, bottom, share.y);
}

// Between that level and the next.
float opacity_between(int level, float share, vec2 coordinate, Entries views)
{
    float opacity = opacity_of_level(level, coordinate, views);
    return share > 0.0 ? mix(opacity, opacity_of_level(level + 1, coordinate, views), share) : opacity;
}

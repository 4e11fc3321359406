// The compressed material: linear layers. Coefficients are interpolated by the hardware between texels, the maps of the
// factors between directions, and both are multiplied once a pixel and light. C twin: weft_layers_sample.
// Constants defined by player/draw/programs.c: LAYER_GROUPS, four layers each; HALF_VECTOR, whether the maps are over it;
// OPACITY, whether there is any below 1.
uniform sampler2DArray layer_coefficient; // of a group in each layer, all levels side by side; -1 .. 1
uniform sampler2D layer_ceiling;          // codes, all levels side by side
// Factors of a group: x: light nodes, for red, green and blue in turn; y: light nodes, group after group; z: view nodes,
// row after row.
uniform highp sampler3D layer_map;
uniform int layer_groups; // that are evaluated
uniform vec2 layer_sides; // nodes along a side, of lights and of views
uniform vec2 layer_step, ceiling_step; // 1 / size of the textures
uniform vec4 layer_area[16], ceiling_area[16];
uniform float least_cosine;

void add_coefficients(int level, vec2 coordinate, float weight, inout vec4 sum[LAYER_GROUPS])
{
    // After the last texel of a row or column comes the first one.
    vec4 area = layer_area[level];
    vec2 place = area.xy + 0.5 + fract(vec2(coordinate.x, -coordinate.y) - 0.5 / area.zw) * area.zw;
    for (int i = 0; i < LAYER_GROUPS; i++) {
        if (i < layer_groups)
            sum[i] += weight * textureLod(layer_coefficient, vec3(place * layer_step, float(i)), 0.0);
    }
}

float ceiling_at(int level, vec2 coordinate)
{
    vec2 size = layer_area[level].zw;
    vec2 texel = floor(fract(vec2(coordinate.x, -coordinate.y)) * size);
    vec2 place = ceiling_area[level].xy + floor(min(texel, size - 1.0) / 8.0) + 0.5;
    return exp2((255.0 * textureLod(layer_ceiling, place * ceiling_step, 0.0).r - 192.0) / 8.0);
}

// Reflectance times cosine, for directions above the horizon. STOCHASTIC takes one of the two rows of view nodes.
vec3 layers_value(vec4 coefficient[LAYER_GROUPS], vec3 light, vec3 view, inout float chance)
{
    vec3 half_vector = half_vector_of(light, view);
    vec2 inner = (HALF_VECTOR ? place_of_half_vector(half_vector) : place_of_direction(light));
    vec2 outer = place_of_direction(view) * (layer_sides.y - 1.0);
    inner = inner * (layer_sides.x - 1.0) + 0.5;
    float row = min(floor(outer.y), layer_sides.y - 2.0), share = outer.y - row;
    float rows = 1.0 / layer_sides.y;
    if (STOCHASTIC)
        row += happens(chance, share) ? 1.0 : 0.0;
    float low = (row + (outer.x + 0.5) * rows) * rows, high = low + rows;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LAYER_GROUPS; i++) {
        if (i >= layer_groups)
            break;
        for (int c = 0; c < 3; c++) {
            vec2 node = inner + vec2(float(c), float(i)) * layer_sides.x;
            vec2 place = node / (layer_sides.x * vec2(3.0, float(LAYER_GROUPS)));
            vec4 factor = textureLod(layer_map, vec3(place, low), 0.0);
            if (!STOCHASTIC)
                factor = mix(factor, textureLod(layer_map, vec3(place, high), 0.0), share);
            sum[c] += dot(coefficient[i], factor);
        }
    }
    return HALF_VECTOR ? sum / max(dot(light, half_vector), 0.0625) : sum;
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

vec4 radiance(SurfacePoint point)
{
    float level = clamp(point.level, 0.0, float(level_count - 1));
    int fine = int(level);
    float share = level - float(fine);
    if (STOCHASTIC) {
        fine = happens(point.chance, share) ? fine + 1 : fine;
        share = 0.0;
    }
    vec4 coefficient[LAYER_GROUPS];
    for (int i = 0; i < LAYER_GROUPS; i++)
        coefficient[i] = vec4(0.0);
    add_coefficients(fine, point.coordinate, 1.0 - share, coefficient);
    if (share > 0.0)
        add_coefficients(fine + 1, point.coordinate, share, coefficient);
    float ceiling = ceiling_at(fine, point.coordinate);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        vec3 irradiance = surface_irradiance(point, i), light = surface_light(point, i);
        if (irradiance == vec3(0.0) || light.z <= 0.0 || point.view.z <= 0.0)
            continue;
        vec3 most = vec3(ceiling * min(1.0, light.z / least_cosine));
        sum += irradiance / light.z * clamp(layers_value(coefficient, light, point.view, point.chance), vec3(0.0), most);
    }
    if (!OPACITY)
        return vec4(sum, 1.0);
    Entries views = table_entries(find_corners(0, point.view), table_columns);
    float opacity = opacity_of_level(fine, point.coordinate, views);
    if (share > 0.0)
        opacity = mix(opacity, opacity_of_level(fine + 1, point.coordinate, views), share);
    return vec4(sum, opacity);
}

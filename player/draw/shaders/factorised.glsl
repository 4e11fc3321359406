// The compressed material: components. Coefficients are interpolated by the hardware between texels, the maps of the
// factors between directions, and both are multiplied once a pixel and light. C twin: weft_components_sample_through.
// Constants defined by player/draw/programs.c: COMPONENT_GROUPS, four components each; DRAWN_GROUPS, the first of them, which are
// evaluated; OVER_HALF_VECTOR, whether maps are over it, else over the light; KRIGED, whether maps are: then values may be coded;
// OPACITY, whether there is any below 1; RELIEF, whether it is all seen through heights (reflectance/relief/relief.glsl):
// then from the stored views around, each at a place of its own.
uniform sampler2DArray component_coefficient; // of a group in each layer, all levels side by side; -1 .. 1
uniform sampler2D component_bounds;           // codes of floors and of the ceiling, all levels side by side
// Factors of a group: x: light nodes, for red, green and blue in turn; y: light nodes, group after group; z: view nodes,
// row after row.
uniform highp sampler3D component_map;
uniform highp sampler2DArray layer_map_of_view; // the same of every stored view by itself
uniform sampler2D layer_view;              // of every stored view: direction, entry in the table of views
uniform vec2 component_sides; // nodes along a side, of lights and of views
uniform vec2 component_step, bounds_step; // 1 / size of the textures
uniform vec4 component_area[16], bounds_area[16];
uniform float least_cosine;
uniform vec4 component_powers; // of l . h, of l_z, of coded values; the least l . h

void add_coefficients(int level, vec2 coordinate, float weight, inout vec4 sum[DRAWN_GROUPS])
{
    // After the last texel of a row or column comes the first one.
    vec4 area = component_area[level];
    vec2 place = area.xy + 0.5 + fract(vec2(coordinate.x, -coordinate.y) - 0.5 / area.zw) * area.zw;
    for (int i = 0; i < DRAWN_GROUPS; i++)
        sum[i] += weight * textureLod(component_coefficient, vec3(place * component_step, float(i)), 0.0);
}

// Floors of red, green and blue, and the ceiling, of the nearest texel.
vec4 bounds_at(int level, vec2 coordinate)
{
    vec2 size = component_area[level].zw;
    vec2 texel = floor(fract(vec2(coordinate.x, -coordinate.y)) * size);
    vec2 place = bounds_area[level].xy + floor(min(texel, size - 1.0) / 8.0) + 0.5;
    vec4 code = floor(255.0 * textureLod(component_bounds, place * bounds_step, 0.0) + 0.5);
    vec3 octave = floor(code.rgb / 16.0);
    vec3 least = exp2(octave - 13.0) * (1.0 + (code.rgb - 16.0 * octave) / 16.0) * step(0.5, code.rgb);
    return vec4(least, exp2((code.a - 192.0) / 8.0));
}

// Where a light is in the maps, in nodes.
vec2 inner_node(vec3 light, vec3 half_vector)
{
    vec2 place = OVER_HALF_VECTOR ? place_of_half_vector(half_vector) : place_of_direction(light);
    return place * (component_sides.x - 1.0) + 0.5;
}

// Twin of weft_components_divisor, but of decoded values.
float map_divisor(vec3 light, vec3 half_vector)
{
    float incidence = max(dot(light, half_vector), component_powers.w), cosine = max(light.z, 0.015625);
    return OVER_HALF_VECTOR ? pow(incidence, component_powers.x) * pow(cosine, component_powers.y) : 1.0;
}

vec3 decoded(vec3 sum, float divisor)
{
    return (KRIGED ? pow(max(sum, vec3(0.0)), vec3(component_powers.z)) : sum) / divisor;
}

// Channels of kriged maps are scaled down alike, so that what is too bright keeps its hue.
vec3 clamped(vec3 value, vec4 bounds, float light_z)
{
    value = max(value, bounds.rgb * light_z);
    float most = bounds.a * min(1.0, light_z / least_cosine), brightest = max(value.r, max(value.g, value.b));
    if (!KRIGED)
        return min(value, vec3(most));
    return brightest > most ? value * (most / brightest) : value;
}

vec2 map_place(vec2 inner, int group, int colour)
{
    vec2 node = inner + vec2(float(colour), float(group)) * component_sides.x;
    return node / (component_sides.x * vec2(3.0, float(COMPONENT_GROUPS)));
}

// Reflectance times cosine, for directions above the horizon. STOCHASTIC takes one of the two rows of view nodes.
vec3 components_value(vec4 coefficient[DRAWN_GROUPS], vec3 light, vec3 view, inout float chance)
{
    vec3 half_vector = half_vector_of(light, view);
    vec2 inner = inner_node(light, half_vector);
    vec2 outer = place_of_direction(view) * (component_sides.y - 1.0);
    float row = min(floor(outer.y), component_sides.y - 2.0), share = outer.y - row;
    float rows = 1.0 / component_sides.y;
    if (STOCHASTIC)
        row += happens(chance, share) ? 1.0 : 0.0;
    float low = (row + (outer.x + 0.5) * rows) * rows, high = low + rows;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < DRAWN_GROUPS; i++) {
        for (int c = 0; c < 3; c++) {
            vec2 place = map_place(inner, i, c);
            vec4 factor = textureLod(component_map, vec3(place, low), 0.0);
            if (!STOCHASTIC)
                factor = mix(factor, textureLod(component_map, vec3(place, high), 0.0), share);
            sum[c] += dot(coefficient[i], factor);
        }
    }
    return decoded(sum, map_divisor(light, half_vector));
}

// The same as stored view `number` has it.
vec3 components_value_of_view(vec4 coefficient[DRAWN_GROUPS], vec3 light, int number, vec3 view)
{
    vec3 half_vector = half_vector_of(light, view), sum = vec3(0.0);
    vec2 inner = inner_node(light, half_vector);
    for (int i = 0; i < DRAWN_GROUPS; i++) {
        for (int c = 0; c < 3; c++)
            sum[c] += dot(coefficient[i], textureLod(layer_map_of_view, vec3(map_place(inner, i, c), float(number)), 0.0));
    }
    return decoded(sum, map_divisor(light, half_vector));
}

// Of `point` at a place: if `stored` as stored view `number` saw it from its direction `view`, else as seen from there.
// Both are evaluated where pixels differ: software rasterisers run both sides of a branch anyway, and a loop of one round
// or none in its place takes longer than both. Where `stored` is a constant, compilers drop the other.
vec4 radiance_at(SurfacePoint point, vec2 coordinate, bool stored, int number, vec3 view, Entries views, int fine,
                 float share)
{
    vec4 coefficient[DRAWN_GROUPS];
    for (int i = 0; i < DRAWN_GROUPS; i++)
        coefficient[i] = vec4(0.0);
    add_coefficients(fine, coordinate, 1.0 - share, coefficient);
    if (share > 0.0)
        add_coefficients(fine + 1, coordinate, share, coefficient);
    vec4 bounds = bounds_at(fine, coordinate);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        vec3 irradiance = surface_irradiance(point, i), light = surface_light(point, i);
        if (irradiance == vec3(0.0) || light.z <= 0.0 || view.z <= 0.0)
            continue;
        vec3 of_view = RELIEF ? components_value_of_view(coefficient, light, number, view) : vec3(0.0);
        vec3 between = components_value(coefficient, light, view, point.chance);
        vec3 value = stored ? of_view : between;
        sum += irradiance / light.z * clamped(value, bounds, light.z);
    }
    if (!OPACITY)
        return vec4(sum, 1.0);
    return vec4(sum, opacity_between(fine, share, coordinate, views));
}

// That of one stored view in the tables.
Entries view_entries(int number)
{
    float label = texelFetch(layer_view, ivec2(number, 0), 0).w;
    return table_entries(Corners(ivec3(int(label)), vec3(1.0, 0.0, 0.0)), table_columns);
}

vec4 radiance_of_tap(SurfacePoint point, int number, vec2 coordinate, int fine, float share)
{
    vec4 view = texelFetch(layer_view, ivec2(number, 0), 0);
    Entries views;
    if (OPACITY)
        views = view_entries(number);
    return radiance_at(point, coordinate, true, number, view.xyz, views, fine, share);
}

int chosen_tap(ReliefTap tap[3], inout float chance)
{
    float rest = tap[1].weight + tap[2].weight;
    bool first = happens(chance, tap[0].weight);
    bool second = happens(chance, rest > 0.0 ? tap[1].weight / rest : 1.0);
    return first ? 0 : second ? 1 : 2;
}

vec4 radiance_through_heights(SurfacePoint point, int fine, float share)
{
    Corners corners = find_corners(2, point.view);
    ReliefTap tap[3];
    relief_taps(1.0, point.coordinate, point.view, corners.label, corners.weight, tap);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 3; i++)
        sum += tap[i].weight * radiance_of_tap(point, corners.label[i], tap[i].coordinate, fine, share);
    return sum;
}

vec4 radiance_without_heights(SurfacePoint point, int fine, float share)
{
    Entries views;
    if (OPACITY)
        views = table_entries(find_corners(0, point.view), table_columns);
    return radiance_at(point, point.coordinate, false, 0, point.view, views, fine, share);
}

// One level and one view, stored or not, by chance. Heights are followed where none count, too.
vec4 chosen_radiance(SurfacePoint point, float through, int fine)
{
    bool stored = happens(point.chance, through);
    Corners corners = find_corners(stored ? 2 : 0, point.view);
    ReliefTap tap[3];
    relief_taps(1.0, point.coordinate, point.view, corners.label, corners.weight, tap);
    float chance = point.chance;
    int chosen = chosen_tap(tap, chance), number = corners.label[chosen];
    vec2 coordinate = point.coordinate;
    vec4 view = vec4(point.view, 0.0);
    if (stored) {
        coordinate = tap[chosen].coordinate;
        view = texelFetch(layer_view, ivec2(number, 0), 0);
        corners = Corners(ivec3(int(view.w)), vec3(1.0, 0.0, 0.0));
    }
    Entries entries;
    if (OPACITY)
        entries = table_entries(corners, table_columns);
    return radiance_at(point, coordinate, stored, number, view.xyz, entries, fine, 0.0);
}

// The part of the cloth, as it is seen, that is no hole.
float opacity(SurfacePoint point)
{
    float level = clamp(point.level, 0.0, float(level_count - 1));
    int fine = int(level);
    float share = level - float(fine), through = RELIEF ? relief_share(level) : 0.0;
    Entries views = table_entries(find_corners(0, point.view), table_columns);
    float sum = (1.0 - through) * opacity_between(fine, share, point.coordinate, views);
    if (!RELIEF)
        return sum;
    Corners corners = find_corners(2, point.view);
    ReliefTap tap[3];
    relief_taps(1.0, point.coordinate, point.view, corners.label, corners.weight, tap);
    for (int i = 0; i < 3; i++) {
        Entries stored = view_entries(corners.label[i]);
        sum += through * tap[i].weight * opacity_between(fine, share, tap[i].coordinate, stored);
    }
    return sum;
}

vec4 radiance(SurfacePoint point)
{
    float level = clamp(point.level, 0.0, float(level_count - 1));
    int fine = int(level);
    float share = level - float(fine), through = RELIEF ? relief_share(level) : 0.0;
    if (STOCHASTIC) {
        fine = happens(point.chance, share) ? fine + 1 : fine;
        share = 0.0;
        if (RELIEF)
            return chosen_radiance(point, through, fine);
    }
    if (!RELIEF)
        return radiance_without_heights(point, fine, share);
    vec4 sum = vec4(0.0);
    if (through > 0.0)
        sum += through * radiance_through_heights(point, fine, share);
    if (through < 1.0)
        sum += (1.0 - through) * radiance_without_heights(point, fine, share);
    return sum;
}

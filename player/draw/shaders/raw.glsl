// The measured samples: barycentric in views and, for each of the three views, in its lights; nine bilinear fetches.
// Every image is a tile with all its levels, and so is the opacity of every view (player/raw/plan.h).
// Constants defined by player/draw/programs.c: OPACITY, whether there is any below 1; RELIEF, whether it is all seen
// through heights (reflectance/relief/relief.glsl): each view then at a place of its own.
uniform sampler2DArray raw_sample, raw_opacity;
uniform int level_count;
uniform ivec2 raw_tiles, opacity_tiles;           // components, and width of a tile
uniform vec2 raw_atlas_size, opacity_atlas_size;  // texels
uniform vec4 level_area[16];                      // x, y, width, height

// Where a pixel lies in any tile at a level, in texels. After the last texel of a row or column comes the first one.
vec2 place_in_tile(int level, vec2 coordinate)
{
    vec4 area = level_area[level];
    return area.xy + 0.5 + fract(vec2(coordinate.x, -coordinate.y) - 0.5 / area.zw) * area.zw;
}

// Texture coordinates and layer.
vec3 place_in_tiles(ivec2 tiles, vec2 atlas_size, int tile, vec2 place)
{
    int column = int((float(tile) + 0.5) / float(tiles.x));
    return vec3((place + vec2(float(column * tiles.y), 0.0)) / atlas_size, float(tile - column * tiles.x));
}

vec3 image_value(int image, vec2 place)
{
    return textureLod(raw_sample, place_in_tiles(raw_tiles, raw_atlas_size, image, place), 0.0).rgb;
}

// `view` is the label of one, counted from 1.
float opacity_value(int view, vec2 place)
{
    return textureLod(raw_opacity, place_in_tiles(opacity_tiles, opacity_atlas_size, view - 1, place), 0.0).r;
}

vec3 corners_value(vec2 place, Corners lights)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 3; i++) {
        if (lights.weight[i] > 0.0)
            sum += lights.weight[i] * image_value(lights.label[i], place);
    }
    return sum;
}

vec3 trilinear_value(vec3 light, ReliefTap tap[3], Corners views, int fine, float share)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 3; i++) {
        if (views.weight[i] == 0.0)
            continue;
        vec2 place = place_in_tile(fine, tap[i].coordinate), above = place_in_tile(fine + 1, tap[i].coordinate);
        Corners lights = find_corners(views.label[i], light);
        vec3 value = corners_value(place, lights);
        if (share > 0.0)
            value = mix(value, corners_value(above, lights), share);
        sum += views.weight[i] * value;
    }
    return sum;
}

int chosen_corner(vec3 weight, inout float chance)
{
    if (happens(chance, weight.x))
        return 0;
    float rest = weight.y + weight.z;
    return happens(chance, rest > 0.0 ? weight.y / rest : 1.0) ? 1 : 2;
}

vec3 chosen_value(vec3 light, ReliefTap tap[3], Corners views, int fine, float share, float chance)
{
    int level = happens(chance, share) ? fine + 1 : fine;
    int view = chosen_corner(views.weight, chance);
    Corners lights = find_corners(views.label[view], light);
    int image = lights.label[chosen_corner(lights.weight, chance)];
    return image_value(image, place_in_tile(level, tap[view].coordinate));
}

float trilinear_opacity(ReliefTap tap[3], Corners views, int fine, float share)
{
    float sum = 0.0;
    for (int i = 0; i < 3; i++) {
        if (views.weight[i] == 0.0)
            continue;
        vec2 place = place_in_tile(fine, tap[i].coordinate), above = place_in_tile(fine + 1, tap[i].coordinate);
        float value = opacity_value(views.label[i], place);
        if (share > 0.0)
            value = mix(value, opacity_value(views.label[i], above), share);
        sum += views.weight[i] * value;
    }
    return sum;
}

float chosen_opacity(ReliefTap tap[3], Corners views, int fine, float share, float chance)
{
    int level = happens(chance, share) ? fine + 1 : fine;
    int view = chosen_corner(views.weight, chance);
    return opacity_value(views.label[view], place_in_tile(level, tap[view].coordinate));
}

// Where each view is read; through heights its weight changes, too.
void find_taps(SurfacePoint point, float level, inout Corners views, out ReliefTap tap[3])
{
    for (int i = 0; i < 3; i++)
        tap[i] = ReliefTap(point.coordinate, views.weight[i]);
    float share = RELIEF ? relief_share(level) : 0.0;
    if (share == 0.0)
        return;
    relief_taps(share, point.coordinate, point.view, views.label - 1, views.weight, tap);
    views.weight = vec3(tap[0].weight, tap[1].weight, tap[2].weight);
}

// The part of the cloth, as it is seen, that is no hole.
float opacity(SurfacePoint point)
{
    Corners views = find_corners(0, point.view);
    float level = clamp(point.level, 0.0, float(level_count - 1));
    int fine = int(level);
    ReliefTap tap[3];
    find_taps(point, level, views, tap);
    return STOCHASTIC ? chosen_opacity(tap, views, fine, level - float(fine), point.chance)
                      : trilinear_opacity(tap, views, fine, level - float(fine));
}

vec4 radiance(SurfacePoint point)
{
    Corners views = find_corners(0, point.view);
    float level = clamp(point.level, 0.0, float(level_count - 1));
    int fine = int(level);
    float share = level - float(fine);
    vec4 sum = vec4(0.0, 0.0, 0.0, 1.0);
    ReliefTap tap[3];
    find_taps(point, level, views, tap);
    if (OPACITY)
        sum.a = STOCHASTIC ? chosen_opacity(tap, views, fine, share, point.chance)
                           : trilinear_opacity(tap, views, fine, share);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        vec3 irradiance = surface_irradiance(point, i);
        if (irradiance == vec3(0.0))
            continue;
        vec3 light = surface_light(point, i);
        sum.rgb += irradiance * (STOCHASTIC ? chosen_value(light, tap, views, fine, share, point.chance)
                                            : trilinear_value(light, tap, views, fine, share));
        point.chance = fract(point.chance + 0.61803399);
    }
    return sum;
}

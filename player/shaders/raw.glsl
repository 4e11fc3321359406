// The measured samples: barycentric in views and, for each of the three views, in its lights; nine bilinear fetches.
// Every image is a tile with all its levels, each with a border of one texel (player/raw_texture.h).
uniform sampler2DArray raw_sample;
uniform int level_count;
uniform ivec2 raw_tiles;      // columns and their width
uniform vec2 raw_atlas_size;  // texels
uniform vec4 level_area[16];  // x, y, width, height

vec4 image_value(int image, int level, vec2 coordinate)
{
    vec4 area = level_area[level];
    vec2 position = area.xy + fract(vec2(coordinate.x, -coordinate.y)) * area.zw;
    int layer = image / raw_tiles.x;
    position.x += float((image - layer * raw_tiles.x) * raw_tiles.y);
    return textureLod(raw_sample, vec3(position / raw_atlas_size, float(layer)), 0.0);
}

vec4 corners_value(int level, vec2 coordinate, Corners lights)
{
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 3; i++) {
        if (lights.weight[i] > 0.0)
            sum += lights.weight[i] * image_value(lights.label[i], level, coordinate);
    }
    return sum;
}

vec4 trilinear_value(vec3 light, SurfacePoint point, Corners views, int fine, float share)
{
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 3; i++) {
        if (views.weight[i] == 0.0)
            continue;
        Corners lights = find_corners(views.label[i], light);
        vec4 value = corners_value(fine, point.coordinate, lights);
        if (share > 0.0)
            value = mix(value, corners_value(fine + 1, point.coordinate, lights), share);
        sum += views.weight[i] * value;
    }
    return sum;
}

int chosen_corner(Corners corners, inout float chance)
{
    if (happens(chance, corners.weight.x))
        return corners.label.x;
    float rest = corners.weight.y + corners.weight.z;
    return happens(chance, rest > 0.0 ? corners.weight.y / rest : 1.0) ? corners.label.y : corners.label.z;
}

vec4 chosen_value(vec3 light, SurfacePoint point, Corners views, int fine, float share)
{
    int level = happens(point.chance, share) ? fine + 1 : fine;
    int view = chosen_corner(views, point.chance);
    int image = chosen_corner(find_corners(view, light), point.chance);
    return image_value(image, level, point.coordinate);
}

// Opacity depends on the view alone; the first light tells it also where the surface is dark.
vec4 radiance(SurfacePoint point)
{
    Corners views = find_corners(0, point.view);
    float level = clamp(point.level, 0.0, float(level_count - 1));
    int fine = int(level);
    float share = level - float(fine);
    vec4 sum = vec4(0.0, 0.0, 0.0, 1.0);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        vec3 irradiance = surface_irradiance(point, i);
        if (i > 0 && irradiance == vec3(0.0))
            continue;
        vec3 light = surface_light(point, i);
        vec4 value = STOCHASTIC ? chosen_value(light, point, views, fine, share)
                                : trilinear_value(light, point, views, fine, share);
        sum = vec4(sum.rgb + irradiance * value.rgb, i == 0 ? value.a : sum.a);
        point.chance = fract(point.chance + 0.61803399);
    }
    return sum;
}

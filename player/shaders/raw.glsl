// The measured samples: barycentric in views and, for each of the three views, in its lights; nine bilinear fetches.
// Every image is a tile with all its levels, each with a border of one texel (player/raw_texture.h).
uniform sampler2DArray raw_sample;
uniform int level_count;
uniform ivec2 raw_tiles;      // columns and their width
uniform vec2 raw_atlas_size;  // texels
uniform vec4 level_area[16];  // x, y, width, height

vec4 image_value(int image, vec2 position)
{
    int layer = image / raw_tiles.x;
    position.x += float((image - layer * raw_tiles.x) * raw_tiles.y);
    return textureLod(raw_sample, vec3(position / raw_atlas_size, float(layer)), 0.0);
}

vec4 level_value(int level, vec2 coordinate, ivec3 image[3], vec3 weight[3])
{
    vec4 area = level_area[level];
    vec2 position = area.xy + fract(vec2(coordinate.x, -coordinate.y)) * area.zw;
    vec4 sum = vec4(0.0);
    for (int view = 0; view < 3; view++) {
        for (int light = 0; light < 3; light++) {
            if (weight[view][light] > 0.0)
                sum += weight[view][light] * image_value(image[view][light], position);
        }
    }
    return sum;
}

vec4 reflectance(SurfacePoint point)
{
    Corners views = find_corners(0, point.view);
    ivec3 image[3];
    vec3 weight[3];
    for (int view = 0; view < 3; view++) {
        Corners lights = Corners(ivec3(0), vec3(0.0));
        if (views.weight[view] > 0.0)
            lights = find_corners(views.label[view], point.light);
        image[view] = lights.label;
        weight[view] = lights.weight * views.weight[view];
    }
    float level = clamp(point.level, 0.0, float(level_count - 1));
    int fine = int(level);
    vec4 value = level_value(fine, point.coordinate, image, weight);
    float share = level - float(fine);
    if (share > 0.0)
        value = mix(value, level_value(fine + 1, point.coordinate, image, weight), share);
    return value;
}

// The inputs of the reflectance, instead of its value: what the evaluators in C need to draw the same picture.
layout(location = 0) out vec4 light_and_level;
layout(location = 1) out vec4 view_and_cover;
layout(location = 2) out vec4 coordinates;
layout(location = 3) out vec4 sides;

void main()
{
    SurfacePoint point = surface_point();
    light_and_level = vec4(surface_light(point, 0), point.level);
    view_and_cover = vec4(point.view, 1.0);
    coordinates = vec4(point.coordinate, point.key_share, 1.0);
    sides = point.sides;
}

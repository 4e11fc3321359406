// What a pixel shows: the radiance of the mode, and on request what lies behind it.
uniform float exposure;
uniform bool opaque; // no holes: what is unlit is black whatever it is
uniform bool show_level, show_extrapolation;
uniform vec2 last_ring; // cosines of the largest measured angles of view and light

out vec4 colour;

vec3 level_colour(float level)
{
    vec3 palette[6] = vec3[](vec3(0.9), vec3(0.2, 0.45, 0.9), vec3(0.15, 0.7, 0.45), vec3(0.95, 0.8, 0.2),
                             vec3(0.95, 0.45, 0.15), vec3(0.75, 0.1, 0.25));
    level = clamp(level, 0.0, 5.0);
    int lower = min(int(level), 4);
    return mix(palette[lower], palette[lower + 1], level - float(lower));
}

// Beyond the last ring nothing was measured: magenta where the view is, cyan where the first light is, whatever colour
// the cloth has.
vec3 extrapolation_tinted(vec3 value, SurfacePoint point)
{
    vec3 tint = vec3(0.0);
    if (point.view.z < last_ring.x)
        tint += vec3(0.7, 0.03, 0.45);
    float height = surface_light(point, 0).z;
    if (height > 0.0 && height < last_ring.y)
        tint += vec3(0.0, 0.45, 0.6);
    bool is_measured = tint == vec3(0.0);
    float brightness = sqrt(max(dot(value, vec3(1.0 / 3.0)), 0.0));
    return is_measured ? value : 0.3 * value + (0.1 + 0.9 * brightness) * tint;
}

bool is_lit(SurfacePoint point)
{
    float largest = 0.0;
    for (int i = 0; i < LIGHT_COUNT; i++)
        largest = max(largest, dot(light_direction[i], point.axes[2]));
    return largest > 0.0;
}

void main()
{
    SurfacePoint point = surface_point();
    vec4 value = vec4(0.0, 0.0, 0.0, 1.0);
    if (PLOT != 0 || !opaque || is_lit(point))
        value = radiance(point);
    value.rgb *= exposure;
    if (show_extrapolation)
        value.rgb = extrapolation_tinted(value.rgb, point);
    if (show_level)
        value.rgb = (0.25 + 0.75 * dot(value.rgb, vec3(1.0 / 3.0))) * level_colour(point.level);
    if (PLOT != 0 && plotted_direction().z <= 0.0)
        value = vec4(0.0);
    colour = value;
}

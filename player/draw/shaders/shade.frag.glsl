// What a pixel shows: the radiance of the mode, and on request what lies behind it. C twins: player/scene/false_colour.h,
// which has the colours.
uniform float exposure;
uniform bool opaque; // no holes: what is unlit is black whatever it is
uniform bool show_level, show_extrapolation;
uniform vec3 level_palette[LEVEL_COLOURS];
uniform vec3 extrapolation_tint[2]; // of the view, of the light
uniform vec2 last_ring; // cosines of the largest measured angles of view and light

out vec4 colour;

vec3 level_colour(float level)
{
    level = clamp(level, 0.0, float(LEVEL_COLOURS - 1));
    int lower = min(int(level), LEVEL_COLOURS - 2);
    return mix(level_palette[lower], level_palette[lower + 1], level - float(lower));
}

vec3 level_shown(vec3 value, float level)
{
    return (0.25 + 0.75 * dot(value, vec3(1.0 / 3.0))) * level_colour(level);
}

vec3 extrapolation_shown(vec3 value, bool view, bool light)
{
    if (!view && !light)
        return value;
    vec3 tint = float(view) * extrapolation_tint[0] + float(light) * extrapolation_tint[1];
    float brightness = sqrt(max(dot(value, vec3(1.0 / 3.0)), 0.0));
    return 0.3 * value + (0.1 + 0.9 * brightness) * tint;
}

vec3 extrapolation_tinted(vec3 value, SurfacePoint point)
{
    float height = surface_light(point, 0).z;
    return extrapolation_shown(value, point.view.z < last_ring.x, height > 0.0 && height < last_ring.y);
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
        value.rgb = level_shown(value.rgb, point.level);
    if (PLOT != 0 && plotted_direction().z <= 0.0)
        value = vec4(0.0);
    colour = value;
}

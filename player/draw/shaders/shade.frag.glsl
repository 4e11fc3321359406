// What a pixel shows: the radiance of the mode, and on request what lies behind it. C twins: player/scene/false_colour.h,
// which has the colours. Constant defined by player/draw/programs.c: PRUNED.
uniform float exposure;
uniform bool opaque; // no holes: what is unlit is black whatever it is
uniform bool show_level, show_extrapolation;
uniform vec3 level_palette[LEVEL_COLOURS];
uniform vec3 extrapolation_tint[3]; // of the view, of the light, of the place
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

#if PRUNED
// What the scene reaches that the material was pruned for. C twin: btf/material/visibility.h.
uniform highp usampler2DArray seen_maps; // of views, of lights, of the places of each level
uniform float seen_finest, seen_coarsest; // levels beyond which the material had others
uniform float seen_last_level;

bool is_seen(int map, vec2 place)
{
    int side = textureSize(seen_maps, 0).x;
    return texelFetch(seen_maps, ivec3(clamp(ivec2(place * float(side)), 0, side - 1), map), 0).r != 0u;
}

bool is_direction_seen(int map, vec3 direction)
{
    return is_seen(map, 0.5 + direction.xy / (2.0 * (1.0 + direction.z)));
}

bool is_place_seen(SurfacePoint point)
{
    if (point.level < seen_finest || point.level > seen_coarsest)
        return false;
    float level = clamp(point.level, 0.0, seen_last_level);
    vec2 place = fract(vec2(point.coordinate.x, -point.coordinate.y));
    return is_seen(2 + int(level), place) && (fract(level) == 0.0 || is_seen(3 + int(level), place));
}
#endif

vec3 extrapolation_shown(vec3 value, bool view, bool light, bool place)
{
    if (!view && !light && !place)
        return value;
    vec3 tint = float(view) * extrapolation_tint[0] + float(light) * extrapolation_tint[1] +
                float(place) * extrapolation_tint[2];
    float brightness = sqrt(max(dot(value, vec3(1.0 / 3.0)), 0.0));
    return 0.3 * value + (0.1 + 0.9 * brightness) * tint;
}

vec3 extrapolation_tinted(vec3 value, SurfacePoint point)
{
    vec3 direction = surface_light(point, 0);
    bool lit = direction.z > 0.0, view = point.view.z < last_ring.x, light = lit && direction.z < last_ring.y;
    bool place = false;
#if PRUNED
    view = view || !is_direction_seen(0, point.view);
    light = light || (lit && !is_direction_seen(1, direction));
    place = !is_place_seen(point);
#endif
    return extrapolation_shown(value, view, light, place);
}

bool is_lit(SurfacePoint point)
{
    float largest = 0.0;
    for (int i = 0; i < (ONE_LIGHT ? 1 : light_count); i++)
        largest = max(largest, dot(light_direction[CHOSEN_LIGHTS > 0 ? i : light_at(point, i)], point.axes[2]));
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

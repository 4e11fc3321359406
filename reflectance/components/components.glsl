// Places of directions on the squares of components. C twin: btf/direction/square_map.c.

vec2 place_of_direction(vec3 direction)
{
    return 0.5 + direction.xy * (0.5 / (1.0 + max(direction.z, 0.0)));
}

vec2 place_of_half_vector(vec3 half_vector)
{
    vec2 magnitude = abs(half_vector.xy);
    float radius = 0.5 * sqrt(max(1.0 - half_vector.z, 0.0));
    float least = min(magnitude.x, magnitude.y), most = max(magnitude.x, magnitude.y);
    float other = most > 0.0 ? radius * atan(least / most) * 1.27323954473516 : 0.0;
    vec2 place = magnitude.x >= magnitude.y ? vec2(radius, other) : vec2(other, radius);
    return 0.5 + place * vec2(half_vector.x < 0.0 ? -1.0 : 1.0, half_vector.y < 0.0 ? -1.0 : 1.0);
}

vec3 half_vector_of(vec3 light, vec3 view)
{
    vec3 sum = light + view;
    return dot(sum, sum) > 1e-12 ? normalize(sum) : vec3(0.0, 0.0, 1.0);
}

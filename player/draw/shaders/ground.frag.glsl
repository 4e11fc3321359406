// A studio's sweep: the ground under the mesh, which takes its shadow, and fades into the backdrop. It is as bright as
// the backdrop where nothing shades it, whatever the exposure: a prop beside the cloth, not part of what is measured.
in vec2 screen;
uniform vec3 backdrop;          // radiance as shown
uniform float ground_height;
uniform vec3 ground_centre;     // below the mesh
uniform float ground_size;      // radius of the mesh
uniform vec3 ground_key;        // irradiance of the key light, and of all other light
uniform vec3 ground_fill;
out vec4 colour;

vec3 sweep(float rise)
{
    return backdrop * mix(1.0, 0.42, smoothstep(-0.12, 0.55, rise));
}

// Of the light that would fall on it.
vec3 unshaded(vec3 place)
{
    if (!SHADOWS)
        return vec3(1.0);
    const vec3 up = vec3(0.0, 0.0, 1.0);
    vec3 key = ground_key * key_share_of(place, up);
    vec3 fill = ground_fill * fill_share(place, up);
    return (key + fill) / max(ground_key + ground_fill, vec3(1e-6));
}

void main()
{
    vec2 at = gl_FragCoord.xy - pane_origin;
    vec3 ray = at.x * ray_right + at.y * ray_up + ray_forward;
    float rise = ray.z / length(ray);
    bool is_below = eye.z > ground_height && ray.z < 0.0;
    vec3 place = is_below ? eye + (ground_height - eye.z) / ray.z * ray : vec3(1e9);
    float away = length(place.xy - ground_centre.xy) / ground_size;
    vec3 lit = backdrop * (1.0 - 0.25 * smoothstep(0.5, 5.0, away)) * unshaded(place);
    colour = vec4(mix(lit, sweep(rise), smoothstep(2.0, 7.0, away)), 1.0);
}

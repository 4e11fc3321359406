// A studio's sweep: the ground under the mesh, which takes its shadow, and fades into the backdrop. It is as bright as
// the backdrop where nothing shades it, whatever the exposure: a prop beside the cloth, not part of what is measured.
in vec2 screen;
uniform vec3 ray_right, ray_up, ray_forward; // the ray through a pixel: x right + y up + forward
uniform vec2 pane_origin;
uniform vec3 eye;
uniform vec3 backdrop;          // radiance as shown
uniform vec3 ground_centre;     // below the mesh
uniform float ground_size;      // radius of the mesh
uniform vec3 ground_light[2];   // irradiance of the key light, and of all other light
// Of each, what the mesh hides (player/draw/ground.c).
uniform sampler2D key_hidden, environment_hidden;
uniform float hidden_side[2];  // half of that of their squares
uniform float hidden_share[2]; // what one of their directions counts
out vec4 colour;

vec3 sweep(float rise)
{
    return backdrop * mix(1.0, 0.42, smoothstep(-0.12, 0.55, rise));
}

// What is seen of a light. Shadows that are longer than the square fade out.
float seen_share(sampler2D hidden, vec2 at, float share)
{
    return 1.0 - share * textureLod(hidden, 0.5 + 0.5 * at, 0.0).r * (1.0 - smoothstep(0.8, 1.0, length(at)));
}

// Of the light that would fall on it.
vec3 unshaded(vec2 from_centre)
{
    vec3 key = ground_light[0] * seen_share(key_hidden, from_centre / hidden_side[0], hidden_share[0]);
    vec3 fill = ground_light[1] * seen_share(environment_hidden, from_centre / hidden_side[1], hidden_share[1]);
    return (key + fill) / max(ground_light[0] + ground_light[1], vec3(1e-6));
}

void main()
{
    vec2 at = gl_FragCoord.xy - pane_origin;
    vec3 ray = at.x * ray_right + at.y * ray_up + ray_forward;
    float rise = ray.z / length(ray);
    bool is_below = eye.z > ground_centre.z && ray.z < 0.0;
    vec3 place = is_below ? eye + (ground_centre.z - eye.z) / ray.z * ray : vec3(1e9);
    vec2 from_centre = place.xy - ground_centre.xy;
    float away = length(from_centre) / ground_size;
    vec3 lit = backdrop * (1.0 - 0.25 * smoothstep(0.5, 5.0, away)) * unshaded(from_centre);
    colour = vec4(mix(lit, sweep(rise), smoothstep(2.0, 7.0, away)), 1.0);
}

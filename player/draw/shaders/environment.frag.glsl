// The environment map behind everything.
uniform sampler2D map; // radiance by longitude and latitude (player/scene/environment.h)
uniform float strength, turn;
uniform vec3 ray_right, ray_up, ray_forward; // the ray through a pixel: x right + y up + forward
uniform vec2 pane_origin;
out vec4 colour;

void main()
{
    vec2 at = gl_FragCoord.xy - pane_origin;
    vec3 ray = normalize(at.x * ray_right + at.y * ray_up + ray_forward);
    float longitude = 0.75 - atan(ray.y, ray.x) / 6.28318531 + turn;
    colour = vec4(strength * textureLod(map, vec2(fract(longitude), acos(ray.z) / 3.14159265), 0.0).rgb, 1.0);
}

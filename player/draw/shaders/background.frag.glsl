in vec2 screen;
out vec4 colour;

void main()
{
    colour = vec4(vec3(mix(0.055, 0.16, smoothstep(0.0, 1.0, screen.y))), 1.0);
}

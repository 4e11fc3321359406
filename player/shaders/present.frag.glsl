// The mean of the frames, coded as sRGB (IEC 61966-2-1). C twin: weft_srgb_of_linear.
in vec2 screen;
uniform sampler2D sum;
out vec4 colour;

void main()
{
    vec4 total = texelFetch(sum, ivec2(gl_FragCoord.xy), 0);
    vec3 linear = clamp(total.rgb / max(total.a, 1.0), 0.0, 1.0);
    vec3 low = linear * 12.92;
    vec3 high = 1.055 * pow(max(linear, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055;
    colour = vec4(mix(high, low, vec3(lessThanEqual(linear, vec3(0.0031308)))), 1.0);
}

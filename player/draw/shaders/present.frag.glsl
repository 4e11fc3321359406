// The mean of the frames as the screen shows it. C twins: weft_tone_of_linear, weft_srgb_of_linear.
in vec2 screen;
uniform sampler2D sum;
uniform float frame_share; // 1 / number of frames
uniform int left;        // of the picture on the screen, pixels
uniform int tone;        // 0 clips, 1 is soft
uniform bool difference; // signed
uniform bool keeps_opacity; // else 1
uniform float divider;   // a line there, as a share of the width; none below 0
uniform float full_difference; // where its colours end
out vec4 colour;

// The identity up to 1/2, then bent with a continuous slope toward 1.
vec3 tone_of_linear(vec3 linear)
{
    vec3 above = max(linear - 0.5, 0.0);
    return tone == 1 ? min(linear, 0.5) + above / (1.0 + 2.0 * above) : linear;
}

// IEC 61966-2-1.
vec3 srgb_of_linear(vec3 linear)
{
    linear = clamp(linear, 0.0, 1.0);
    vec3 low = linear * 12.92;
    vec3 high = 1.055 * pow(max(linear, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, vec3(lessThanEqual(linear, vec3(0.0031308))));
}

// sRGB. C twin: weft_difference_colour.
vec3 difference_colour(float difference)
{
    vec3 above[6] = vec3[](vec3(0.969), vec3(0.992, 0.859, 0.780), vec3(0.957, 0.647, 0.510),
                           vec3(0.839, 0.376, 0.302), vec3(0.698, 0.094, 0.169), vec3(0.404, 0.000, 0.122));
    vec3 below[6] = vec3[](vec3(0.969), vec3(0.820, 0.898, 0.941), vec3(0.573, 0.773, 0.871),
                           vec3(0.263, 0.576, 0.765), vec3(0.129, 0.400, 0.675), vec3(0.020, 0.188, 0.380));
    float size = 5.0 * min(abs(difference), 1.0);
    int lower = min(int(size), 4);
    vec3 a = difference < 0.0 ? below[lower] : above[lower];
    vec3 b = difference < 0.0 ? below[lower + 1] : above[lower + 1];
    return mix(a, b, size - float(lower));
}

void main()
{
    vec4 total = texelFetch(sum, ivec2(gl_FragCoord.xy) - ivec2(left, 0), 0);
    vec3 linear = frame_share * total.rgb;
    vec3 shown = difference ? difference_colour(dot(linear, vec3(1.0 / 3.0)) / full_difference)
                            : srgb_of_linear(tone_of_linear(linear));
    if (divider >= 0.0 && abs(gl_FragCoord.x - float(left) - divider * float(textureSize(sum, 0).x)) < 1.0)
        shown = vec3(0.95);
    colour = vec4(shown, keeps_opacity ? min(total.a, 1.0) : 1.0);
}

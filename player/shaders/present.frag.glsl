// The mean of the frames as the screen shows it. C twins: weft_tone_of_linear, weft_srgb_of_linear.
in vec2 screen;
uniform sampler2D sum;
uniform float frame_share; // 1 / number of frames
uniform int left;        // of the picture on the screen, pixels
uniform int tone;        // 0 clips, 1 is soft
uniform bool difference; // signed: dark is equal
uniform bool keeps_opacity; // else 1
uniform float divider;   // a line there, as a share of the width; none below 0
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

// sRGB; red where the first is brighter, blue where the second is. A quarter of white is the brightest colour.
vec3 difference_colour(vec3 signed_difference)
{
    float value = dot(signed_difference, vec3(1.0 / 3.0));
    float size = min(4.0 * abs(value), 1.0);
    vec3 middle = value > 0.0 ? vec3(0.9, 0.25, 0.12) : vec3(0.12, 0.45, 0.95);
    vec3 end = value > 0.0 ? vec3(1.0, 0.9, 0.6) : vec3(0.65, 0.95, 1.0);
    return size < 0.5 ? mix(vec3(0.06), middle, 2.0 * size) : mix(middle, end, 2.0 * size - 1.0);
}

void main()
{
    vec4 total = texelFetch(sum, ivec2(gl_FragCoord.xy) - ivec2(left, 0), 0);
    vec3 linear = frame_share * total.rgb;
    vec3 shown = difference ? difference_colour(linear) : srgb_of_linear(tone_of_linear(linear));
    if (divider >= 0.0 && abs(gl_FragCoord.x - float(left) - divider * float(textureSize(sum, 0).x)) < 1.0)
        shown = vec3(0.95);
    colour = vec4(shown, keeps_opacity ? min(total.a, 1.0) : 1.0);
}

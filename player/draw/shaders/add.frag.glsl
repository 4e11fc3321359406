// Adds one frame to the sum of frames (blending does the adding).
in vec2 screen;
uniform sampler2D frame;
out vec4 colour;

void main()
{
    colour = vec4(texelFetch(frame, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
}

in vec2 glyph;
uniform sampler2D font;
uniform vec4 ink;
out vec4 colour;

void main()
{
    colour = vec4(ink.rgb, ink.a * texelFetch(font, ivec2(floor(glyph)), 0).r);
}

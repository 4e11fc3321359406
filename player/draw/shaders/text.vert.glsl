// A glyph's corner: position in pixels from the top left, and its place in the font.
in vec3 position;
in vec2 coordinate;
uniform vec2 viewport;
out vec2 glyph;

void main()
{
    glyph = coordinate;
    gl_Position = vec4(2.0 * position.x / viewport.x - 1.0, 1.0 - 2.0 * position.y / viewport.y, 0.0, 1.0);
}

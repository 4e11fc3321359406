// A shadow: depth is kept in a map, and on the ground how often.
out vec4 colour;

void main()
{
    colour = vec4(1.0);
}

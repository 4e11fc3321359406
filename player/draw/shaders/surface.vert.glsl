in vec3 position;
in vec3 normal;
in vec4 tangent;
in vec2 coordinate;

uniform mat4 clip_of_world;

out vec3 world_normal;
out vec4 world_tangent;
out vec2 mesh_coordinate;

void main()
{
    world_normal = normal;
    world_tangent = tangent;
    mesh_coordinate = coordinate;
    gl_Position = clip_of_world * vec4(position, 1.0);
}

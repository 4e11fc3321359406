// Where the mesh is seen: its axes and its place on the material, for the shading of each pixel that follows.
// Constant defined by player/draw/programs.c: BEHIND.
uniform highp sampler2D front_depth; // of the layer in front, where BEHIND

layout(location = 0) out vec4 rotation; // unit quaternion: the axes of the surface in the world
layout(location = 1) out vec4 place;    // texture coordinates, level, distance along the view; negative: mirrored
layout(location = 2) out vec4 sides;    // of the sample, texels: across, up; 0 where the level does not follow from them

// Divides by the largest of the four components (Shepperd 1978). Columns: the axes.
vec4 quaternion_of(vec3 x, vec3 y, vec3 z)
{
    vec4 square = 1.0 + vec4(x.x - y.y - z.z, y.y - z.z - x.x, z.z - x.x - y.y, x.x + y.y + z.z);
    vec3 sum = vec3(y.z + z.y, z.x + x.z, x.y + y.x);
    vec3 turn = vec3(y.z - z.y, z.x - x.z, x.y - y.x);
    vec4 q = vec4(turn, square.w);
    float largest = square.w;
    if (square.x > largest) {
        q = vec4(square.x, sum.z, sum.y, turn.x);
        largest = square.x;
    }
    if (square.y > largest) {
        q = vec4(sum.z, square.y, sum.x, turn.y);
        largest = square.y;
    }
    if (square.z > largest)
        q = vec4(sum.y, sum.x, square.z, turn.z);
    return normalize(q);
}

void main()
{
    if (BEHIND && gl_FragCoord.z <= texelFetch(front_depth, ivec2(gl_FragCoord.xy), 0).r + 1e-6)
        discard;
    MeshPoint point = mesh_point();
    rotation = quaternion_of(point.axes[0], point.axes[1], point.axes[2]);
    place = vec4(point.coordinate, point.level, world_tangent.w / gl_FragCoord.w);
    sides = point.sides;
}

// Where the mesh is seen: its axes and its place on the material, for the shading of each pixel that follows.
// Constant defined by player/draw/programs.c: BEHIND.
in vec3 world_normal;
in vec4 world_tangent;
in vec2 mesh_coordinate;

uniform vec2 repeat;        // materials for a unit of the mesh's coordinates
uniform vec2 texel_count;   // texels (cells of a weave) of the material
uniform float level_choice; // automatic below -999
uniform float level_bias;
uniform bool level_nearest;
uniform highp sampler2D front_depth; // of the layer in front, where BEHIND

layout(location = 0) out vec4 rotation; // unit quaternion: the axes of the surface in the world
layout(location = 1) out vec4 place;    // texture coordinates, level, distance along the view; negative: mirrored
layout(location = 2) out vec4 sides;    // of the whole pixel, texels: across, up; 0 where the level does not follow from them

// The sides of the pixel in texture space, in texels.
vec4 footprint_of(vec2 coordinate)
{
    return vec4(dFdx(coordinate) * texel_count, dFdy(coordinate) * texel_count);
}

// The larger of the two, as OpenGL chooses its mip level.
float footprint_level(vec4 footprint)
{
    return 0.5 * log2(max(max(dot(footprint.xy, footprint.xy), dot(footprint.zw, footprint.zw)), 1e-20)) + level_bias;
}

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
    vec3 n = normalize(world_normal);
    vec3 t = normalize(world_tangent.xyz - n * dot(n, world_tangent.xyz));
    vec2 coordinate = mesh_coordinate * repeat;
    bool automatic = level_choice < -999.0;
    sides = footprint_of(coordinate);
    float level = automatic ? footprint_level(sides) : level_choice;
    sides *= automatic && !level_nearest ? 1.0 : 0.0;
    // The back of the cloth is the same material, mirrored in u so that its frame stays right-handed.
    if (!gl_FrontFacing) {
        n = -n;
        t = -t;
        coordinate.x = -coordinate.x;
        sides.xz = -sides.xz;
    }
    rotation = quaternion_of(t, cross(n, t), n);
    place = vec4(coordinate, level_nearest ? floor(level + 0.5) : level, world_tangent.w / gl_FragCoord.w);
}

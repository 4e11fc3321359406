// Where a fragment of the mesh lies on the material, and its axes there. The back of the cloth is the same material,
// mirrored in u so that its frame stays right-handed.
in vec3 world_normal;
in vec4 world_tangent;
in vec2 mesh_coordinate;

uniform vec2 repeat;        // materials for a unit of the mesh's coordinates
uniform vec2 texel_count;   // texels (cells of a weave) of the material
uniform float level_choice; // automatic below -999
uniform float level_bias;
uniform float longest_pixel; // what a pixel that is longer than wide counts as at most; the rest is left to other frames
uniform bool level_nearest;

struct MeshPoint {
    mat3 axes;       // in the world: x along u, y across it, the normal
    vec2 coordinate; // texture coordinates of the material, repeated
    float level;     // log2 of the pixel's footprint in texels
    vec4 sides;      // of the sample, texels: across, up; 0 where the level does not follow from them
};

// The sides of the pixel in texture space, in texels.
vec4 footprint_of(vec2 coordinate)
{
    return vec4(dFdx(coordinate) * texel_count, dFdy(coordinate) * texel_count);
}

// The longer of the two, as OpenGL chooses its mip level; or, where other frames see the rest of its length, how wide the
// pixel is beside it.
float footprint_level(vec4 footprint)
{
    float longer = sqrt(max(max(dot(footprint.xy, footprint.xy), dot(footprint.zw, footprint.zw)), 1e-20));
    float width = abs(footprint.x * footprint.w - footprint.y * footprint.z) / longer;
    return log2(max(width, longer / longest_pixel)) + level_bias;
}

MeshPoint mesh_point()
{
    vec3 n = normalize(world_normal);
    vec3 t = normalize(world_tangent.xyz - n * dot(n, world_tangent.xyz));
    vec2 coordinate = mesh_coordinate * repeat;
    bool automatic = level_choice < -999.0;
    vec4 sides = footprint_of(coordinate);
    float level = automatic ? footprint_level(sides) : level_choice;
    sides *= automatic && !level_nearest ? exp2(level_bias) : 0.0;
    if (!gl_FrontFacing) {
        n = -n;
        t = -t;
        coordinate.x = -coordinate.x;
        sides.xz = -sides.xz;
    }
    return MeshPoint(mat3(t, cross(n, t), n), coordinate, level_nearest ? floor(level + 0.5) : level, sides);
}

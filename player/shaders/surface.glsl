// What every mode needs to know of the point of the surface behind a pixel.
in vec3 world_position;
in vec3 world_normal;
in vec4 world_tangent;
in vec2 mesh_coordinate;

uniform vec3 eye;
uniform vec3 light_direction; // world, unit, toward the light
uniform float repeat;         // materials for a unit of the mesh's coordinates
uniform vec2 texel_count;     // texels (cells of a weave) of the material
uniform float level_choice;   // automatic below -999
uniform float level_bias;

struct SurfacePoint {
    vec3 light, view; // frame of the surface: x along u, y along v, z the normal
    vec2 coordinate;  // texture coordinates of the material, repeated
    float level;      // log2 of the pixel's footprint in texels, may be negative
};

// The larger of the two sides of the pixel in texture space, as OpenGL chooses its mip level.
float footprint_level(vec2 coordinate)
{
    vec2 across = dFdx(coordinate) * texel_count;
    vec2 up = dFdy(coordinate) * texel_count;
    return 0.5 * log2(max(max(dot(across, across), dot(up, up)), 1e-20)) + level_bias;
}

// Interpolated normals may turn away from the eye at a silhouette; the view is kept just above the horizon.
vec3 above_horizon(vec3 view)
{
    return normalize(vec3(view.xy, max(view.z, 0.02)));
}

SurfacePoint surface_point()
{
    vec3 n = normalize(world_normal);
    vec3 t = normalize(world_tangent.xyz - n * dot(n, world_tangent.xyz));
    vec3 b = cross(n, t) * world_tangent.w;
    vec2 coordinate = mesh_coordinate * repeat;
    float level = level_choice < -999.0 ? footprint_level(coordinate) : level_choice;
    // The back of the cloth is the same material, mirrored in u so that its frame stays right-handed.
    if (!gl_FrontFacing) {
        n = -n;
        t = -t;
        coordinate.x = -coordinate.x;
    }
    vec3 to_eye = normalize(eye - world_position);
    SurfacePoint point;
    point.light = vec3(dot(light_direction, t), dot(light_direction, b), dot(light_direction, n));
    point.view = above_horizon(vec3(dot(to_eye, t), dot(to_eye, b), dot(to_eye, n)));
    point.coordinate = coordinate;
    point.level = level;
    return point;
}

// The shadow of cloth with holes: depth is kept where the cloth, as the light sees it, is no hole. A texel of the map that
// is partly open is so by chance, and the comparisons around a place average that.
uniform vec3 toward_light; // world, unit
out vec4 colour; // where it is counted

void main()
{
    MeshPoint mesh = mesh_point();
    SurfacePoint point;
    point.axes = mesh.axes;
    point.axes[1] *= sign(world_tangent.w);
    point.view = above_horizon(toward_light * point.axes);
    point.coordinate = mesh.coordinate;
    point.level = mesh.level;
    point.sides = mesh.sides;
    point.key_share = point.env_share = 1.0;
    point.chance = pixel_chance();
    if (opacity(point) <= fract(point.chance + 0.61803399))
        discard;
    colour = vec4(1.0);
}

// Radiance of the surface under one directional light: reflectance(...) of the mode times the cosine.
uniform float exposure;

out vec4 colour;

void main()
{
    SurfacePoint point = surface_point();
    vec4 value = reflectance(point);
    colour = vec4(value.rgb * max(point.light.z, 0.0) * exposure, value.a);
}

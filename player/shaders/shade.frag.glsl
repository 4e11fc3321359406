// Radiance of the surface under one directional light: reflectance(...) of the mode times the cosine.
uniform float exposure;
uniform bool opaque; // no holes: what is unlit is black whatever it is

out vec4 colour;

void main()
{
    SurfacePoint point = surface_point();
    vec4 value = vec4(0.0, 0.0, 0.0, 1.0);
    if (point.light.z > 0.0 || !opaque)
        value = reflectance(point);
    colour = vec4(value.rgb * max(point.light.z, 0.0) * exposure, value.a);
}

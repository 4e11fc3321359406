// Cloth of microcylinder threads, the same everywhere, its threads weighted by area.
// C twin: weft_microcylinder_brdf.
uniform sampler2D thread_table;

const float THREADS_PI = 3.14159265358979;

vec4 radiance(SurfacePoint point)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        vec3 irradiance = surface_irradiance(point, i);
        if (irradiance == vec3(0.0))
            continue;
        sum += irradiance * microcylinder_brdf(thread_table, false, surface_light(point, i), point.view);
    }
    return vec4(sum * THREADS_PI, 1.0);
}

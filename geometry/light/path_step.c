#include "geometry/light/path_step.h"

/* Rays start this far above the surface, in cells of the grid. */
#define RAY_OFFSET 1e-3

/* A path that carries less than this part of the light is over. */
#define NEGLIGIBLE 1e-4

weft_vec3 weft_path_ray_start(const weft_tile_mesh *mesh, weft_vec3 at, weft_vec3 normal)
{
    return weft_add(at, weft_scale(normal, (weft_real)RAY_OFFSET * (weft_real)mesh->cell));
}

weft_vec3 weft_path_cosine_direction(weft_vec3 normal, weft_vec3 tangent, const double point[2])
{
    weft_real radius = sqrt(point[0]), angle = 2 * (weft_real)WEFT_PI * point[1];
    weft_vec3 flat = weft_add(weft_scale(tangent, radius * cos(angle)),
                              weft_scale(weft_cross(normal, tangent), radius * sin(angle)));
    return weft_unit(weft_add(flat, weft_scale(normal, sqrt(1 - point[0]))));
}

bool weft_path_reflect(weft_rgb f, weft_rgb *throughput)
{
    throughput->r *= f.r * (weft_real)WEFT_PI;
    throughput->g *= f.g * (weft_real)WEFT_PI;
    throughput->b *= f.b * (weft_real)WEFT_PI;
    return fmax(throughput->r, fmax(throughput->g, throughput->b)) > (weft_real)NEGLIGIBLE;
}

#include "capture/virtual_view.h"

/* A light and what it does to a row of pixels. */
typedef struct lighting {
    const weft_virtual_view *view;
    const weft_virtual_cloth *cloth;
    weft_vec3 light;
    double strength; /* power reference^2 */
} lighting;

/* Irradiance at every pixel of a row: strength cos(theta) / distance^2. */
WEFT_HOT static void irradiate_row(const float *x_mm, const float *y_mm, int width, weft_vec3 light, double strength,
                                   float *irradiance)
{
    float light_x = (float)light.x, light_y = (float)light.y, light_z = (float)light.z;
    float scale = (float)(strength * light.z);
    for (int x = 0; x < width; x++) {
        float dx = light_x - x_mm[x], dy = light_y - y_mm[x];
        float squared = dx * dx + dy * dy + light_z * light_z;
        irradiance[x] = scale / (squared * sqrtf(squared));
    }
}

/* The sum of the BRDF over the cloth samples of a pixel. */
static weft_rgb sum_brdf(const lighting *l, const weft_cloth_pixel *cloth)
{
    const weft_virtual_view *view = l->view;
    weft_vec3 at = {view->x_mm[cloth->pixel], view->y_mm[cloth->pixel], 0};
    weft_vec3 toward_light = weft_unit(weft_subtract(l->light, at));
    weft_vec3 toward_camera = weft_unit(weft_subtract(view->camera, at));
    weft_rgb sum = {0, 0, 0};
    for (int i = 0; i < cloth->count; i++) {
        weft_rgb brdf =
            weft_weave_brdf(&l->cloth->weave, &view->point[cloth->first + (size_t)i], toward_light, toward_camera);
        sum = (weft_rgb){sum.r + brdf.r, sum.g + brdf.g, sum.b + brdf.b};
    }
    return sum;
}

static void light_row(const lighting *l, int y, float *irradiance, float *radiance)
{
    const weft_virtual_view *view = l->view;
    size_t start = (size_t)y * (size_t)view->width;
    irradiate_row(view->x_mm + start, view->y_mm + start, view->width, l->light, l->strength, irradiance);
    for (int x = 0; x < view->width; x++) {
        irradiance[x] *= view->vignetting[start + (size_t)x];
        float printed = irradiance[x] * view->print[start + (size_t)x] * (float)(1 / WEFT_PI);
        float *pixel = radiance + 3 * (start + (size_t)x);
        pixel[0] = pixel[1] = pixel[2] = printed;
    }
    for (int i = view->row[y]; i < view->row[y + 1]; i++) {
        const weft_cloth_pixel *cloth = &view->cloth[i];
        weft_rgb sum = sum_brdf(l, cloth);
        float *pixel = radiance + 3 * (size_t)cloth->pixel;
        double scale = irradiance[(size_t)cloth->pixel - start] / view->sample_count;
        pixel[0] += (float)(scale * sum.r);
        pixel[1] += (float)(scale * sum.g);
        pixel[2] += (float)(scale * sum.b);
    }
}

void weft_virtual_view_light(const weft_virtual_view *view, const weft_virtual_cloth *cloth, weft_vec3 light,
                             double reference_mm, double power, float *radiance)
{
    lighting l = {view, cloth, light, power * reference_mm * reference_mm};
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < view->height; y++) {
        float irradiance[8192];
        light_row(&l, y, irradiance, radiance);
    }
}

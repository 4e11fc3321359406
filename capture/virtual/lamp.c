#include "capture/virtual/view.h"

/* A light and what it does to a row of pixels. */
typedef struct lighting {
    const weft_virtual_view *view;
    const weft_virtual_sample *sample;
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

/* Cloth points waiting to be evaluated, and the pixels they belong to. */
typedef struct waiting_points {
    weft_weave_batch batch;
    int pixel[WEFT_BATCH_SIZE];
} waiting_points;

/* Adds the light that the waiting points of a row send to the camera. */
static void add_cloth(const lighting *l, waiting_points *waiting, size_t row_start, const float *irradiance,
                      float *radiance)
{
    const weft_weave *weave = &l->sample->flat.weave;
    weft_weave_specular_batch(l->sample->flat.table, &waiting->batch);
    for (int i = 0; i < waiting->batch.count; i++) {
        weft_rgb brdf =
            weft_weave_shade(weave, &weave->yarn[waiting->batch.yarn[i]], (weft_real)waiting->batch.specular[i]);
        size_t index = (size_t)waiting->pixel[i];
        double scale = (double)irradiance[index - row_start] / l->view->sample_count;
        float *pixel = radiance + 3 * index;
        pixel[0] += (float)(scale * brdf.r);
        pixel[1] += (float)(scale * brdf.g);
        pixel[2] += (float)(scale * brdf.b);
    }
    waiting->batch.count = 0;
}

static void light_flat_row(const lighting *l, int y, const float *irradiance, float *radiance)
{
    const weft_virtual_view *view = l->view;
    size_t start = (size_t)y * (size_t)view->width;
    waiting_points waiting;
    if (!(l->light.z > 0 && view->camera.z > 0))
        return;
    waiting.batch.count = 0;
    for (int i = view->row[y]; i < view->row[y + 1]; i++) {
        const weft_cloth_pixel *cloth = &view->cloth[i];
        weft_vec3 at = {view->x_mm[cloth->pixel], view->y_mm[cloth->pixel], 0};
        weft_vec3 toward_light = weft_unit(weft_subtract(l->light, at));
        weft_vec3 toward_camera = weft_unit(weft_subtract(view->camera, at));
        for (int k = 0; k < cloth->count; k++) {
            if (waiting.batch.count == WEFT_BATCH_SIZE)
                add_cloth(l, &waiting, start, irradiance, radiance);
            waiting.pixel[waiting.batch.count] = cloth->pixel;
            weft_weave_batch_put(&waiting.batch, &view->point[cloth->first + (size_t)k], toward_light, toward_camera);
        }
    }
    add_cloth(l, &waiting, start, irradiance, radiance);
}

/* Radiance of a point under irradiance pi across the direction of the light becomes that under the light's own. */
static void light_deep_row(const lighting *l, int y, const float *irradiance, float *radiance)
{
    const weft_virtual_view *view = l->view;
    size_t start = (size_t)y * (size_t)view->width;
    if (!(l->light.z > 0 && view->camera.z > 0))
        return;
    for (int i = view->row[y]; i < view->row[y + 1]; i++) {
        const weft_cloth_pixel *cloth = &view->cloth[i];
        weft_vec3 at = {view->x_mm[cloth->pixel], view->y_mm[cloth->pixel], 0};
        weft_vec3 toward_light = weft_unit(weft_subtract(l->light, at));
        double scale =
            (double)irradiance[(size_t)cloth->pixel - start] / (WEFT_PI * toward_light.z * view->sample_count);
        float *pixel = radiance + 3 * (size_t)cloth->pixel;
        for (size_t k = cloth->first; k < cloth->first + (size_t)cloth->count; k++) {
            weft_rgb seen = weft_stitch_sample_light(l->sample->deep, view->vertex + k * (size_t)view->path_vertices,
                                                     view->vertex_count[k], toward_light);
            pixel[0] += (float)(scale * seen.r);
            pixel[1] += (float)(scale * seen.g);
            pixel[2] += (float)(scale * seen.b);
        }
    }
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
    if (l->sample->deep)
        light_deep_row(l, y, irradiance, radiance);
    else
        light_flat_row(l, y, irradiance, radiance);
}

void weft_virtual_view_light(const weft_virtual_view *view, const weft_virtual_sample *sample, weft_vec3 light,
                             double reference_mm, double power, float *radiance)
{
    lighting l = {view, sample, light, power * reference_mm * reference_mm};
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < view->height; y++) {
        float irradiance[8192];
        light_row(&l, y, irradiance, radiance);
    }
}

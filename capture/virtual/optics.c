#include "capture/virtual/view.h"

#include "capture/virtual/random.h"

#include <stdlib.h>

static float *allocate_floats(size_t count)
{
    return malloc(count * sizeof(float));
}

static weft_code allocate_optics(weft_virtual_optics *o, weft_error *error)
{
    size_t corners = ((size_t)o->width + 1) * ((size_t)o->height + 1), pixels = (size_t)o->width * (size_t)o->height;
    size_t samples = (size_t)o->sample_count;
    o->ray_x = allocate_floats(corners);
    o->ray_y = allocate_floats(corners);
    o->vignetting = allocate_floats(pixels);
    o->pixel_x = allocate_floats(samples);
    o->pixel_y = allocate_floats(samples);
    o->lens_x = allocate_floats(samples);
    o->lens_y = allocate_floats(samples);
    if (!o->ray_x || !o->ray_y || !o->vignetting || !o->pixel_x || !o->pixel_y || !o->lens_x || !o->lens_y)
        return weft_fail_memory(error, "optics of the virtual camera", corners * 2 * sizeof(float));
    return WEFT_OK;
}

void weft_virtual_optics_free(weft_virtual_optics *optics)
{
    free(optics->ray_x);
    free(optics->ray_y);
    free(optics->vignetting);
    free(optics->pixel_x);
    free(optics->pixel_y);
    free(optics->lens_x);
    free(optics->lens_y);
    *optics = (weft_virtual_optics){0};
}

static void trace_corners(const weft_camera *camera, weft_virtual_optics *optics)
{
    for (int y = 0; y <= optics->height; y++) {
        for (int x = 0; x <= optics->width; x++) {
            weft_pixel undistorted = weft_camera_undistort(camera, (weft_pixel){x - 0.5, y - 0.5});
            size_t corner = (size_t)y * ((size_t)optics->width + 1) + (size_t)x;
            optics->ray_x[corner] = (float)((undistorted.x - camera->cx) / camera->fx);
            optics->ray_y[corner] = (float)((undistorted.y - camera->cy) / camera->fy);
        }
    }
}

static void measure_vignetting(const weft_camera *camera, weft_virtual_optics *optics)
{
    for (int y = 0; y < optics->height; y++) {
        for (int x = 0; x < optics->width; x++) {
            double response = weft_camera_vignetting(camera, (weft_pixel){x, y});
            optics->vignetting[(size_t)y * (size_t)optics->width + (size_t)x] = (float)fmax(response, 0);
        }
    }
}

static double fraction(double x)
{
    return x - floor(x);
}

/* The low-discrepancy sequence of the generalised golden ratio (Roberts 2018) in four dimensions: pixel and pupil. */
static void place_samples(double aperture_mm, weft_virtual_optics *optics)
{
    const double golden = 1.16730397826141868; /* golden^5 = golden + 1 */
    for (int i = 0; i < optics->sample_count; i++) {
        double n = i + 1;
        optics->pixel_x[i] = (float)fraction(0.5 + n / golden);
        optics->pixel_y[i] = (float)fraction(0.5 + n / pow(golden, 2));
        double radius = aperture_mm / 2 * sqrt(fraction(0.5 + n / pow(golden, 3)));
        double angle = 2 * WEFT_PI * fraction(0.5 + n / pow(golden, 4));
        optics->lens_x[i] = (float)(radius * cos(angle));
        optics->lens_y[i] = (float)(radius * sin(angle));
    }
}

weft_code weft_virtual_optics_make(const weft_virtual_world *world, weft_virtual_optics *optics, weft_error *error)
{
    const weft_virtual_settings *settings = &world->settings;
    *optics = (weft_virtual_optics){.width = world->camera.width,
                                    .height = world->camera.height,
                                    .sample_count = (int)settings->samples_per_pixel,
                                    .focus_mm = settings->rig.camera_distance_mm};
    WEFT_TRY(allocate_optics(optics, error));
    trace_corners(&world->camera, optics);
    measure_vignetting(&world->camera, optics);
    place_samples(settings->aperture_mm, optics);
    return WEFT_OK;
}

weft_virtual_eye weft_virtual_eye_of_pose(const weft_pose *pose)
{
    const double(*r)[3] = pose->rotation;
    return (weft_virtual_eye){weft_pose_camera_position(pose),
                              {r[0][0], r[0][1], r[0][2]},
                              {r[1][0], r[1][1], r[1][2]},
                              {r[2][0], r[2][1], r[2][2]}};
}

/* The ray from a point of the pupil to the point in focus of the normalised direction (ray_x, ray_y), cut with z = 0.
 */
static bool meet_plate(const weft_virtual_eye *eye, double focus_mm, double ray_x, double ray_y, double lens_x,
                       double lens_y, double *x_mm, double *y_mm)
{
    double right = focus_mm * ray_x - lens_x, down = focus_mm * ray_y - lens_y;
    double slope = right * eye->right.z + down * eye->down.z + focus_mm * eye->forward.z;
    double start = eye->centre.z + lens_x * eye->right.z + lens_y * eye->down.z;
    if (!(slope < 0))
        return false;
    double reach = start / -slope;
    double along_right = lens_x + reach * right, along_down = lens_y + reach * down, along_forward = reach * focus_mm;
    *x_mm = eye->centre.x + along_right * eye->right.x + along_down * eye->down.x + along_forward * eye->forward.x;
    *y_mm = eye->centre.y + along_right * eye->right.y + along_down * eye->down.y + along_forward * eye->forward.y;
    return true;
}

static double blend(const float *corners, size_t corner, size_t stride, double u, double v)
{
    double upper = corners[corner] * (1 - u) + corners[corner + 1] * u;
    double lower = corners[corner + stride] * (1 - u) + corners[corner + stride + 1] * u;
    return upper * (1 - v) + lower * v;
}

static bool meet(const weft_virtual_optics *o, const weft_virtual_eye *eye, int x, int y, double u, double v,
                 double lens_x, double lens_y, double *x_mm, double *y_mm)
{
    size_t stride = (size_t)o->width + 1, corner = (size_t)y * stride + (size_t)x;
    double ray_x = blend(o->ray_x, corner, stride, u, v), ray_y = blend(o->ray_y, corner, stride, u, v);
    return meet_plate(eye, o->focus_mm, ray_x, ray_y, lens_x, lens_y, x_mm, y_mm);
}

bool weft_virtual_optics_meet(const weft_virtual_optics *o, const weft_virtual_eye *eye, int x, int y, int index,
                              double *x_mm, double *y_mm)
{
    /* One pattern for all pixels would show as a regular error along the edges of the print. */
    uint64_t bits = weft_random_bits(0, WEFT_RANDOM_PIXEL, (uint64_t)y * (uint64_t)o->width + (uint64_t)x);
    double u = fraction(o->pixel_x[index] + (double)(bits & 0xffff) * 0x1p-16);
    double v = fraction(o->pixel_y[index] + (double)(bits >> 16 & 0xffff) * 0x1p-16);
    int lens = (index + (int)(bits >> 32 & 0xffff)) % o->sample_count;
    return meet(o, eye, x, y, u, v, o->lens_x[lens], o->lens_y[lens], x_mm, y_mm);
}

bool weft_virtual_optics_meet_centre(const weft_virtual_optics *o, const weft_virtual_eye *eye, int x, int y,
                                     double *x_mm, double *y_mm)
{
    return meet(o, eye, x, y, 0.5, 0.5, 0, 0, x_mm, y_mm);
}

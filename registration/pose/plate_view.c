#include "registration/pose/plate_view.h"

#include <math.h>

double weft_bend_height(const weft_bend *bend, double x_mm, double y_mm)
{
    return (bend->xx * x_mm + bend->xy * y_mm) * x_mm + bend->yy * y_mm * y_mm;
}

weft_vec3 weft_bend_normal(const weft_bend *bend, double x_mm, double y_mm)
{
    return weft_unit((weft_vec3){-2 * bend->xx * x_mm - bend->xy * y_mm, -bend->xy * x_mm - 2 * bend->yy * y_mm, 1});
}

static void transform(const weft_homography *h, const double from[3], double to[3])
{
    for (int row = 0; row < 3; row++)
        to[row] = h->m[row][0] * from[0] + h->m[row][1] * from[1] + h->m[row][2] * from[2];
}

/* A column of the homography as a direction in the camera's frame, up to the homography's scale. */
static weft_vec3 axis_of(const weft_camera *camera, const weft_homography *h, int column)
{
    double w = h->m[2][column];
    return (weft_vec3){(h->m[0][column] - camera->cx * w) / camera->fx, (h->m[1][column] - camera->cy * w) / camera->fy,
                       w};
}

weft_plate_view weft_plate_view_of(const weft_camera *camera, const weft_homography *homography, const weft_bend *bend)
{
    weft_plate_view view = {.homography = *homography, .inverse = weft_homography_inverse(homography), .bend = *bend};
    weft_vec3 x = axis_of(camera, homography, 0), y = axis_of(camera, homography, 1);
    /* The plate lies before the camera: the sign of the scale is that of its distance. */
    double scale = sqrt(weft_length(x) * weft_length(y)) * (homography->m[2][2] < 0 ? -1 : 1);
    weft_vec3 z = scale != 0 ? weft_scale(weft_cross(x, y), 1 / scale) : (weft_vec3){0, 0, 0};
    view.lift[0] = camera->fx * z.x + camera->cx * z.z;
    view.lift[1] = camera->fy * z.y + camera->cy * z.z;
    view.lift[2] = z.z;
    transform(&view.inverse, view.lift, view.lift_back);
    return view;
}

weft_pixel weft_plate_view_see(const weft_plate_view *view, double x_mm, double y_mm)
{
    const double plate[3] = {x_mm, y_mm, 1};
    double height = weft_bend_height(&view->bend, x_mm, y_mm), seen[3];
    transform(&view->homography, plate, seen);
    for (int i = 0; i < 3; i++)
        seen[i] += height * view->lift[i];
    return (weft_pixel){seen[0] / seen[2], seen[1] / seen[2]};
}

weft_pixel weft_plate_view_meet(const weft_plate_view *view, double u, double v)
{
    enum { steps_limit = 12 };
    const weft_bend *bend = &view->bend;
    const double pixel[3] = {u, v, 1}, *lift = view->lift_back;
    double flat[3], last = 0;
    transform(&view->inverse, pixel, flat);
    weft_pixel plate = {flat[0] / flat[2], flat[1] / flat[2]};
    if (bend->xx == 0 && bend->xy == 0 && bend->yy == 0)
        return plate;
    for (int i = 0; i < steps_limit; i++) {
        double height = weft_bend_height(bend, plate.x, plate.y);
        double scale = (1 + height * lift[2]) / flat[2];
        plate = (weft_pixel){scale * flat[0] - height * lift[0], scale * flat[1] - height * lift[1]};
        if (fabs(height - last) < 1e-5)
            break;
        last = height;
    }
    return plate;
}

double weft_plate_view_depth(const weft_plate_view *view, double x_mm, double y_mm)
{
    const double *last = view->homography.m[2];
    return (last[0] * x_mm + last[1] * y_mm + weft_bend_height(&view->bend, x_mm, y_mm) * view->lift[2]) / last[2] + 1;
}

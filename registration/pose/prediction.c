#include "registration/pose/prediction.h"

#include <math.h>
#include <stdlib.h>

enum { samples_per_pixel = 64 };

/* Beyond its square and point spread, how far around a pixel (in pixels) nothing else may lie for it to be compared:
 * central differences look at its neighbours. */
static const double neighbour_reach = 1.2;

static void calibrate_pixels(weft_sight *sight)
{
    const weft_camera *camera = &sight->camera;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < camera->height; y++) {
        for (int x = 0; x < camera->width; x++) {
            size_t at = (size_t)y * (size_t)camera->width + (size_t)x;
            weft_pixel pixel = weft_camera_undistort(camera, (weft_pixel){x, y});
            sight->undistorted[at][0] = (float)pixel.x;
            sight->undistorted[at][1] = (float)pixel.y;
            sight->inverse_vignetting[at] = (float)(1 / weft_camera_vignetting(camera, (weft_pixel){x, y}));
        }
    }
}

weft_code weft_sight_create(const weft_camera *camera, const weft_target *target, double pixels_per_mm,
                            weft_sight *sight, weft_error *error)
{
    *sight = (weft_sight){.camera = *camera, .opening_mm = target->opening_mm};
    if (camera->width < 8 || camera->height < 8 || !(pixels_per_mm > 0))
        return weft_fail(error, WEFT_BAD_INPUT, "a camera of %d x %d pixels cannot be registered", camera->width,
                         camera->height);
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    sight->undistorted = malloc(pixels * sizeof *sight->undistorted);
    sight->inverse_vignetting = malloc(pixels * sizeof *sight->inverse_vignetting);
    if (!sight->undistorted || !sight->inverse_vignetting) {
        weft_sight_free(sight);
        return weft_fail_memory(error, "the calibration of all pixels", pixels * 12);
    }
    calibrate_pixels(sight);
    weft_code code = weft_drawing_create(target, 1 / (4 * pixels_per_mm), &sight->drawing, error);
    if (code != WEFT_OK)
        weft_sight_free(sight);
    return code;
}

void weft_sight_free(weft_sight *sight)
{
    free(sight->undistorted);
    free(sight->inverse_vignetting);
    weft_drawing_free(&sight->drawing);
    *sight = (weft_sight){0};
}

weft_code weft_prediction_create(const weft_camera *camera, weft_prediction *prediction, weft_error *error)
{
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    *prediction = (weft_prediction){calloc(pixels, sizeof(float)), calloc(pixels, sizeof(float)), calloc(pixels, 1)};
    if (prediction->reflectance && prediction->focus && prediction->compared)
        return WEFT_OK;
    weft_prediction_free(prediction);
    return weft_fail_memory(error, "a predicted photograph", pixels * 9);
}

void weft_prediction_free(weft_prediction *prediction)
{
    free(prediction->reflectance);
    free(prediction->focus);
    free(prediction->compared);
    *prediction = (weft_prediction){0};
}

/* Points of a pixel's square (first pair, -1/2..1/2) and of a disc with unit variance per axis (second pair), from
 * the four-dimensional additive recurrence of Roberts (2018): even in every projection, so that no direction of an
 * edge is preferred. */
typedef struct sample_pattern {
    float square_x[samples_per_pixel], square_y[samples_per_pixel], disc_x[samples_per_pixel],
        disc_y[samples_per_pixel];
} sample_pattern;

static void remove_mean(float *value)
{
    float mean = 0;
    for (int i = 0; i < samples_per_pixel; i++)
        mean += value[i] / samples_per_pixel;
    for (int i = 0; i < samples_per_pixel; i++)
        value[i] -= mean;
}

static sample_pattern place_samples(void)
{
    const double phi4 = 1.1673039782614187; /* root of x^5 = x + 1 */
    sample_pattern pattern;
    for (int i = 0; i < samples_per_pixel; i++) {
        double u[4], step = 1;
        for (int axis = 0; axis < 4; axis++)
            u[axis] = fmod(0.5 + (i + 1) * (step /= phi4), 1);
        double radius = 2 * sqrt(u[2]), azimuth = 2 * WEFT_PI * u[3];
        pattern.square_x[i] = (float)(u[0] - 0.5);
        pattern.square_y[i] = (float)(u[1] - 0.5);
        pattern.disc_x[i] = (float)(radius * cos(azimuth));
        pattern.disc_y[i] = (float)(radius * sin(azimuth));
    }
    remove_mean(pattern.square_x);
    remove_mean(pattern.square_y);
    remove_mean(pattern.disc_x);
    remove_mean(pattern.disc_y);
    return pattern;
}

/* A pixel on the plate: its centre, mm, and the derivative by the pixel coordinates, mm a pixel. */
typedef struct footprint {
    float x, y, dx[2], dy[2];
} footprint;

static void plate_point(const weft_plate_view *view, const float undistorted[2], float point[2])
{
    weft_pixel plate = weft_plate_view_meet(view, undistorted[0], undistorted[1]);
    point[0] = (float)plate.x;
    point[1] = (float)plate.y;
}

static footprint footprint_of(const weft_sight *sight, const weft_plate_view *view, int x, int y)
{
    int width = sight->camera.width;
    const float(*here)[2] = (const float(*)[2])sight->undistorted + (long)y * width + x;
    int right = x + 1 < width ? 1 : -1, below = y + 1 < sight->camera.height ? 1 : -1;
    float centre[2], beside[2], under[2];
    plate_point(view, here[0], centre);
    plate_point(view, here[right], beside);
    plate_point(view, here[(long)below * width], under);
    return (footprint){centre[0],
                       centre[1],
                       {(float)right * (beside[0] - centre[0]), (float)right * (beside[1] - centre[1])},
                       {(float)below * (under[0] - centre[0]), (float)below * (under[1] - centre[1])}};
}

static weft_rectangle reach_of(const footprint *print, double pixels)
{
    double x = pixels * (fabsf(print->dx[0]) + fabsf(print->dy[0]));
    double y = pixels * (fabsf(print->dx[1]) + fabsf(print->dy[1]));
    return (weft_rectangle){print->x - x, print->y - y, print->x + x, print->y + y};
}

/* The footprint must lie inside the raster: what is not excluded does. */
WEFT_HOT static float average_over(const weft_drawing *drawing, const footprint *print, float deviation,
                                   const sample_pattern *pattern)
{
    float cells = 1 / (float)drawing->cell_mm, half = (float)drawing->half_mm, seen[samples_per_pixel];
    float x0 = (print->x + half) * cells - 0.5f, y0 = (print->y + half) * cells - 0.5f;
    float xu = print->dx[0] * cells, xv = print->dy[0] * cells, yu = print->dx[1] * cells, yv = print->dy[1] * cells;
    for (int i = 0; i < samples_per_pixel; i++) {
        float u = pattern->square_x[i] + deviation * pattern->disc_x[i];
        float v = pattern->square_y[i] + deviation * pattern->disc_y[i];
        seen[i] = weft_drawing_between(drawing, x0 + u * xu + v * xv, y0 + u * yu + v * yv);
    }
    float sum = 0;
    for (int i = 0; i < samples_per_pixel; i++)
        sum += seen[i];
    return sum / samples_per_pixel;
}

static void predict_pixel(const weft_sight *sight, const footprint *print, const weft_plate_view *view,
                          weft_point_spread point_spread, const sample_pattern *pattern, size_t at,
                          weft_prediction *prediction)
{
    double z = weft_plate_view_depth(view, print->x, print->y);
    double focus = z > 0 ? (1 - 1 / z) * (1 - 1 / z) : 0;
    double deviation = sqrt(fmax(0, point_spread.constant + point_spread.depth * focus)), reach = 0.5 + 2 * deviation;
    weft_drawing_content around = weft_drawing_content_of(&sight->drawing, reach_of(print, reach + neighbour_reach));
    prediction->focus[at] = (float)focus;
    prediction->compared[at] = z > 0 && !around.excluded;
    /* A pixel that is not compared itself may be the neighbour of one that is. */
    if (around.excluded)
        around = weft_drawing_content_of(&sight->drawing, reach_of(print, reach));
    prediction->reflectance[at] = around.uniform || around.excluded
                                      ? weft_drawing_at(&sight->drawing, print->x, print->y)
                                      : average_over(&sight->drawing, print, (float)deviation, pattern);
}

void weft_prediction_draw(const weft_sight *sight, const weft_homography *homography, weft_point_spread point_spread,
                          weft_prediction *prediction)
{
    sample_pattern pattern = place_samples();
    const weft_plate_view view = weft_plate_view_of(&sight->camera, homography, &sight->bend);
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < sight->camera.height; y++) {
        for (int x = 0; x < sight->camera.width; x++) {
            footprint print = footprint_of(sight, &view, x, y);
            size_t at = (size_t)y * (size_t)sight->camera.width + (size_t)x;
            predict_pixel(sight, &print, &view, point_spread, &pattern, at, prediction);
        }
    }
}

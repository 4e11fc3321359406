#include "registration/pose/plate_comparison.h"

#include "registration/pose/normal_equations.h"
#include "registration/pose/opencv_bridge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void weft_plate_comparison_free(weft_plate_comparison *c)
{
    free(c->photograph);
    free(c->weight);
    weft_prediction_free(&c->prediction);
}

static size_t pixel_count(const weft_sight *sight)
{
    return (size_t)sight->camera.width * (size_t)sight->camera.height;
}

weft_code weft_plate_comparison_create(const weft_sight *sight, double blur_px, weft_plate_comparison *c,
                                       weft_error *error)
{
    size_t pixels = pixel_count(sight);
    *c = (weft_plate_comparison){.sight = sight, .blur_px = blur_px};
    WEFT_TRY(weft_prediction_create(&sight->camera, &c->prediction, error));
    c->photograph = malloc(pixels * sizeof(float));
    c->weight = malloc(pixels * sizeof(float));
    if (c->photograph && c->weight)
        return WEFT_OK;
    weft_plate_comparison_free(c);
    return weft_fail_memory(error, "refinement", pixels * 8);
}

/* ---- Looking ---- */

/* Blurs both sides with the pixels that are not compared taken out (normalised convolution), so that neither the sample
 * nor the world beyond the plate leaks in. */
static weft_code blur_both(weft_plate_comparison *c, weft_error *error)
{
    int width = c->sight->camera.width, height = c->sight->camera.height;
    size_t pixels = pixel_count(c->sight);
    for (size_t i = 0; i < pixels; i++) {
        c->weight[i] = c->prediction.compared[i];
        c->photograph[i] = c->prediction.compared[i] ? c->photograph[i] : 0;
        c->prediction.reflectance[i] *= c->weight[i];
    }
    WEFT_TRY(weft_opencv_blur(c->weight, width, height, c->blur_px, error));
    WEFT_TRY(weft_opencv_blur(c->photograph, width, height, c->blur_px, error));
    WEFT_TRY(weft_opencv_blur(c->prediction.reflectance, width, height, c->blur_px, error));
    for (size_t i = 0; i < pixels; i++) {
        float inverse = c->weight[i] > 1e-6f ? 1 / c->weight[i] : 0;
        c->photograph[i] *= inverse;
        c->prediction.reflectance[i] *= inverse;
    }
    return WEFT_OK;
}

weft_code weft_plate_comparison_look(weft_plate_comparison *c, const float *photograph,
                                     const weft_homography *homography, weft_point_spread point_spread,
                                     weft_error *error)
{
    size_t pixels = pixel_count(c->sight);
    weft_prediction_draw(c->sight, homography, point_spread, &c->prediction);
    memcpy(c->photograph, photograph, pixels * sizeof(float));
    c->focus_limit = 0;
    for (size_t i = 0; i < pixels; i++) {
        c->prediction.compared[i] &= isfinite(photograph[i]) != 0;
        if (c->prediction.compared[i])
            c->focus_limit = fmax(c->focus_limit, c->prediction.focus[i]);
    }
    return c->blur_px > 0 ? blur_both(c, error) : WEFT_OK;
}

/* ---- Lighting ---- */

void weft_plate_comparison_guess_lighting(weft_plate_comparison *c)
{
    double photograph = 0, drawing = 0;
    for (size_t i = 0; i < pixel_count(c->sight); i++) {
        photograph += c->prediction.compared[i] ? c->photograph[i] : 0;
        drawing += c->prediction.compared[i] ? c->prediction.reflectance[i] : 0;
    }
    memset(c->gain, 0, sizeof c->gain);
    c->gain[0] = drawing > 0 ? photograph / drawing : 1;
    c->stray = 0;
}

void weft_lighting_basis(const weft_camera *camera, int x, int y, double basis[WEFT_LIGHTING_COUNT])
{
    double scale = 2.0 / (camera->width > camera->height ? camera->width : camera->height);
    double u = (x - 0.5 * camera->width) * scale, v = (y - 0.5 * camera->height) * scale;
    const double values[WEFT_LIGHTING_COUNT] = {1, u, v, u * u, u * v, v * v};
    memcpy(basis, values, sizeof values);
}

double weft_lighting_at(const double basis[WEFT_LIGHTING_COUNT], const double coefficient[WEFT_LIGHTING_COUNT])
{
    double sum = 0;
    for (int k = 0; k < WEFT_LIGHTING_COUNT; k++)
        sum += coefficient[k] * basis[k];
    return sum;
}

/* The prediction under the fitted lighting at a pixel. */
static double lit_prediction(const weft_plate_comparison *c, const double basis[WEFT_LIGHTING_COUNT], size_t at)
{
    return weft_lighting_at(basis, c->gain) * (double)c->prediction.reflectance[at] + c->stray;
}

/* ---- How well they agree ---- */

/* Polynomials of the lighting's degree through the photograph and through the prediction under the fitted lighting. */
static bool smooth_parts(const weft_plate_comparison *c, double photograph[WEFT_LIGHTING_COUNT],
                         double prediction[WEFT_LIGHTING_COUNT])
{
    const weft_camera *camera = &c->sight->camera;
    weft_normal_equations seen = {0}, model = {0};
    double row[WEFT_UNKNOWNS_LIMIT] = {0};
    for (int y = 0; y < camera->height; y++) {
        for (int x = 0; x < camera->width; x++) {
            size_t at = (size_t)y * (size_t)camera->width + (size_t)x;
            if (!c->prediction.compared[at])
                continue;
            weft_lighting_basis(camera, x, y, row);
            weft_normal_equations_add(&seen, row, (double)c->photograph[at], 1);
            weft_normal_equations_add(&model, row, lit_prediction(c, row, at), 1);
        }
    }
    if (!weft_normal_equations_factor(&seen, WEFT_LIGHTING_COUNT) ||
        !weft_normal_equations_factor(&model, WEFT_LIGHTING_COUNT))
        return false;
    weft_normal_equations_solve(&seen, WEFT_LIGHTING_COUNT, photograph);
    weft_normal_equations_solve(&model, WEFT_LIGHTING_COUNT, prediction);
    return true;
}

double weft_plate_comparison_correlate(const weft_plate_comparison *c)
{
    const weft_camera *camera = &c->sight->camera;
    double photograph[WEFT_LIGHTING_COUNT], prediction[WEFT_LIGHTING_COUNT], aa = 0, bb = 0, ab = 0;
    if (!smooth_parts(c, photograph, prediction))
        return 0;
    for (int y = 0; y < camera->height; y++) {
        for (int x = 0; x < camera->width; x++) {
            size_t at = (size_t)y * (size_t)camera->width + (size_t)x;
            double basis[WEFT_LIGHTING_COUNT];
            if (!c->prediction.compared[at])
                continue;
            weft_lighting_basis(camera, x, y, basis);
            double a = (double)c->photograph[at] - weft_lighting_at(basis, photograph);
            double b = lit_prediction(c, basis, at) - weft_lighting_at(basis, prediction);
            aa += a * a, bb += b * b, ab += a * b;
        }
    }
    return aa > 0 && bb > 0 ? ab / sqrt(aa * bb) : 0;
}

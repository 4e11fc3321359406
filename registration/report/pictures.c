#include "registration/report/report.h"

#include "base/atomic_file.h"
#include "base/numeric/statistics.h"
#include "base/picture/colour.h"
#include "base/picture/image.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

enum { widest_picture = 260 };

static const float difference_gain = 4;

weft_code weft_report_prepare(const char *folder, weft_error *error)
{
    char pictures[PATH_MAX];
    if (snprintf(pictures, sizeof pictures, "%s/pictures", folder) >= (int)sizeof pictures)
        return weft_fail(error, WEFT_BAD_USAGE, "the report's folder has too long a name");
    return weft_make_folder(pictures, error);
}

static weft_code write_picture(const weft_registration *registration, int viewpoint, const char *what,
                               const weft_image *image, weft_error *error)
{
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s/pictures/%03d_%s.png", registration->settings.report_folder, viewpoint, what) >=
        (int)sizeof path)
        return weft_fail(error, WEFT_BAD_USAGE, "the report's folder has too long a name");
    return weft_image_write(path, image, NULL, error);
}

/* The quantile of 0.98 of the finite values; 1 where it is not above 0. */
static weft_code find_white(const float *value, size_t count, float *white, weft_error *error)
{
    float *finite = malloc((count + 1) * sizeof *finite);
    if (!finite)
        return weft_fail_memory(error, "the values of a picture", count * sizeof *finite);
    size_t finite_count = 0;
    for (size_t i = 0; i < count; i++) {
        if (isfinite(value[i]))
            finite[finite_count++] = value[i];
    }
    float high = finite_count ? weft_quantile_of_floats(finite, finite_count, 0.98) : 1;
    *white = high > 0 ? high : 1;
    free(finite);
    return WEFT_OK;
}

/* Where the drawing shows at a pixel. */
static bool is_drawn(const weft_sight *sight, const weft_target *target, const weft_plate_view *view, size_t at)
{
    weft_pixel plate = weft_plate_view_meet(view, sight->undistorted[at][0], sight->undistorted[at][1]);
    weft_target_region region = weft_target_region_at(target, plate.x, plate.y);
    return region == WEFT_TARGET_PRINT || region == WEFT_TARGET_REFERENCE;
}

/* Mean of the finite values of a block of pixels; 0 where there is none. */
static float mean_of_block(const float *value, int width, int x0, int y0, int side)
{
    float sum = 0;
    int count = 0;
    for (int y = y0; y < y0 + side; y++) {
        for (int x = x0; x < x0 + side; x++) {
            float v = value[(long)y * width + x];
            if (isfinite(v)) {
                sum += v;
                count++;
            }
        }
    }
    return count ? sum / (float)count : 0;
}

/* The photograph in red over the drawing in cyan: grey where they agree. */
static void paint_overlay(float photograph, float drawing, bool drawn, float white, float rgb[3])
{
    rgb[0] = weft_srgb_of_linear(photograph / white);
    rgb[1] = rgb[2] = drawn ? weft_srgb_of_linear(drawing / white) : rgb[0];
}

static void paint_difference(float photograph, float drawing, bool drawn, float white, float rgb[3])
{
    float grey = drawn ? 0.5f + difference_gain * (photograph - drawing) / white : 0.2f;
    rgb[0] = rgb[1] = rgb[2] = grey;
}

static weft_code write_comparison(const weft_registration *registration, const weft_sight *sight,
                                  const weft_target *target, int viewpoint, const weft_report_pictures *pictures,
                                  weft_error *error)
{
    const weft_camera *camera = &sight->camera;
    const float *drawing = pictures->fitted ? pictures->fitted : pictures->average;
    const weft_plate_view view = weft_plate_view_of(camera, &registration->pose[viewpoint].homography, &sight->bend);
    int side = (camera->width + widest_picture - 1) / widest_picture;
    weft_image overlay = {0}, difference = {0};
    weft_code code = weft_image_create(camera->width / side, camera->height / side, &overlay, error);
    if (code == WEFT_OK)
        code = weft_image_create(overlay.width, overlay.height, &difference, error);
    float white = 1;
    if (code == WEFT_OK)
        code = find_white(pictures->average, (size_t)camera->width * (size_t)camera->height, &white, error);
    for (int y = 0; code == WEFT_OK && y < overlay.height; y++) {
        for (int x = 0; x < overlay.width; x++) {
            size_t at = (size_t)(y * side + side / 2) * (size_t)camera->width + (size_t)(x * side + side / 2);
            bool drawn = pictures->fitted && is_drawn(sight, target, &view, at);
            float seen = mean_of_block(pictures->average, camera->width, x * side, y * side, side);
            float model = mean_of_block(drawing, camera->width, x * side, y * side, side);
            float *rgb = overlay.pixels + 3 * ((long)y * overlay.width + x);
            paint_overlay(seen, model, drawn, white, rgb);
            paint_difference(seen, model, drawn, white, difference.pixels + (rgb - overlay.pixels));
        }
    }
    if (code == WEFT_OK)
        code = write_picture(registration, viewpoint, "photograph", &overlay, error);
    if (code == WEFT_OK && pictures->fitted)
        code = write_picture(registration, viewpoint, "difference", &difference, error);
    weft_image_free(&overlay);
    weft_image_free(&difference);
    return code;
}

static weft_code write_texels(const weft_registration *registration, int viewpoint, const float *texel,
                              weft_error *error)
{
    weft_image image = {0};
    int width = registration->settings.width, height = registration->settings.height;
    size_t values = (size_t)width * (size_t)height * 3;
    float white;
    WEFT_TRY(find_white(texel, values, &white, error));
    WEFT_TRY(weft_image_create(width, height, &image, error));
    for (size_t i = 0; i < values; i++)
        image.pixels[i] = weft_srgb_of_linear(texel[i] / white);
    weft_code code = write_picture(registration, viewpoint, "texels", &image, error);
    weft_image_free(&image);
    return code;
}

weft_code weft_report_write_pictures(const weft_registration *registration, const weft_sight *sight, int viewpoint,
                                     const weft_report_pictures *pictures, weft_error *error)
{
    weft_target target = weft_target_for_opening(sight->opening_mm);
    if (pictures->average)
        WEFT_TRY(write_comparison(registration, sight, &target, viewpoint, pictures, error));
    return pictures->texel ? write_texels(registration, viewpoint, pictures->texel, error) : WEFT_OK;
}

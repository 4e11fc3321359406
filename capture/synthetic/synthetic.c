#include "capture/synthetic/synthetic.h"

#include "base/atomic_file.h"
#include "capture/synthetic/scene.h"
#include "capture/virtual/random.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- One photograph ---- */

/* A shaken photograph is the mean of what it saw on its way: a curve over some hundredth of its width. */
static void shake(const float *still, int width, int height, float *shaken)
{
    enum { STEPS = 24 };
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++) {
        for (int i = 0; i < 3 * width; i++) {
            double sum = 0;
            for (int k = 0; k < STEPS; k++) {
                double t = (double)k / (STEPS - 1) - 0.5;
                int dx = (int)lround(0.018 * width * t), dy = (int)lround(0.02 * width * t * t);
                int at_x = i / 3 + dx, at_y = y + dy;
                at_x = at_x < 0 ? 0 : at_x < width ? at_x : width - 1;
                at_y = at_y < height ? at_y : height - 1;
                sum += (double)still[3 * ((size_t)at_y * (size_t)width + (size_t)at_x) + (size_t)(i % 3)];
            }
            shaken[(size_t)y * (size_t)width * 3 + (size_t)i] = (float)(sum / STEPS);
        }
    }
}

static weft_code light_sensor(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                              const weft_virtual_sample *content, weft_image *light, weft_error *error)
{
    weft_synthetic_sheet *sheet = malloc(sizeof *sheet);
    if (!sheet)
        return weft_fail_memory(error, "a sheet", sizeof *sheet);
    *sheet = weft_synthetic_sheet_of(request->opening_mm, shot->fault != WEFT_SYNTHETIC_OTHER_SCENE, request->seed);
    weft_synthetic_scene scene = weft_synthetic_scene_of(request, shot, sheet, content);
    if (shot->fault != WEFT_SYNTHETIC_LENS_CAP)
        weft_synthetic_render(&shot->lens, &shot->pose, &scene, shot->key, light->pixels);
    free(sheet);
    return WEFT_OK;
}

static weft_code encode_tone(weft_synthetic_curve kind, float *pixels, size_t count, weft_error *error)
{
    enum { STEPS = 1 << 14 };
    static const float scale = STEPS;
    float *curve = malloc((STEPS + 2) * sizeof *curve);
    if (!curve)
        return weft_fail_memory(error, "a tone curve", STEPS * sizeof *curve);
    for (int i = 0; i <= STEPS + 1; i++)
        curve[i] = (float)weft_synthetic_tone(kind, (double)i / STEPS);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < count; i++) {
        float at = pixels[i] * scale;
        int below = (int)at;
        float part = at - (float)below;
        pixels[i] = curve[below] * (1 - part) + curve[below + 1] * part;
    }
    free(curve);
    return WEFT_OK;
}

static weft_code develop(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                         const weft_image *light, weft_image *image, weft_error *error)
{
    size_t count = 3 * (size_t)light->width * (size_t)light->height;
    const float *seen = light->pixels;
    weft_image shaken = {0};
    if (shot->fault == WEFT_SYNTHETIC_SHAKEN) {
        WEFT_TRY(weft_image_create(light->width, light->height, &shaken, error));
        shake(light->pixels, light->width, light->height, shaken.pixels);
        seen = shaken.pixels;
    }
    weft_code code = weft_synthetic_sense(&shot->exposure, seen, count, shot->key, image->pixels, error);
    if (code == WEFT_OK && request->format == WEFT_SYNTHETIC_JPEG)
        code = encode_tone(request->curve, image->pixels, count, error);
    weft_image_free(&shaken);
    return code;
}

weft_code weft_synthetic_take(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                              const weft_virtual_sample *content, weft_image *image, weft_error *error)
{
    weft_image light = {0};
    WEFT_TRY(weft_image_create(shot->lens.width, shot->lens.height, image, error));
    weft_code code = weft_image_create(shot->lens.width, shot->lens.height, &light, error);
    if (code == WEFT_OK)
        code = light_sensor(request, shot, content, &light, error);
    if (code == WEFT_OK)
        code = develop(request, shot, &light, image, error);
    weft_image_free(&light);
    if (code != WEFT_OK)
        weft_image_free(image);
    return code;
}

/* ---- The folder ---- */

static weft_code make_empty_folder(const char *folder, weft_error *error)
{
    WEFT_TRY(weft_make_folder(folder, error));
    DIR *open = opendir(folder);
    if (!open)
        return weft_fail_errno(error, "open", folder);
    int entries = 0;
    for (const struct dirent *entry; (entry = readdir(open)) != NULL;)
        entries += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(open);
    return entries == 0 ? WEFT_OK : weft_fail(error, WEFT_BAD_USAGE, "the folder '%s' is not empty", folder);
}

static weft_code write_photograph(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                                  const weft_image *image, weft_error *error)
{
    char path[PATH_MAX];
    weft_camera_notes notes = {"Weft",
                               "Virtual Hand",
                               shot->date,
                               shot->orientation,
                               shot->exposure.seconds,
                               shot->exposure.f_number,
                               shot->exposure.iso,
                               shot->lens.focal_length_mm,
                               shot->lens.focal_length_mm * 36 / shot->lens.sensor_width_mm};
    if (snprintf(path, sizeof path, "%s/%s", request->folder, shot->name) >= PATH_MAX)
        return weft_fail(error, WEFT_BAD_USAGE, "the name of the folder is too long");
    return weft_snapshot_write(path, image, &notes, error);
}

static weft_code take_all(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                          const weft_virtual_sample *content, const weft_progress *progress, weft_error *error)
{
    for (int i = 0; i < request->photograph_count; i++) {
        weft_image image = {0};
        WEFT_TRY(weft_synthetic_take(request, &shot[i], content, &image, error));
        weft_code code = write_photograph(request, &shot[i], &image, error);
        weft_image_free(&image);
        WEFT_TRY(code);
        weft_progress_report(progress, "taking photographs", i + 1, request->photograph_count);
    }
    return WEFT_OK;
}

static weft_code take_and_record(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                                 const weft_virtual_sample *content, const weft_progress *progress, weft_error *error)
{
    WEFT_TRY(make_empty_folder(request->folder, error));
    WEFT_TRY(weft_synthetic_truth_write(request, shot, error));
    WEFT_TRY(weft_synthetic_write_notes(request, shot, error));
    WEFT_TRY(take_all(request, shot, content, progress, error));
    if (request->truth_size > 0)
        return weft_synthetic_truth_write_reflectance(request, shot, content, progress, error);
    return WEFT_OK;
}

static weft_code read_content(const weft_synthetic_request *request, weft_virtual_sample *content,
                              char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    weft_virtual_settings settings = weft_virtual_settings_default();
    settings.rig.opening_mm = request->opening_mm;
    *content = (weft_virtual_sample){.opening_mm = request->opening_mm, .is_checker = true};
    warning[0] = '\0';
    return strcmp(request->content, "checker") == 0
               ? WEFT_OK
               : weft_virtual_sample_read(request->content, &settings, request->seed, content, warning, error);
}

weft_code weft_synthetic_run(const weft_synthetic_request *request, const weft_progress *progress,
                             char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    weft_virtual_sample content;
    WEFT_TRY(read_content(request, &content, warning, error));
    weft_synthetic_shot *shot = calloc((size_t)request->photograph_count, sizeof *shot);
    weft_code code = shot ? WEFT_OK : weft_fail_memory(error, "a plan", sizeof *shot);
    if (code == WEFT_OK) {
        weft_synthetic_plan(request, shot);
        code = take_and_record(request, shot, &content, progress, error);
    }
    free(shot);
    weft_virtual_sample_free(&content);
    return code;
}

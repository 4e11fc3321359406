#include "capture/camera/camera.h"

#include "capture/camera/video_library.h"

#include <dlfcn.h>
#include <stdlib.h>

static const char name[] = "video camera", module_name[] = "weft_video_library.so";

typedef struct video_camera {
    weft_camera_settings settings;
    const weft_video_library *library;
    weft_video *video;
} video_camera;

static weft_code expose(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    video_camera *camera = device;
    const weft_camera_settings *settings = &camera->settings;
    weft_image image;
    double said_s;
    (void)frame;
    WEFT_TRY(camera->library->set_exposure(camera->video, exposure_s, &said_s, error));
    WEFT_TRY(weft_frame_exposure(said_s, &settings->format, name, read_back_s, error));
    if (settings->shutter.release)
        WEFT_TRY(settings->shutter.release(settings->shutter.context, exposure_s, error));
    WEFT_TRY(camera->library->read(camera->video, settings->stale_frames, &image, error));
    weft_code code = weft_frame_develop(&image, &settings->format, name, samples, error);
    weft_image_free(&image);
    return code;
}

static weft_code open_library(const weft_video_library **library, weft_error *error)
{
    void *module = dlopen(module_name, RTLD_NOW | RTLD_LOCAL);
    *library = module ? dlsym(module, "weft_video_library_table") : NULL;
    return *library ? WEFT_OK : weft_fail(error, WEFT_SYSTEM, "%s: %s", name, dlerror());
}

static void close_camera(void *device)
{
    video_camera *camera = device;
    camera->library->close(camera->video);
    free(camera);
}

weft_code weft_video_camera_open(const weft_camera_settings *settings, weft_rig_camera *result, weft_error *error)
{
    video_camera *camera = calloc(1, sizeof *camera);
    if (!camera)
        return weft_fail_memory(error, name, sizeof *camera);
    camera->settings = *settings;
    weft_code code = open_library(&camera->library, error);
    if (code == WEFT_OK)
        code = camera->library->open(settings->device, &camera->video, error);
    if (code != WEFT_OK) {
        free(camera);
        return code;
    }
    *result = (weft_rig_camera){camera, expose, NULL, close_camera};
    return WEFT_OK;
}

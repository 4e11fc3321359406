#include "capture/camera/camera.h"

#include "base/picture/exif.h"

#include <errno.h>
#include <fnmatch.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <unistd.h>

static const char name[] = "watched folder";

/* Files come whole, but some programs write them in more than one go: closed is not yet complete. */
typedef struct folder_camera {
    weft_camera_settings settings;
    weft_clock clock;
    int watch;
    char original[PATH_MAX];  /* of the last frame */
    char taken[NAME_MAX + 1]; /* its name; empty: there was none */
} folder_camera;

/* ---- Events ---- */

/* Calls `visit` for each file that has come; stops where it returns true. */
typedef bool visitor(void *context, const char *file);

static bool read_events(int watch, visitor *visit, void *context)
{
    _Alignas(struct inotify_event) char buffer[16 * (sizeof(struct inotify_event) + NAME_MAX + 1)];
    ssize_t size;
    while ((size = read(watch, buffer, sizeof buffer)) > 0) {
        for (char *at = buffer; at < buffer + size;) {
            const struct inotify_event *event = (const struct inotify_event *)at;
            if (event->len > 0 && visit && visit(context, event->name))
                return true;
            at += sizeof *event + event->len;
        }
    }
    return false;
}

/* ---- A frame ---- */

/* What is made of the files that come. */
typedef struct taking {
    folder_camera *camera;
    uint16_t *samples;
    double exposure_s;
    weft_code code;
    weft_error error; /* of the last file that could not be used */
} taking;

static weft_code take(taking *t, const char *path)
{
    const weft_frame_format *format = &t->camera->settings.format;
    weft_image image;
    weft_exif exif;
    WEFT_TRY(weft_exif_read(path, &exif, &t->error));
    WEFT_TRY(weft_frame_exposure(exif.exposure_s, format, name, &t->exposure_s, &t->error));
    WEFT_TRY(weft_image_read(path, &image, NULL, &t->error));
    weft_code code = weft_frame_develop(&image, format, name, t->samples, &t->error);
    weft_image_free(&image);
    return code;
}

/* Cameras that write raw and JPEG write one of them late: it is of the last frame, not of this one. The same name again
 * is another photograph, for their numbers begin anew. */
static bool is_of_last_frame(const char *file, const char *taken)
{
    const char *dot = strrchr(file, '.'), *taken_dot = strrchr(taken, '.');
    size_t length = dot ? (size_t)(dot - file) : strlen(file);
    return taken_dot && (size_t)(taken_dot - taken) == length && strncmp(file, taken, length) == 0 &&
           strcmp(file, taken) != 0;
}

static bool try_file(void *context, const char *file)
{
    taking *t = context;
    const weft_camera_settings *settings = &t->camera->settings;
    char *path = t->camera->original;
    if (fnmatch(settings->pattern, file, FNM_CASEFOLD | FNM_PERIOD) != 0 || is_of_last_frame(file, t->camera->taken))
        return false;
    snprintf(path, PATH_MAX, "%s/%s", settings->device, file);
    t->code = take(t, path);
    if (t->code == WEFT_OK)
        snprintf(t->camera->taken, sizeof t->camera->taken, "%s", file);
    return t->code == WEFT_OK;
}

static bool stop_asked(const folder_camera *camera)
{
    return camera->settings.stop && *camera->settings.stop;
}

/* Waits in short steps, to hear a stop. */
static weft_code wait_for_file(taking *t, weft_error *error)
{
    const double step_s = 0.1;
    const weft_camera_settings *settings = &t->camera->settings;
    const weft_clock *clock = &t->camera->clock;
    double end_s = clock->now_s(clock->context) + settings->timeout_s;
    while (clock->now_s(clock->context) < end_s) {
        if (stop_asked(t->camera))
            return weft_fail(error, WEFT_SYSTEM, "%s: stopped while waiting for a photograph", name);
        if (clock->wait_for_input(clock->context, t->camera->watch, step_s) &&
            read_events(t->camera->watch, try_file, t))
            return WEFT_OK;
    }
    if (t->code == WEFT_OK)
        return weft_fail(error, WEFT_SYSTEM, "%s: no photograph '%s' came into '%s' within %g s", name,
                         settings->pattern, settings->device, settings->timeout_s);
    return weft_fail(error, WEFT_SYSTEM, "%s: %.300s", name, t->error.message);
}

static weft_code expose(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    folder_camera *camera = device;
    const weft_shutter *shutter = &camera->settings.shutter;
    taking t = {.camera = camera, .samples = samples};
    (void)frame;
    read_events(camera->watch, NULL, NULL);
    if (stop_asked(camera))
        return weft_fail(error, WEFT_SYSTEM, "%s: stopped", name);
    if (shutter->release)
        WEFT_TRY(shutter->release(shutter->context, exposure_s, error));
    WEFT_TRY(wait_for_file(&t, error));
    *read_back_s = t.exposure_s;
    return WEFT_OK;
}

static const char *original(void *device)
{
    return ((folder_camera *)device)->original;
}

/* ---- The camera ---- */

static void close_camera(void *device)
{
    folder_camera *camera = device;
    if (camera->watch >= 0)
        close(camera->watch);
    free(camera);
}

weft_code weft_folder_camera_open(const weft_camera_settings *settings, weft_rig_camera *result, weft_error *error)
{
    folder_camera *camera = calloc(1, sizeof *camera);
    if (!camera)
        return weft_fail_memory(error, name, sizeof *camera);
    camera->settings = *settings;
    camera->clock = settings->clock ? *settings->clock : weft_system_clock;
    camera->watch = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (camera->watch < 0 ||
        inotify_add_watch(camera->watch, settings->device, IN_CLOSE_WRITE | IN_MOVED_TO | IN_ONLYDIR) < 0) {
        weft_code code = weft_fail_errno(error, "watch folder", settings->device);
        close_camera(camera);
        return code;
    }
    *result = (weft_rig_camera){camera, expose, original, close_camera};
    return WEFT_OK;
}

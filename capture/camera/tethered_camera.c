#include "capture/camera/tethered_camera.h"

#include "base/clock.h"
#include "base/picture/exif.h"
#include "capture/camera/shutter_choice.h"

#include <gphoto2/gphoto2.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char name[] = "camera";

struct weft_tethered_camera {
    weft_tethered_camera_settings settings;
    GPContext *context;
    Camera *camera;  /* NULL: not open */
    char folder[64]; /* of files that the session has not taken yet */
    char original[PATH_MAX];
};

static weft_code fail_with(int result, const char *what, weft_error *error)
{
    if (result == GP_ERROR_NO_SPACE)
        return weft_fail(error, WEFT_SYSTEM, "%s: its card is full", name);
    return weft_fail(error, WEFT_SYSTEM, "%s: cannot %s: %s", name, what, gp_result_as_string(result));
}

/* ---- Opening ---- */

static void close_camera(weft_tethered_camera *c)
{
    if (!c->camera)
        return;
    gp_camera_exit(c->camera, c->context);
    gp_camera_free(c->camera);
    c->camera = NULL;
}

static int choose_port(weft_tethered_camera *c)
{
    GPPortInfoList *list;
    GPPortInfo info;
    if (!*c->settings.port)
        return GP_OK;
    gp_port_info_list_new(&list);
    int result = gp_port_info_list_load(list);
    if (result >= GP_OK)
        result = gp_port_info_list_lookup_path(list, c->settings.port);
    if (result >= GP_OK)
        result = gp_port_info_list_get_info(list, result, &info);
    if (result >= GP_OK)
        result = gp_camera_set_port_info(c->camera, info);
    gp_port_info_list_free(list);
    return result;
}

/* A camera on a network cannot be told by a number of its plug. */
static int choose_model(weft_tethered_camera *c)
{
    CameraAbilitiesList *list;
    CameraAbilities abilities;
    if (strncmp(c->settings.port, "ptpip:", 6) != 0)
        return GP_OK;
    gp_abilities_list_new(&list);
    int result = gp_abilities_list_load(list, c->context);
    if (result >= GP_OK)
        result = gp_abilities_list_lookup_model(list, "PTP/IP Camera");
    if (result >= GP_OK)
        result = gp_abilities_list_get_abilities(list, result, &abilities);
    if (result >= GP_OK)
        result = gp_camera_set_abilities(c->camera, abilities);
    gp_abilities_list_free(list);
    return result;
}

static int open_camera(weft_tethered_camera *c)
{
    if (c->camera)
        return GP_OK;
    int result = gp_camera_new(&c->camera);
    if (result >= GP_OK)
        result = choose_model(c);
    if (result >= GP_OK)
        result = choose_port(c);
    if (result >= GP_OK)
        result = gp_camera_init(c->camera, c->context);
    if (result < GP_OK && c->camera) {
        gp_camera_free(c->camera);
        c->camera = NULL;
    }
    return result;
}

/* ---- Exposure ---- */

static int get_shutter(weft_tethered_camera *c, CameraWidget **widget, const char **key)
{
    static const char *const keys[] = {"shutterspeed", "shutterspeed2", "exptime"};
    int result = GP_ERROR_NOT_SUPPORTED;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        result = gp_camera_get_single_config(c->camera, keys[i], widget, c->context);
        *key = keys[i];
        if (result >= GP_OK)
            return result;
    }
    return result;
}

/* The longest choice that is no longer than asked, for what is clipped is lost; else the shortest. NULL where none is a
 * time. */
static const char *best_choice(CameraWidget *widget, double exposure_s)
{
    const double rounding = 1.05; /* "1/60" is 1/64 */
    const char *best = NULL;
    double found_s = 0;
    for (int i = 0; i < gp_widget_count_choices(widget); i++) {
        const char *choice;
        double seconds = gp_widget_get_choice(widget, i, &choice) >= GP_OK ? weft_shutter_seconds(choice) : 0;
        bool fits = seconds <= rounding * exposure_s, fitted = found_s <= rounding * exposure_s;
        bool better = !best || (fits && (!fitted || seconds > found_s)) || (!fits && !fitted && seconds < found_s);
        if (seconds > 0 && better) {
            found_s = seconds;
            best = choice;
        }
    }
    return best;
}

/* A camera whose shutter no program can set keeps what it has. */
static int set_shutter(weft_tethered_camera *c, double exposure_s)
{
    CameraWidget *widget;
    const char *key, *value = NULL;
    int result = get_shutter(c, &widget, &key);
    if (result < GP_OK)
        return result == GP_ERROR_NOT_SUPPORTED || result == GP_ERROR_BAD_PARAMETERS ? GP_OK : result;
    const char *choice = best_choice(widget, exposure_s);
    gp_widget_get_value(widget, &value);
    if (choice && (!value || strcmp(value, choice) != 0)) {
        gp_widget_set_value(widget, choice);
        result = gp_camera_set_single_config(c->camera, key, widget, c->context);
    }
    gp_widget_free(widget);
    return result;
}

/* What the camera says its shutter is set to; 0: nothing. */
static double shutter_said(weft_tethered_camera *c)
{
    CameraWidget *widget;
    const char *key, *value = NULL;
    double seconds = 0;
    if (get_shutter(c, &widget, &key) < GP_OK)
        return 0;
    if (gp_widget_get_value(widget, &value) >= GP_OK && value)
        seconds = weft_shutter_seconds(value);
    gp_widget_free(widget);
    return seconds;
}

/* ---- Photographs ---- */

/* What the camera has to say of before: else it would be taken for an answer. */
static int drain_events(weft_tethered_camera *c)
{
    enum { MOST = 200, WAIT_MS = 10 };
    CameraEventType type = GP_EVENT_UNKNOWN;
    int result = GP_OK;
    for (int i = 0; result >= GP_OK && type != GP_EVENT_TIMEOUT && i < MOST; i++) {
        void *data = NULL;
        result = gp_camera_wait_for_event(c->camera, WAIT_MS, &type, &data, c->context);
        free(data);
    }
    return result;
}

static int fetch(weft_tethered_camera *c, const CameraFilePath *path)
{
    CameraFile *file;
    const char *ending = strrchr(path->name, '.');
    snprintf(c->original, sizeof c->original, "%s/photograph%s", c->folder, ending ? ending : "");
    int result = gp_file_new(&file);
    if (result < GP_OK)
        return result;
    result = gp_camera_file_get(c->camera, path->folder, path->name, GP_FILE_TYPE_NORMAL, file, c->context);
    if (result >= GP_OK)
        result = gp_file_save(file, c->original);
    gp_file_free(file);
    return result;
}

static int take_once(weft_tethered_camera *c, double exposure_s, double *said_s)
{
    CameraFilePath path;
    int result = open_camera(c);
    if (result >= GP_OK)
        result = drain_events(c);
    if (result >= GP_OK)
        result = set_shutter(c, exposure_s);
    if (result >= GP_OK)
        result = gp_camera_capture(c->camera, GP_CAPTURE_IMAGE, &path, c->context);
    if (result >= GP_OK)
        result = fetch(c, &path);
    *said_s = result >= GP_OK ? shutter_said(c) : 0;
    return result;
}

/* Nothing is gained by asking again. */
static bool is_final(int result)
{
    return result == GP_ERROR_NO_SPACE || result == GP_ERROR_NOT_SUPPORTED || result == GP_ERROR_MODEL_NOT_FOUND ||
           result == GP_ERROR_UNKNOWN_PORT;
}

static bool stop_asked(const weft_tethered_camera *c)
{
    return c->settings.stop && *c->settings.stop;
}

/* Again where the camera is busy or gone, opened anew, until the time is up. */
static weft_code take(weft_tethered_camera *c, double exposure_s, double *said_s, weft_error *error)
{
    const struct timespec pause = {0, 300000000};
    double end_s = weft_now_s() + c->settings.timeout_s;
    int result = take_once(c, exposure_s, said_s);
    while (result < GP_OK && !is_final(result) && weft_now_s() < end_s) {
        if (stop_asked(c))
            return weft_fail(error, WEFT_SYSTEM, "%s: stopped", name);
        close_camera(c);
        nanosleep(&pause, NULL);
        result = take_once(c, exposure_s, said_s);
    }
    return result >= GP_OK ? WEFT_OK : fail_with(result, "take a photograph", error);
}

static weft_code expose(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    weft_tethered_camera *c = device;
    const weft_frame_format *format = &c->settings.format;
    double said_s;
    weft_exif exif;
    weft_image image;
    (void)frame;
    WEFT_TRY(take(c, exposure_s, &said_s, error));
    WEFT_TRY(weft_exif_read(c->original, &exif, error));
    WEFT_TRY(weft_frame_exposure(exif.exposure_s > 0 ? exif.exposure_s : said_s, format, name, read_back_s, error));
    WEFT_TRY(weft_image_read(c->original, &image, NULL, error));
    weft_code code = weft_frame_develop(&image, format, name, samples, error);
    weft_image_free(&image);
    return code;
}

static const char *original(void *device)
{
    return ((weft_tethered_camera *)device)->original;
}

/* ---- The camera ---- */

static weft_code begin(weft_tethered_camera *c, weft_error *error)
{
    const char *temporary = getenv("TMPDIR");
    snprintf(c->folder, sizeof c->folder, "%.40s/weft-XXXXXX", temporary && *temporary ? temporary : "/tmp");
    if (!mkdtemp(c->folder))
        return weft_fail_errno(error, "make folder", c->folder);
    c->context = gp_context_new();
    if (!c->context)
        return weft_fail_memory(error, name, 0);
    int result = open_camera(c);
    if (result == GP_ERROR_MODEL_NOT_FOUND)
        return weft_fail(error, WEFT_SYSTEM, "%s: none is connected that libgphoto2 knows", name);
    return result >= GP_OK ? WEFT_OK : fail_with(result, "open it", error);
}

weft_code weft_tethered_camera_create(const weft_tethered_camera_settings *settings, weft_tethered_camera **result,
                                      weft_error *error)
{
    weft_tethered_camera *c = calloc(1, sizeof *c);
    if (!c)
        return weft_fail_memory(error, name, sizeof *c);
    c->settings = *settings;
    weft_code code = begin(c, error);
    if (code != WEFT_OK) {
        weft_tethered_camera_free(c);
        return code;
    }
    *result = c;
    return WEFT_OK;
}

void weft_tethered_camera_free(weft_tethered_camera *c)
{
    if (!c)
        return;
    close_camera(c);
    if (c->context)
        gp_context_unref(c->context);
    remove(c->original);
    rmdir(c->folder);
    free(c);
}

weft_rig_camera weft_tethered_camera_for_rig(weft_tethered_camera *camera)
{
    return (weft_rig_camera){.device = camera, .expose = expose, .original = original};
}

#include "capture/camera/camera.h"

#include "base/clock.h"
#include "base/picture/exif.h"
#include "capture/camera/tethered_shutter.h"

#include <gphoto2/gphoto2.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char name[] = "camera";

typedef struct tethered_camera {
    weft_camera_settings settings;
    GPContext *context;
    Camera *camera;  /* NULL: not open */
    char folder[64]; /* of files that the session has not taken yet */
    char original[PATH_MAX];
    char message[128]; /* the last error of libgphoto2; empty: none */
    double largest_kb; /* of the files so far */
    double longest_s;  /* of the times that its shutter has names for; 0: not known */
} tethered_camera;

static weft_code fail_with(const tethered_camera *c, int result, const char *what, weft_error *error)
{
    if (result == GP_ERROR_NO_SPACE)
        return weft_fail(error, WEFT_SYSTEM, "%s: its card is full", name);
    return weft_fail(error, WEFT_SYSTEM, "%s: cannot %s: %s", name, what,
                     *c->message ? c->message : gp_result_as_string(result));
}

static void note_error(GPContext *context, const char *text, void *data)
{
    tethered_camera *c = data;
    (void)context;
    snprintf(c->message, sizeof c->message, "%.*s", (int)strcspn(text, "\n"), text);
}

static bool stop_asked(const tethered_camera *c)
{
    return c->settings.stop && *c->settings.stop;
}

/* ---- Opening ---- */

static void close_camera(tethered_camera *c)
{
    if (!c->camera)
        return;
    gp_camera_exit(c->camera, c->context);
    gp_camera_free(c->camera);
    c->camera = NULL;
}

static int choose_port(tethered_camera *c)
{
    GPPortInfoList *list;
    GPPortInfo info;
    if (!*c->settings.device)
        return GP_OK;
    gp_port_info_list_new(&list);
    int result = gp_port_info_list_load(list);
    if (result >= GP_OK)
        result = gp_port_info_list_lookup_path(list, c->settings.device);
    if (result >= GP_OK)
        result = gp_port_info_list_get_info(list, result, &info);
    if (result >= GP_OK)
        result = gp_camera_set_port_info(c->camera, info);
    gp_port_info_list_free(list);
    return result;
}

/* A camera on a network cannot be told by a number of its plug. */
static int choose_model(tethered_camera *c)
{
    CameraAbilitiesList *list;
    CameraAbilities abilities;
    if (strncmp(c->settings.device, "ptpip:", 6) != 0)
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

static int open_alone(tethered_camera *c)
{
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

/* Cameras of one rig may be lost together, each in its thread; libltdl, which loads their drivers, knows no threads. */
static int open_camera(tethered_camera *c)
{
    static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;
    if (c->camera)
        return GP_OK;
    pthread_mutex_lock(&one_at_a_time);
    int result = open_alone(c);
    pthread_mutex_unlock(&one_at_a_time);
    return result;
}

/* ---- Exposure ---- */

static bool needs_bulb(tethered_camera *c, double exposure_s)
{
    if (c->longest_s == 0)
        c->longest_s = weft_shutter_longest(c->camera, c->context);
    return weft_shutter_needs_bulb(c->camera, c->context, c->longest_s, exposure_s);
}

static void wait_until(const tethered_camera *c, double end_s)
{
    const double slice_s = 0.05;
    for (double left_s; (left_s = end_s - weft_now_s()) > 0 && !stop_asked(c);) {
        double pause_s = fmin(left_s, slice_s);
        const struct timespec pause = {0, (long)(pause_s * 1e9)};
        nanosleep(&pause, NULL);
    }
}

/* The file that the camera says it has made since; its shutter may be open for `exposure_s` yet. */
static int wait_for_file(tethered_camera *c, double exposure_s, CameraFilePath *path)
{
    enum { WAIT_MS = 100 };
    double end_s = weft_now_s() + exposure_s + c->settings.timeout_s;
    while (weft_now_s() < end_s && !stop_asked(c)) {
        CameraEventType type = GP_EVENT_UNKNOWN;
        void *data = NULL;
        int result = gp_camera_wait_for_event(c->camera, WAIT_MS, &type, &data, c->context);
        bool is_file = result >= GP_OK && type == GP_EVENT_FILE_ADDED && data;
        if (is_file)
            *path = *(CameraFilePath *)data;
        free(data);
        if (is_file || result < GP_OK)
            return result;
    }
    return GP_ERROR_TIMEOUT;
}

/* A busy camera refuses it at first. A shutter that stays open would end only with its battery. */
static int let_go(tethered_camera *c)
{
    enum { TRIES = 20 };
    const struct timespec pause = {0, 100000000};
    int result = weft_shutter_press(c->camera, c->context, 0);
    for (int i = 1; result < GP_OK && i < TRIES; i++) {
        nanosleep(&pause, NULL);
        result = weft_shutter_press(c->camera, c->context, 0);
    }
    return result;
}

/* *lasted_s receives how long the shutter was open, by the clock: drivers open it last, and close it first. */
static int expose_by_bulb(tethered_camera *c, double exposure_s, CameraFilePath *path, double *lasted_s)
{
    int result = weft_shutter_choose_bulb(c->camera, c->context);
    if (result >= GP_OK)
        result = weft_shutter_press(c->camera, c->context, 1);
    if (result < GP_OK)
        return result;
    double opened_s = weft_now_s();
    wait_until(c, opened_s + exposure_s);
    *lasted_s = weft_now_s() - opened_s;
    result = let_go(c);
    return result >= GP_OK ? wait_for_file(c, 0, path) : result;
}

/* ---- Photographs ---- */

/* What the camera has to say of before: else it would be taken for an answer. */
static int drain_events(tethered_camera *c)
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

static int fetch(tethered_camera *c, const CameraFilePath *path)
{
    CameraFile *file;
    const char *data;
    unsigned long bytes = 0;
    const char *ending = strrchr(path->name, '.');
    snprintf(c->original, sizeof c->original, "%s/photograph%s", c->folder, ending ? ending : "");
    int result = gp_file_new(&file);
    if (result < GP_OK)
        return result;
    result = gp_camera_file_get(c->camera, path->folder, path->name, GP_FILE_TYPE_NORMAL, file, c->context);
    if (result >= GP_OK)
        result = gp_file_save(file, c->original);
    if (result >= GP_OK && gp_file_get_data_and_size(file, &data, &bytes) >= GP_OK)
        c->largest_kb = fmax(c->largest_kb, (double)bytes / 1024);
    gp_file_free(file);
    return result;
}

/* gp_camera_capture waits a minute for the file of a camera that has refused to take it. */
static int release(tethered_camera *c, double exposure_s, CameraFilePath *path)
{
    int result = gp_camera_trigger_capture(c->camera, c->context);
    if (result == GP_ERROR_NOT_SUPPORTED)
        return gp_camera_capture(c->camera, GP_CAPTURE_IMAGE, path, c->context);
    return result >= GP_OK ? wait_for_file(c, exposure_s, path) : result;
}

/* Whether no card has room for another file like those before: drivers say of it that something is wrong, no more. */
static bool is_card_full(tethered_camera *c)
{
    CameraStorageInformation *card = NULL;
    int count = 0, full = 0;
    if (!c->camera || gp_camera_get_storageinfo(c->camera, &card, &count, c->context) < GP_OK)
        return false;
    for (int i = 0; i < count; i++) {
        bool known = card[i].fields & GP_STORAGEINFO_FREESPACEKBYTES;
        full += known && (double)card[i].freekbytes < fmax(c->largest_kb, 1);
    }
    free(card);
    return count > 0 && full == count;
}

/* *said_s is what the camera says of its shutter, or nothing is: then *bulb_s is what the clock says. */
static int expose_once(tethered_camera *c, double exposure_s, CameraFilePath *path, double *said_s, double *bulb_s)
{
    if (needs_bulb(c, exposure_s))
        return expose_by_bulb(c, exposure_s, path, bulb_s);
    int result = weft_shutter_set(c->camera, c->context, exposure_s);
    if (result >= GP_OK)
        result = release(c, exposure_s, path);
    if (result >= GP_OK)
        *said_s = weft_shutter_reported(c->camera, c->context);
    return result;
}

static int take_once(tethered_camera *c, double exposure_s, double *said_s, double *bulb_s)
{
    CameraFilePath path;
    *said_s = *bulb_s = 0;
    c->message[0] = 0;
    int result = open_camera(c);
    if (result >= GP_OK)
        result = drain_events(c);
    if (result >= GP_OK)
        result = expose_once(c, exposure_s, &path, said_s, bulb_s);
    if (result >= GP_OK)
        return fetch(c, &path);
    return result;
}

/* Nothing is gained by asking again. */
static bool is_final(int result)
{
    return result == GP_ERROR_NO_SPACE || result == GP_ERROR_NOT_SUPPORTED || result == GP_ERROR_MODEL_NOT_FOUND ||
           result == GP_ERROR_UNKNOWN_PORT;
}

/* Again where the camera is busy or gone, opened anew, until the time is up. */
static weft_code take(tethered_camera *c, double exposure_s, double *said_s, double *bulb_s, weft_error *error)
{
    enum { BUSY = 3 }; /* failures that may be a camera that is busy, whatever its card: it may write elsewhere */
    const struct timespec pause = {0, 300000000};
    double end_s = weft_now_s() + exposure_s + c->settings.timeout_s;
    if (stop_asked(c))
        return weft_fail(error, WEFT_SYSTEM, "%s: stopped", name);
    int result = take_once(c, exposure_s, said_s, bulb_s);
    for (int failed = 1; result < GP_OK && !is_final(result) && weft_now_s() < end_s; failed++) {
        if (stop_asked(c))
            return weft_fail(error, WEFT_SYSTEM, "%s: stopped", name);
        if (failed >= BUSY && is_card_full(c)) {
            result = GP_ERROR_NO_SPACE;
            break;
        }
        close_camera(c);
        nanosleep(&pause, NULL);
        result = take_once(c, exposure_s, said_s, bulb_s);
    }
    return result >= GP_OK ? WEFT_OK : fail_with(c, result, "take a photograph", error);
}

/* Cameras note the time of bulb in whole seconds, if at all: the clock knows better, where both agree as far as that
 * goes. */
static weft_code bulb_exposure(double lasted_s, double noted_s, double *read_back_s, weft_error *error)
{
    const double whole_s = 1.1;
    if (noted_s > 0 && fabs(noted_s - lasted_s) > whole_s)
        return weft_fail(error, WEFT_SYSTEM, "%s: its shutter was open for %.2f s by the clock, %.2f s by the file",
                         name, lasted_s, noted_s);
    *read_back_s = lasted_s;
    return WEFT_OK;
}

static weft_code expose(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    tethered_camera *c = device;
    const weft_frame_format *format = &c->settings.format;
    double said_s, bulb_s;
    weft_exif exif;
    weft_image image;
    (void)frame;
    WEFT_TRY(take(c, exposure_s, &said_s, &bulb_s, error));
    WEFT_TRY(weft_exif_read(c->original, &exif, error));
    if (bulb_s > 0)
        WEFT_TRY(bulb_exposure(bulb_s, exif.exposure_s, read_back_s, error));
    else
        WEFT_TRY(weft_frame_exposure(exif.exposure_s > 0 ? exif.exposure_s : said_s, format, name, read_back_s, error));
    WEFT_TRY(weft_image_read(c->original, &image, NULL, error));
    weft_code code = weft_frame_develop(&image, format, name, samples, error);
    weft_image_free(&image);
    return code;
}

static const char *original(void *device)
{
    return ((tethered_camera *)device)->original;
}

/* ---- The camera ---- */

/* Some cameras hand over their files and no more. */
static weft_code expect_release(const tethered_camera *c, weft_error *error)
{
    CameraAbilities abilities;
    int result = gp_camera_get_abilities(c->camera, &abilities);
    if (result < GP_OK)
        return fail_with(c, result, "ask what it can do", error);
    if (!(abilities.operations & (GP_OPERATION_CAPTURE_IMAGE | GP_OPERATION_TRIGGER_CAPTURE)))
        return weft_fail(error, WEFT_SYSTEM, "%s: a computer cannot release the shutter of a %s: use a watched folder",
                         name, abilities.model);
    return WEFT_OK;
}

static weft_code begin(tethered_camera *c, weft_error *error)
{
    const char *temporary = getenv("TMPDIR");
    snprintf(c->folder, sizeof c->folder, "%.40s/weft-XXXXXX", temporary && *temporary ? temporary : "/tmp");
    if (!mkdtemp(c->folder))
        return weft_fail_errno(error, "make folder", c->folder);
    c->context = gp_context_new();
    if (!c->context)
        return weft_fail_memory(error, name, 0);
    gp_context_set_error_func(c->context, note_error, c);
    int result = open_camera(c);
    if (result == GP_ERROR_MODEL_NOT_FOUND)
        return weft_fail(error, WEFT_SYSTEM, "%s: libgphoto2 finds no camera that it knows", name);
    return result >= GP_OK ? expect_release(c, error) : fail_with(c, result, "open it", error);
}

static void free_camera(void *device)
{
    tethered_camera *c = device;
    close_camera(c);
    if (c->context)
        gp_context_unref(c->context);
    remove(c->original);
    rmdir(c->folder);
    free(c);
}

weft_code weft_tethered_camera_open(const weft_camera_settings *settings, weft_rig_camera *result, weft_error *error)
{
    tethered_camera *c = calloc(1, sizeof *c);
    if (!c)
        return weft_fail_memory(error, name, sizeof *c);
    c->settings = *settings;
    weft_code code = begin(c, error);
    if (code != WEFT_OK) {
        free_camera(c);
        return code;
    }
    *result = (weft_rig_camera){c, expose, original, free_camera};
    return WEFT_OK;
}

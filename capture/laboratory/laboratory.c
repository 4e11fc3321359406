#include "capture/laboratory/laboratory.h"

#include "base/text/csv.h"
#include "base/text/json_text.h"
#include "btf/session/colour.h"
#include "btf/session/lens.h"
#include "btf/session/poses_file.h"
#include "capture/camera/camera.h"
#include "capture/motion/controller.h"
#include "capture/motion/lamps.h"

#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What releases a shutter that the camera does not release itself. All borrowed. */
typedef struct releases {
    weft_controller *controller; /* of the stage, with a contact; NULL: none */
    weft_operator rig_operator;
    pthread_mutex_t one_question; /* the operator is asked one thing at a time */
} releases;

typedef struct lab_camera {
    const weft_rig_file *file;
    const weft_camera_description *description;
    releases *releases;
    const volatile sig_atomic_t *stop;
    char lens[PATH_MAX], device[PATH_MAX];
    weft_colour colour; /* terms 0: not known */
    char poses_path[PATH_MAX];
    weft_poses_file poses; /* where the axes truly put it; read where the rig file names them */
    char *identity;
    weft_axes axes;     /* with this camera's fixed angles */
    weft_stage *stage;  /* as it stands on it */
    bool asked_to_show; /* something else than the sample */
    weft_rig rig;
} lab_camera;

struct weft_laboratory {
    weft_rig_file file;
    weft_laboratory_request request;
    weft_angles *lamp; /* [lamp_count] */
    int lamp_count;
    char *sample;
    weft_controller *controller;
    weft_relay *relay;
    weft_lamp_guard *guard; /* of the lamps of either; NULL: they burn anyway */
    releases releases;
    int camera_count;
    lab_camera camera[WEFT_CAMERAS_MAX]; /* [camera_count] */
};

/* ---- What the rig file names of a camera ---- */

static weft_code read_lens(lab_camera *c, weft_error *error)
{
    weft_lens lens;
    WEFT_TRY(weft_rig_file_beside(c->file, c->description->lens, c->lens, sizeof c->lens, error));
    WEFT_TRY(weft_lens_read(c->lens, &lens, error));
    c->rig.calibration = lens.camera;
    c->rig.lens_path = c->lens;
    return WEFT_OK;
}

static weft_code read_colour(lab_camera *c, weft_error *error)
{
    char path[PATH_MAX];
    if (!c->description->colour[0])
        return WEFT_OK;
    WEFT_TRY(weft_rig_file_beside(c->file, c->description->colour, path, sizeof path, error));
    WEFT_TRY(weft_colour_read(path, &c->colour, error));
    c->rig.colour = &c->colour;
    return WEFT_OK;
}

static weft_code read_poses(lab_camera *c, weft_error *error)
{
    if (!c->description->poses[0])
        return WEFT_OK;
    WEFT_TRY(weft_rig_file_beside(c->file, c->description->poses, c->poses_path, sizeof c->poses_path, error));
    WEFT_TRY(weft_poses_read(c->poses_path, &c->poses, error));
    c->rig.poses = &c->poses.poses;
    c->rig.poses_path = c->poses_path;
    return WEFT_OK;
}

/* Speeds, limits and retries may change between runs; where things stand and what takes the photographs may not. */
static weft_code identify(lab_camera *c, weft_error *error)
{
    const weft_rig_file *file = c->file;
    const weft_camera_description *camera = c->description;
    json_t *identity = json_object();
    weft_json_put(&identity, "rig_name", weft_json_text(file->name, strlen(file->name)));
    weft_json_put(&identity, "lens", weft_json_text(camera->lens, strlen(camera->lens)));
    weft_json_put(&identity, "lamps", weft_json_text(file->light.lamps, strlen(file->light.lamps)));
    weft_json_put(&identity, "values", json_string(camera->values == WEFT_VALUES_SRGB ? "srgb" : "linear"));
    weft_json_put(&identity, "light_level", json_real(file->light.level));
    weft_json_put(&identity, "axes", json_integer(file->axes.count));
    c->identity = identity ? json_dumps(identity, JSON_COMPACT) : NULL;
    json_decref(identity);
    return c->identity ? WEFT_OK : weft_fail_memory(error, "rig", 0);
}

static weft_rig_settings settings_of(const lab_camera *c)
{
    const weft_camera_description *camera = c->description;
    weft_rig_settings settings = weft_rig_settings_default();
    settings.width_px = c->rig.calibration.width;
    settings.height_px = c->rig.calibration.height;
    settings.focal_length_px = c->rig.calibration.fx;
    settings.bits = WEFT_FRAME_BITS;
    settings.black_level = camera->black_level;
    settings.opening_mm = c->file->opening_mm;
    settings.camera_distance_mm = camera->distance_mm;
    settings.light_distance_mm = c->file->light.distance_mm;
    settings.camera_half_angle_deg = camera->half_angle_deg;
    settings.shortest_exposure_s = camera->shortest_exposure_s;
    settings.longest_exposure_s = camera->longest_exposure_s;
    settings.retries = camera->retries;
    return settings;
}

/* ---- What it is to see ---- */

/* The operator does it; but a lamp that has a switch is dark without. */
static weft_code show(void *device, weft_curtain scene, weft_error *error)
{
    static const char *const asked[] = {[WEFT_CURTAIN_OPEN] = "Let the camera see the sample again.",
                                        [WEFT_CURTAIN_DARK] = "Cover the lens: no light may reach the camera.",
                                        [WEFT_CURTAIN_EVEN] =
                                            "Put an evenly lit white field, out of focus, before the whole lens."};
    lab_camera *c = device;
    bool covered = c->file->light.backend == WEFT_LIGHT_NONE, was_asked = c->asked_to_show;
    const weft_operator *operator= & c->releases->rig_operator;
    const char *name = c->rig.camera_name;
    char text[192];
    c->asked_to_show = scene == WEFT_CURTAIN_EVEN || (scene == WEFT_CURTAIN_DARK && covered);
    if (!c->asked_to_show && !was_asked)
        return WEFT_OK;
    snprintf(text, sizeof text, "%s%s%s%s", name ? "Camera '" : "", name ? name : "", name ? "': " : "", asked[scene]);
    return operator->ask(operator->context, text, error);
}

/* ---- What a capture sees of it ---- */

static weft_code describe_camera(const weft_rig_file *file, int index, lab_camera *c, weft_error *error)
{
    const weft_camera_description *camera = &file->camera[index];
    *c = (lab_camera){.file = file, .description = camera};
    WEFT_TRY(read_lens(c, error));
    WEFT_TRY(read_colour(c, error));
    WEFT_TRY(read_poses(c, error));
    WEFT_TRY(identify(c, error));
    c->axes = file->axes;
    c->axes.fixed_deg[WEFT_BODY_CAMERA][WEFT_TURN_THETA] = camera->theta_deg;
    c->axes.fixed_deg[WEFT_BODY_CAMERA][WEFT_TURN_PHI] = camera->phi_deg;
    c->rig.curtain = (weft_rig_curtain){c, show};
    c->rig.name = "laboratory";
    c->rig.identity = c->identity;
    c->rig.camera_name = file->camera_count > 1 ? camera->name : NULL;
    c->rig.camera_model = camera->model[0] ? camera->model : NULL;
    c->rig.settings = settings_of(c);
    c->rig.noise = (weft_sensor_noise){camera->electrons_per_value, camera->read_noise_electrons};
    c->rig.dark_frames = (int)camera->dark_frames;
    c->rig.flat_frames = (int)camera->flat_frames;
    c->rig.seconds_per_photograph = camera->seconds_per_photograph;
    return weft_rig_settings_check(&c->rig.settings, file->path, error);
}

/* ---- The shutter ---- */

static weft_code release_by_stage(void *context, double exposure_s, weft_error *error)
{
    const lab_camera *c = context;
    (void)exposure_s;
    return weft_controller_pulse(c->releases->controller, c->description->pulse_s, error);
}

static weft_code release_by_hand(void *context, double exposure_s, weft_error *error)
{
    const lab_camera *c = context;
    const weft_operator *operator= & c->releases->rig_operator;
    const char *name = c->rig.camera_name;
    char text[128];
    snprintf(text, sizeof text, "Take the photograph%s%s%s, exposed for %.6g s.", name ? " with the camera '" : "",
             name ? name : "", name ? "'" : "", exposure_s);
    pthread_mutex_lock(&c->releases->one_question);
    weft_code code = operator->ask(operator->context, text, error);
    pthread_mutex_unlock(&c->releases->one_question);
    return code;
}

static weft_shutter shutter_of(lab_camera *c)
{
    if (c->description->trigger == WEFT_TRIGGER_STAGE)
        return (weft_shutter){c, release_by_stage};
    if (c->description->trigger == WEFT_TRIGGER_HAND)
        return (weft_shutter){c, release_by_hand};
    return (weft_shutter){0};
}

/* ---- The device ---- */

static weft_frame_format format_of(const lab_camera *c)
{
    const weft_camera_description *camera = c->description;
    bool by_hand = camera->shortest_exposure_s == camera->longest_exposure_s;
    return (weft_frame_format){.bin = (int)camera->bin,
                               .width = c->rig.calibration.width,
                               .height = c->rig.calibration.height,
                               .srgb = camera->values == WEFT_VALUES_SRGB,
                               .exposure_s = by_hand ? camera->shortest_exposure_s : 0};
}

/* Drivers of live cameras hold a few frames from before. */
static int stale_frames_of(const weft_camera_description *camera)
{
    enum { HELD_FRAMES = 4 };
    const char *device = camera->device;
    bool is_live = *device && device[strspn(device, "0123456789")] == 0;
    return camera->backend == WEFT_CAMERA_VIDEO && is_live ? HELD_FRAMES : 0;
}

static weft_code connect_camera(lab_camera *c, weft_error *error)
{
    static weft_code (*const open[])(const weft_camera_settings *, weft_rig_camera *,
                                     weft_error *) = {[WEFT_CAMERA_FOLDER] = weft_folder_camera_open,
                                                      [WEFT_CAMERA_VIDEO] = weft_video_camera_open,
                                                      [WEFT_CAMERA_GPHOTO2] = weft_tethered_camera_open};
    const weft_camera_description *camera = c->description;
    weft_camera_settings settings = {.device = camera->device,
                                     .pattern = camera->pattern,
                                     .timeout_s = camera->timeout_s,
                                     .stale_frames = stale_frames_of(camera),
                                     .format = format_of(c),
                                     .shutter = shutter_of(c),
                                     .stop = c->stop};
    if (camera->backend == WEFT_CAMERA_FOLDER) {
        WEFT_TRY(weft_rig_file_beside(c->file, camera->device, c->device, sizeof c->device, error));
        settings.device = c->device;
    }
    return open[camera->backend](&settings, &c->rig.camera, error);
}

/* ---- Lamps ---- */

static weft_code read_lamp(const weft_csv *csv, int row, const int column[2], weft_angles *lamp, weft_error *error)
{
    double theta_deg, phi_deg;
    WEFT_TRY(weft_csv_number(csv, row, column[0], &theta_deg, error));
    WEFT_TRY(weft_csv_number(csv, row, column[1], &phi_deg, error));
    if (!(theta_deg >= 0 && theta_deg < 90 && phi_deg >= -360 && phi_deg <= 360))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: a lamp at %g, %g degrees is below the table", csv->path,
                         csv->line[row], theta_deg, phi_deg);
    *lamp = (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
    return WEFT_OK;
}

static weft_code read_rows(weft_laboratory *lab, const weft_csv *csv, weft_error *error)
{
    const int column[2] = {weft_csv_column(csv, "theta_light_deg"), weft_csv_column(csv, "phi_light_deg")};
    if (column[0] < 0 || column[1] < 0 || csv->row_count == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: lamps need the columns theta_light_deg and phi_light_deg",
                         csv->path);
    lab->lamp = calloc((size_t)csv->row_count, sizeof *lab->lamp);
    if (!lab->lamp)
        return weft_fail_memory(error, "lamps", (size_t)csv->row_count * sizeof *lab->lamp);
    for (lab->lamp_count = 0; lab->lamp_count < csv->row_count; lab->lamp_count++)
        WEFT_TRY(read_lamp(csv, lab->lamp_count, column, &lab->lamp[lab->lamp_count], error));
    return WEFT_OK;
}

static weft_code read_lamps(weft_laboratory *lab, weft_error *error)
{
    char path[PATH_MAX];
    weft_csv csv;
    if (!lab->file.axes.lamps)
        return WEFT_OK;
    WEFT_TRY(weft_rig_file_beside(&lab->file, lab->file.light.lamps, path, sizeof path, error));
    WEFT_TRY(weft_csv_read(path, true, &csv, error));
    weft_code code = read_rows(lab, &csv, error);
    weft_csv_free(&csv);
    return code;
}

/* ---- Stage ---- */

static weft_code create_controller(weft_laboratory *lab, weft_error *error)
{
    const weft_stage_description *stage = &lab->file.stage;
    const weft_controller_settings settings = {
        .address = {(unsigned short)stage->usb_vendor, (unsigned short)stage->usb_product, stage->usb_serial},
        .timeout_s = stage->timeout_s,
        .retries = (int)stage->retries,
        .replug_s = stage->replug_s,
        .poll_s = stage->poll_s,
        .tolerance_deg = stage->tolerance_deg,
        .stop = lab->request.stop};
    return weft_controller_create(&settings, &lab->file.axes, &lab->controller, error);
}

static weft_code create_relay(weft_laboratory *lab, weft_error *error)
{
    const weft_light_description *light = &lab->file.light;
    const weft_relay_settings settings = {
        .address = {(unsigned short)light->usb_vendor, (unsigned short)light->usb_product, light->usb_serial},
        .replug_s = lab->file.stage.replug_s,
        .retries = (int)lab->file.stage.retries,
        .stop = lab->request.stop};
    return weft_relay_create(&settings, &lab->relay, error);
}

static weft_code create_stage(weft_laboratory *lab, weft_error *error)
{
    const weft_rig_file *file = &lab->file;
    weft_stage_parts parts = {.axes = &lab->camera[0].axes,
                              .lamp = lab->lamp,
                              .lamp_count = lab->lamp_count,
                              .lamp_tolerance_rad = weft_rad_of_deg(file->light.lamp_tolerance_deg),
                              .level = file->light.level,
                              .warm_up_s = file->light.warm_up_s,
                              .rig_operator = lab->request.rig_operator,
                              .retries = (int)file->stage.retries};
    if (file->stage.backend == WEFT_STAGE_USB) {
        WEFT_TRY(create_controller(lab, error));
        parts.controller = lab->controller;
    }
    if (file->light.backend == WEFT_LIGHT_STAGE)
        parts.lamps = weft_controller_lamps(lab->controller);
    if (file->light.backend == WEFT_LIGHT_RELAY) {
        WEFT_TRY(create_relay(lab, error));
        parts.lamps = weft_relay_lamps(lab->relay);
    }
    if (parts.lamps.set) {
        WEFT_TRY(weft_lamp_guard_create(parts.lamps, &lab->guard, error));
        parts.lamps = weft_lamp_guard_lamps(lab->guard);
    }
    lab_camera *first = &lab->camera[0];
    WEFT_TRY(weft_stage_create(&parts, &first->stage, error));
    for (lab_camera *c = first + 1; c < first + lab->camera_count; c++)
        WEFT_TRY(weft_stage_create_beside(first->stage, &c->axes, &c->stage, error));
    return WEFT_OK;
}

/* ---- Opening ---- */

static weft_code describe_cameras(weft_laboratory *lab, weft_error *error)
{
    lab->releases.rig_operator = lab->request.rig_operator;
    for (int i = 0; i < lab->file.camera_count; i++) {
        lab_camera *c = &lab->camera[lab->camera_count++];
        WEFT_TRY(describe_camera(&lab->file, i, c, error));
        c->releases = &lab->releases;
        c->stop = lab->request.stop;
    }
    return WEFT_OK;
}

/* What all cameras share. */
static void join_cameras(weft_laboratory *lab)
{
    bool several = lab->camera_count > 1;
    for (int i = 0; i < lab->camera_count; i++) {
        lab_camera *c = &lab->camera[i];
        c->rig.sample = lab->sample;
        c->rig.stage = weft_stage_for_rig(c->stage);
        c->rig.light = weft_stage_light(c->stage);
        c->rig.first = several ? &lab->camera[0].rig : NULL;
        c->rig.next = i + 1 < lab->camera_count ? &lab->camera[i + 1].rig : NULL;
    }
}

static weft_code prepare(weft_laboratory *lab, weft_error *error)
{
    WEFT_TRY(weft_rig_file_read(lab->request.rig_file, &lab->file, error));
    WEFT_TRY(describe_cameras(lab, error));
    WEFT_TRY(read_lamps(lab, error));
    WEFT_TRY(create_stage(lab, error));
    lab->releases.controller = lab->controller;
    lab->sample = strdup(lab->request.sample);
    if (!lab->sample)
        return weft_fail_memory(error, "rig", 0);
    join_cameras(lab);
    return WEFT_OK;
}

weft_code weft_laboratory_open(const weft_laboratory_request *request, weft_laboratory **result, weft_error *error)
{
    weft_laboratory *lab = calloc(1, sizeof *lab);
    if (!lab)
        return weft_fail_memory(error, "rig", sizeof *lab);
    lab->request = *request;
    pthread_mutex_init(&lab->releases.one_question, NULL);
    weft_code code = prepare(lab, error);
    if (code != WEFT_OK) {
        weft_laboratory_close(lab);
        return code;
    }
    *result = lab;
    return WEFT_OK;
}

void weft_laboratory_close(weft_laboratory *lab)
{
    for (int i = lab->camera_count - 1; i >= 0; i--) {
        weft_rig_camera *camera = &lab->camera[i].rig.camera;
        if (camera->close)
            camera->close(camera->device);
        free(lab->camera[i].identity);
        weft_stage_free(lab->camera[i].stage);
    }
    weft_relay_free(lab->relay);
    weft_controller_free(lab->controller);
    weft_lamp_guard_free(lab->guard);
    pthread_mutex_destroy(&lab->releases.one_question);
    free(lab->lamp);
    free(lab->sample);
    free(lab);
}

weft_rig *weft_laboratory_rig(weft_laboratory *lab)
{
    return &lab->camera[0].rig;
}

weft_code weft_laboratory_connect(weft_laboratory *lab, weft_error *error)
{
    for (int i = 0; i < lab->camera_count; i++)
        WEFT_TRY(connect_camera(&lab->camera[i], error));
    return WEFT_OK;
}

#include "capture/laboratory/laboratory.h"

#include "base/text/csv.h"
#include "base/text/json_text.h"
#include "btf/session/lens.h"
#include "btf/session/poses_file.h"
#include "capture/camera/folder_camera.h"
#include "capture/camera/tethered_camera.h"
#include "capture/camera/video_camera.h"
#include "capture/file_crc.h"
#include "capture/motion/controller.h"
#include "capture/motion/relay.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct weft_laboratory {
    weft_rig_file file;
    weft_laboratory_request request;
    weft_angles *lamp; /* [lamp_count] */
    int lamp_count;
    char *sample, *identity;
    char camera_device[PATH_MAX];
    char lens[PATH_MAX], poses_path[PATH_MAX];
    weft_controller *controller;
    weft_relay *relay;
    weft_stage *stage;
    weft_folder_camera *folder;
    weft_video_camera *video;
    weft_tethered_camera *tethered;
    weft_poses_file poses;
    bool asked_to_show; /* something else than the sample */
    weft_rig rig;
};

/* ---- What the rig file names ---- */

static weft_code read_lens(weft_laboratory *lab, weft_error *error)
{
    weft_lens lens;
    WEFT_TRY(weft_rig_file_beside(&lab->file, lab->file.camera.lens, lab->lens, sizeof lab->lens, error));
    WEFT_TRY(weft_lens_read(lab->lens, &lens, error));
    lab->rig.calibration = lens.camera;
    return WEFT_OK;
}

static weft_code read_poses(weft_laboratory *lab, weft_error *error)
{
    if (!lab->file.poses[0])
        return WEFT_OK;
    WEFT_TRY(weft_rig_file_beside(&lab->file, lab->file.poses, lab->poses_path, sizeof lab->poses_path, error));
    WEFT_TRY(weft_poses_read(lab->poses_path, &lab->poses, error));
    lab->rig.poses = &lab->poses.poses;
    lab->rig.poses_path = lab->poses_path;
    return WEFT_OK;
}

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

/* ---- What photographs depend on ---- */

/* Speeds, limits and retries may change in the night; where things stand and what takes the photographs may not. */
static weft_code identify(weft_laboratory *lab, weft_error *error)
{
    const weft_rig_file *file = &lab->file;
    json_t *identity = json_object();
    weft_json_put(&identity, "rig_name", weft_json_text(file->name, strlen(file->name)));
    weft_json_put(&identity, "lens", weft_json_text(file->camera.lens, strlen(file->camera.lens)));
    weft_json_put(&identity, "lamps", weft_json_text(file->light.lamps, strlen(file->light.lamps)));
    weft_json_put(&identity, "values", json_string(file->camera.values == WEFT_VALUES_SRGB ? "srgb" : "linear"));
    weft_json_put(&identity, "light_level", json_real(file->light.level));
    weft_json_put(&identity, "axes", json_integer(file->axes.count));
    lab->identity = identity ? json_dumps(identity, JSON_COMPACT) : NULL;
    json_decref(identity);
    return lab->identity ? WEFT_OK : weft_fail_memory(error, "rig", 0);
}

static weft_rig_settings settings_of(const weft_rig_file *file, const weft_camera *camera)
{
    weft_rig_settings settings = weft_rig_settings_default();
    settings.width_px = camera->width;
    settings.height_px = camera->height;
    settings.focal_length_px = camera->fx;
    settings.bits = WEFT_FRAME_BITS;
    settings.black_level = file->camera.black_level;
    settings.opening_mm = file->opening_mm;
    settings.camera_distance_mm = file->camera.distance_mm;
    settings.light_distance_mm = file->light.distance_mm;
    settings.camera_half_angle_deg = file->camera.half_angle_deg;
    settings.shortest_exposure_s = file->camera.shortest_exposure_s;
    settings.longest_exposure_s = file->camera.longest_exposure_s;
    settings.retries = file->camera.retries;
    return settings;
}

/* ---- Stage and lamps ---- */

static weft_usb_address address_of(const weft_usb_name *usb)
{
    return (weft_usb_address){(unsigned short)usb->vendor, (unsigned short)usb->product, usb->serial};
}

static weft_code create_controller(weft_laboratory *lab, weft_error *error)
{
    const weft_stage_description *stage = &lab->file.stage;
    const weft_controller_settings settings = {.address = address_of(&stage->usb),
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
    const weft_relay_settings settings = {.address = address_of(&lab->file.light.usb),
                                          .replug_s = lab->file.stage.replug_s,
                                          .retries = (int)lab->file.stage.retries,
                                          .stop = lab->request.stop};
    return weft_relay_create(&settings, &lab->relay, error);
}

static weft_code create_stage(weft_laboratory *lab, weft_error *error)
{
    const weft_rig_file *file = &lab->file;
    weft_stage_parts parts = {.axes = &file->axes,
                              .lamp = lab->lamp,
                              .lamp_count = lab->lamp_count,
                              .lamp_tolerance_rad = weft_rad_of_deg(file->light.lamp_tolerance_deg),
                              .level = file->light.level,
                              .warm_up_s = file->light.warm_up_s,
                              .person = lab->request.person,
                              .retries = (int)file->stage.retries};
    if (file->stage.backend == WEFT_STAGE_USB) {
        WEFT_TRY(create_controller(lab, error));
        parts.driver = weft_controller_driver(lab->controller);
    }
    if (file->light.backend == WEFT_LIGHT_STAGE)
        parts.lamps = weft_controller_lamps(lab->controller);
    if (file->light.backend == WEFT_LIGHT_RELAY) {
        WEFT_TRY(create_relay(lab, error));
        parts.lamps = weft_relay_lamps(lab->relay);
    }
    return weft_stage_create(&parts, &lab->stage, error);
}

/* ---- What the camera sees ---- */

/* A person does it; but a lamp that has a switch is dark without. */
static weft_code show(void *device, weft_curtain scene, weft_error *error)
{
    static const char *const asked[] = {[WEFT_CURTAIN_OPEN] = "Let the camera see the sample again.",
                                        [WEFT_CURTAIN_DARK] = "Cover the lens: no light may reach the camera.",
                                        [WEFT_CURTAIN_EVEN] =
                                            "Put an evenly lit white field, out of focus, before the whole lens."};
    weft_laboratory *lab = device;
    bool covered = lab->file.light.backend == WEFT_LIGHT_NONE, was_asked = lab->asked_to_show;
    lab->asked_to_show = scene == WEFT_CURTAIN_EVEN || (scene == WEFT_CURTAIN_DARK && covered);
    if (!lab->asked_to_show && !was_asked)
        return WEFT_OK;
    return lab->request.person.ask(lab->request.person.context, asked[scene], error);
}

/* ---- Opening ---- */

static weft_code prepare(weft_laboratory *lab, weft_error *error)
{
    WEFT_TRY(weft_rig_file_read(lab->request.rig_file, &lab->file, error));
    WEFT_TRY(read_lens(lab, error));
    WEFT_TRY(read_poses(lab, error));
    WEFT_TRY(read_lamps(lab, error));
    weft_rig_settings settings = settings_of(&lab->file, &lab->rig.calibration);
    WEFT_TRY(weft_rig_settings_check(&settings, lab->file.path, error));
    WEFT_TRY(identify(lab, error));
    WEFT_TRY(create_stage(lab, error));
    lab->sample = strdup(lab->request.sample);
    if (!lab->sample)
        return weft_fail_memory(error, "rig", 0);
    lab->rig.name = "laboratory";
    lab->rig.sample = lab->sample;
    lab->rig.identity = lab->identity;
    lab->rig.settings = settings;
    lab->rig.noise = (weft_sensor_noise){lab->file.camera.electrons_per_value, lab->file.camera.read_noise_electrons};
    lab->rig.dark_frames = (int)lab->file.camera.dark_frames;
    lab->rig.flat_frames = (int)lab->file.camera.flat_frames;
    lab->rig.curtain = (weft_rig_curtain){lab, show};
    lab->rig.seconds_per_photograph = lab->file.camera.seconds_per_photograph;
    lab->rig.stage = weft_stage_for_rig(lab->stage);
    lab->rig.light = weft_stage_light(lab->stage);
    return WEFT_OK;
}

weft_code weft_laboratory_open(const weft_laboratory_request *request, weft_laboratory **result, weft_error *error)
{
    weft_laboratory *lab = calloc(1, sizeof *lab);
    if (!lab)
        return weft_fail_memory(error, "rig", sizeof *lab);
    lab->request = *request;
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
    weft_folder_camera_free(lab->folder);
    weft_video_camera_free(lab->video);
    weft_tethered_camera_free(lab->tethered);
    weft_stage_free(lab->stage);
    weft_relay_free(lab->relay);
    weft_controller_free(lab->controller);
    free(lab->lamp);
    free(lab->sample);
    free(lab->identity);
    free(lab);
}

const char *weft_laboratory_lens(const weft_laboratory *lab)
{
    return lab->lens;
}

weft_rig *weft_laboratory_rig(weft_laboratory *lab)
{
    return &lab->rig;
}

/* ---- The camera ---- */

static weft_code release_by_stage(void *context, double exposure_s, weft_error *error)
{
    weft_laboratory *lab = context;
    (void)exposure_s;
    return weft_controller_pulse(lab->controller, lab->file.camera.pulse_s, error);
}

static weft_code release_by_hand(void *context, double exposure_s, weft_error *error)
{
    weft_laboratory *lab = context;
    char text[128];
    snprintf(text, sizeof text, "Take the photograph, exposed for %.6g s.", exposure_s);
    return lab->request.person.ask(lab->request.person.context, text, error);
}

static weft_shutter shutter_of(weft_laboratory *lab)
{
    if (lab->file.camera.trigger == WEFT_TRIGGER_STAGE)
        return (weft_shutter){lab, release_by_stage};
    if (lab->file.camera.trigger == WEFT_TRIGGER_HAND)
        return (weft_shutter){lab, release_by_hand};
    return (weft_shutter){0};
}

static weft_frame_format format_of(const weft_laboratory *lab)
{
    const weft_camera_description *camera = &lab->file.camera;
    bool by_hand = camera->shortest_exposure_s == camera->longest_exposure_s;
    return (weft_frame_format){.bin = (int)camera->bin,
                               .width = lab->rig.calibration.width,
                               .height = lab->rig.calibration.height,
                               .srgb = camera->values == WEFT_VALUES_SRGB,
                               .exposure_s = by_hand ? camera->shortest_exposure_s : 0};
}

static weft_code connect_folder(weft_laboratory *lab, weft_error *error)
{
    const weft_folder_camera_settings settings = {.folder = lab->camera_device,
                                                  .pattern = lab->file.camera.pattern,
                                                  .timeout_s = lab->file.camera.timeout_s,
                                                  .format = format_of(lab),
                                                  .shutter = shutter_of(lab),
                                                  .stop = lab->request.stop};
    WEFT_TRY(weft_rig_file_beside(&lab->file, lab->file.camera.device, lab->camera_device, sizeof lab->camera_device,
                                  error));
    WEFT_TRY(weft_folder_camera_create(&settings, &lab->folder, error));
    lab->rig.camera = weft_folder_camera_for_rig(lab->folder);
    return WEFT_OK;
}

static weft_code connect_video(weft_laboratory *lab, weft_error *error)
{
    /* Drivers of live cameras hold a few frames of before. */
    enum { HELD_FRAMES = 4 };
    const char *device = lab->file.camera.device;
    bool is_live = *device && device[strspn(device, "0123456789")] == 0;
    const weft_video_camera_settings settings = {.device = device,
                                                 .stale_frames = is_live ? HELD_FRAMES : 0,
                                                 .format = format_of(lab),
                                                 .shutter = shutter_of(lab)};
    WEFT_TRY(weft_video_camera_create(&settings, &lab->video, error));
    lab->rig.camera = weft_video_camera_for_rig(lab->video);
    return WEFT_OK;
}

static weft_code connect_tethered(weft_laboratory *lab, weft_error *error)
{
    const weft_tethered_camera_settings settings = {.port = lab->file.camera.device,
                                                    .timeout_s = lab->file.camera.timeout_s,
                                                    .format = format_of(lab),
                                                    .stop = lab->request.stop};
    WEFT_TRY(weft_tethered_camera_create(&settings, &lab->tethered, error));
    lab->rig.camera = weft_tethered_camera_for_rig(lab->tethered);
    return WEFT_OK;
}

weft_code weft_laboratory_connect(weft_laboratory *lab, weft_error *error)
{
    static weft_code (*const connect[])(weft_laboratory *, weft_error *) = {[WEFT_CAMERA_FOLDER] = connect_folder,
                                                                            [WEFT_CAMERA_VIDEO] = connect_video,
                                                                            [WEFT_CAMERA_GPHOTO2] = connect_tethered};
    return connect[lab->file.camera.backend](lab, error);
}

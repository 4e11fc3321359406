#include "capture/laboratory/lab_camera.h"

#include "base/text/json_text.h"
#include "btf/session/lens.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- What the rig file says ---- */

static weft_code read_lens(weft_lab_camera *c, weft_error *error)
{
    weft_lens lens;
    WEFT_TRY(weft_rig_file_beside(c->file, c->description->lens, c->lens, sizeof c->lens, error));
    WEFT_TRY(weft_lens_read(c->lens, &lens, error));
    c->rig.calibration = lens.camera;
    return WEFT_OK;
}

static weft_code read_colour(weft_lab_camera *c, weft_error *error)
{
    char path[PATH_MAX];
    if (!c->description->colour[0])
        return WEFT_OK;
    WEFT_TRY(weft_rig_file_beside(c->file, c->description->colour, path, sizeof path, error));
    WEFT_TRY(weft_colour_read(path, &c->colour, error));
    c->rig.colour = &c->colour;
    return WEFT_OK;
}

static weft_code read_poses(weft_lab_camera *c, weft_error *error)
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
static weft_code identify(weft_lab_camera *c, weft_error *error)
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

static weft_rig_settings settings_of(const weft_lab_camera *c)
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

/* A person does it; but a lamp that has a switch is dark without. */
static weft_code show(void *device, weft_curtain scene, weft_error *error)
{
    static const char *const asked[] = {[WEFT_CURTAIN_OPEN] = "Let the camera see the sample again.",
                                        [WEFT_CURTAIN_DARK] = "Cover the lens: no light may reach the camera.",
                                        [WEFT_CURTAIN_EVEN] =
                                            "Put an evenly lit white field, out of focus, before the whole lens."};
    weft_lab_camera *c = device;
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

/* ---- The whole ---- */

weft_code weft_lab_camera_describe(const weft_rig_file *file, int index, weft_lab_camera *c, weft_error *error)
{
    const weft_camera_description *camera = &file->camera[index];
    *c = (weft_lab_camera){.file = file, .description = camera};
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

void weft_lab_camera_free(weft_lab_camera *c)
{
    weft_folder_camera_free(c->folder);
    weft_video_camera_free(c->video);
    weft_tethered_camera_free(c->tethered);
    free(c->identity);
}

/* ---- The shutter ---- */

static weft_code release_by_stage(void *context, double exposure_s, weft_error *error)
{
    const weft_lab_camera *c = context;
    (void)exposure_s;
    return weft_controller_pulse(c->releases->controller, c->description->pulse_s, error);
}

static weft_code release_by_hand(void *context, double exposure_s, weft_error *error)
{
    const weft_lab_camera *c = context;
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

static weft_shutter shutter_of(weft_lab_camera *c)
{
    if (c->description->trigger == WEFT_TRIGGER_STAGE)
        return (weft_shutter){c, release_by_stage};
    if (c->description->trigger == WEFT_TRIGGER_HAND)
        return (weft_shutter){c, release_by_hand};
    return (weft_shutter){0};
}

/* ---- The device ---- */

static weft_frame_format format_of(const weft_lab_camera *c)
{
    const weft_camera_description *camera = c->description;
    bool by_hand = camera->shortest_exposure_s == camera->longest_exposure_s;
    return (weft_frame_format){.bin = (int)camera->bin,
                               .width = c->rig.calibration.width,
                               .height = c->rig.calibration.height,
                               .srgb = camera->values == WEFT_VALUES_SRGB,
                               .exposure_s = by_hand ? camera->shortest_exposure_s : 0};
}

static weft_code connect_folder(weft_lab_camera *c, weft_error *error)
{
    const weft_folder_camera_settings settings = {.folder = c->device,
                                                  .pattern = c->description->pattern,
                                                  .timeout_s = c->description->timeout_s,
                                                  .format = format_of(c),
                                                  .shutter = shutter_of(c),
                                                  .stop = c->stop};
    WEFT_TRY(weft_rig_file_beside(c->file, c->description->device, c->device, sizeof c->device, error));
    WEFT_TRY(weft_folder_camera_create(&settings, &c->folder, error));
    c->rig.camera = weft_folder_camera_for_rig(c->folder);
    return WEFT_OK;
}

static weft_code connect_video(weft_lab_camera *c, weft_error *error)
{
    /* Drivers of live cameras hold a few frames of before. */
    enum { HELD_FRAMES = 4 };
    const char *device = c->description->device;
    bool is_live = *device && device[strspn(device, "0123456789")] == 0;
    const weft_video_camera_settings settings = {
        .device = device, .stale_frames = is_live ? HELD_FRAMES : 0, .format = format_of(c), .shutter = shutter_of(c)};
    WEFT_TRY(weft_video_camera_create(&settings, &c->video, error));
    c->rig.camera = weft_video_camera_for_rig(c->video);
    return WEFT_OK;
}

static weft_code connect_tethered(weft_lab_camera *c, weft_error *error)
{
    const weft_tethered_camera_settings settings = {.port = c->description->device,
                                                    .timeout_s = c->description->timeout_s,
                                                    .format = format_of(c),
                                                    .stop = c->stop};
    WEFT_TRY(weft_tethered_camera_create(&settings, &c->tethered, error));
    c->rig.camera = weft_tethered_camera_for_rig(c->tethered);
    return WEFT_OK;
}

weft_code weft_lab_camera_connect(weft_lab_camera *c, weft_error *error)
{
    static weft_code (*const connect[])(weft_lab_camera *, weft_error *) = {[WEFT_CAMERA_FOLDER] = connect_folder,
                                                                            [WEFT_CAMERA_VIDEO] = connect_video,
                                                                            [WEFT_CAMERA_GPHOTO2] = connect_tethered};
    return connect[c->description->backend](c, error);
}

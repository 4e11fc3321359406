#include "capture/virtual/virtual_rig.h"

#include "capture/photograph_writer.h"
#include "capture/virtual/random.h"
#include "capture/virtual/sensor.h"
#include "capture/virtual/view.h"
#include "capture/virtual/world.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Camera, stage and light: in one structure, because a photograph depends on all three. */
typedef struct virtual_devices {
    const weft_virtual_world *world;
    const weft_virtual_sample *sample;
    weft_target target;
    char *identity;
    weft_virtual_optics optics;
    weft_virtual_sensor sensor;
    int next_viewpoint, viewpoint;
    bool homed, camera_placed, light_placed;
    bool own_light, *light_on; /* whether it burns: its own, or that of the first of several cameras */
    weft_angles view;          /* where the camera axes stand */
    weft_pose pose;
    weft_vec3 light; /* plate frame, mm */
    weft_virtual_view seen;
    bool seen_valid; /* whether `seen` belongs to this viewpoint */
    float *radiance; /* [height][width][3] under full power, where the light is placed */
    weft_curtain scene;
    float *field; /* [height][width][3] of the even field; NULL before it was seen */
} virtual_devices;

/* ---- Stage ---- */

static weft_code home(void *device, int first_viewpoint, weft_error *error)
{
    (void)error;
    virtual_devices *devices = device;
    devices->next_viewpoint = first_viewpoint;
    devices->homed = true;
    devices->camera_placed = devices->light_placed = false;
    return WEFT_OK;
}

static bool stands_at(const virtual_devices *devices, weft_angles view)
{
    return devices->camera_placed && view.theta_rad == devices->view.theta_rad && view.phi_rad == devices->view.phi_rad;
}

static void move_camera(virtual_devices *devices, weft_angles view)
{
    devices->camera_placed = true;
    devices->viewpoint = devices->next_viewpoint++;
    devices->view = view;
    devices->pose = weft_virtual_world_pose(devices->world, view, devices->viewpoint);
    devices->seen_valid = devices->light_placed = false;
}

/* What the camera sees from where it stands, under a light that stands, too. */
static weft_code look(virtual_devices *devices, weft_error *error)
{
    if (!devices->seen_valid) {
        weft_virtual_view_free(&devices->seen);
        WEFT_TRY(weft_virtual_view_make(&devices->optics, &devices->target, devices->sample, &devices->pose,
                                        &devices->seen, error));
        devices->seen_valid = true;
    }
    bool shadowed = weft_virtual_world_shadowed(devices->world, &devices->pose, devices->light) ||
                    weft_virtual_ring_shadows(devices->world, devices->view, devices->light);
    weft_virtual_view_light(&devices->seen, devices->sample, devices->light,
                            devices->world->settings.rig.light_distance_mm, shadowed ? 0 : 1, devices->radiance);
    return WEFT_OK;
}

/* The view is made here, not when it is photographed: an exposure that fails is repeated, a lack of memory is not. */
static weft_code move(void *device, weft_angles view, weft_angles light, bool *moved, weft_error *error)
{
    virtual_devices *devices = device;
    if (!devices->homed)
        return weft_fail(error, WEFT_SYSTEM, "virtual stage: the axes are not homed");
    *moved = !stands_at(devices, view);
    if (*moved)
        move_camera(devices, view);
    devices->light = weft_virtual_world_light(devices->world, light, devices->viewpoint);
    WEFT_TRY(look(devices, error));
    devices->light_placed = true;
    return WEFT_OK;
}

static weft_code turns(void *device, const weft_shot *shot, weft_turns *at, weft_error *error)
{
    (void)device;
    (void)error;
    *at = weft_turns_of_view(shot->view);
    return WEFT_OK;
}

/* ---- A ring with several cameras ---- */

static weft_code reach(void *device, weft_shot *shot, weft_error *error)
{
    const virtual_devices *devices = device;
    if (weft_virtual_ring_camera(devices->world, shot->view) == devices->world->index)
        return WEFT_OK;
    return weft_fail(error, WEFT_BAD_INPUT, "virtual stage: another camera stands at %.2f/%.2f degrees",
                     weft_deg_of_rad(shot->view.theta_rad), weft_deg_of_rad(shot->view.phi_rad));
}

static weft_code place(void *device, const weft_shot *shot, weft_place *place, weft_error *error)
{
    const virtual_devices *devices = device;
    weft_angles first = weft_virtual_ring_view(devices->world, shot->view, 0), light = shot->light_driven;
    (void)error;
    *place = (weft_place){{weft_deg_of_rad(first.theta_rad), weft_deg_of_rad(first.phi_rad),
                           weft_deg_of_rad(light.theta_rad), weft_deg_of_rad(light.phi_rad)}};
    return WEFT_OK;
}

static weft_code view_of(void *device, void *taker, const weft_shot *shot, weft_angles *view, weft_error *error)
{
    const virtual_devices *devices = device, *other = taker;
    (void)error;
    *view = weft_virtual_ring_view(other->world, shot->view, devices->world->index);
    return WEFT_OK;
}

/* ---- Light ---- */

static weft_code power_light(void *device, bool on, weft_error *error)
{
    (void)error;
    virtual_devices *devices = device;
    *devices->light_on = on;
    return WEFT_OK;
}

/* ---- What the camera sees ---- */

/* An opal glass before the lens, as bright as a white plate may be, and a little brighter on one side. */
static weft_code see_field(virtual_devices *devices, weft_error *error)
{
    const weft_virtual_optics *optics = &devices->optics;
    size_t pixels = (size_t)optics->width * (size_t)optics->height;
    const double brightness = 0.2, slope = devices->world->settings.field_slope;
    devices->field = malloc(pixels * 3 * sizeof *devices->field);
    if (!devices->field)
        return weft_fail_memory(error, "virtual camera", pixels * 3 * sizeof *devices->field);
    for (size_t i = 0; i < 3 * pixels; i++) {
        double across = (double)(i / 3 % (size_t)optics->width) / optics->width - 0.5;
        devices->field[i] = (float)(brightness * (1 + slope * across)) * optics->vignetting[i / 3];
    }
    return WEFT_OK;
}

static weft_code show(void *device, weft_curtain scene, weft_error *error)
{
    virtual_devices *devices = device;
    if (scene == WEFT_CURTAIN_EVEN && !devices->field)
        WEFT_TRY(see_field(devices, error));
    devices->scene = scene;
    return WEFT_OK;
}

/* ---- Camera ---- */

/* Shutters are timed in microseconds. */
static double shutter_time(double exposure_s)
{
    return fmax(round(exposure_s * 1e6), 1) * 1e-6;
}

static weft_code expose(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    virtual_devices *devices = device;
    const weft_virtual_settings *settings = &devices->world->settings;
    uint64_t seed = devices->world->camera_seed;
    if (weft_random_uniform(seed, WEFT_RANDOM_FAULT, frame) < settings->timeout_probability)
        return weft_fail(error, WEFT_SYSTEM, "virtual camera: frame %llu timed out", (unsigned long long)frame);
    bool sees_sample = devices->scene == WEFT_CURTAIN_OPEN;
    if (sees_sample && !devices->light_placed)
        return weft_fail(error, WEFT_SYSTEM, "virtual camera: camera and light have not been driven anywhere");
    *read_back_s = shutter_time(exposure_s);
    double drift = 1 + settings->light_power_drift * weft_random_normal(seed, WEFT_RANDOM_POWER, frame);
    bool is_lit = sees_sample ? *devices->light_on : devices->scene == WEFT_CURTAIN_EVEN;
    double gain = is_lit ? settings->sensitivity_electrons * *read_back_s * drift : 0;
    size_t count = (size_t)devices->optics.width * (size_t)devices->optics.height * 3;
    weft_virtual_sensor_read(&devices->sensor, sees_sample || !is_lit ? devices->radiance : devices->field, count, gain,
                             *read_back_s, weft_random_bits(seed, WEFT_RANDOM_NOISE, frame), samples);
    return WEFT_OK;
}

/* ---- Opening and closing ---- */

static void free_devices(virtual_devices *devices)
{
    weft_virtual_view_free(&devices->seen);
    weft_virtual_optics_free(&devices->optics);
    weft_virtual_sensor_free(&devices->sensor);
    free(devices->radiance);
    free(devices->field);
    free(devices->identity);
    free(devices);
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static weft_code identify(const weft_virtual_request *request, char **identity, weft_error *error)
{
    uint64_t bytes;
    uint32_t crc32;
    WEFT_TRY(weft_file_crc(request->sample, &bytes, &crc32, error));
    *identity = weft_virtual_settings_text(&request->settings, request->seed, base_name(request->sample), crc32);
    return *identity ? WEFT_OK : weft_fail_memory(error, "virtual rig", 0);
}

static weft_code prepare(const weft_virtual_request *request, virtual_devices *devices, weft_error *error)
{
    WEFT_TRY(identify(request, &devices->identity, error));
    WEFT_TRY(weft_virtual_optics_make(devices->world, &devices->optics, error));
    WEFT_TRY(weft_virtual_sensor_make(&devices->world->settings, devices->world->camera_seed, &devices->sensor, error));
    size_t count = (size_t)devices->optics.width * (size_t)devices->optics.height * 3;
    devices->radiance = calloc(count, sizeof *devices->radiance);
    return devices->radiance ? WEFT_OK : weft_fail_memory(error, "virtual camera", count * sizeof *devices->radiance);
}

static weft_code open_devices(const weft_virtual_request *request, weft_virtual_rig *rig, weft_error *error)
{
    virtual_devices *devices = malloc(sizeof *devices);
    if (!devices)
        return weft_fail_memory(error, "virtual rig", sizeof *devices);
    *devices = (virtual_devices){.world = &rig->world,
                                 .sample = &rig->sample,
                                 .target = weft_target_for_opening(request->settings.rig.opening_mm)};
    devices->light_on = &devices->own_light;
    weft_code code = prepare(request, devices, error);
    if (code != WEFT_OK) {
        free_devices(devices);
        return code;
    }
    rig->rig = (weft_rig){
        .name = "virtual",
        .sample = weft_virtual_sample_name(&rig->sample),
        .identity = devices->identity,
        .settings = request->settings.rig,
        .calibration = weft_rig_settings_camera(&request->settings.rig),
        .noise = {devices->sensor.electrons_per_step, devices->sensor.read_noise},
        .camera = {devices, expose},
        .stage = {.device = devices, .home = home, .move = move, .turns = request->settings.axes != 0 ? turns : NULL},
        .light = {devices, power_light},
        .dark_frames = (int)request->settings.dark_frames,
        .flat_frames = (int)request->settings.flat_frames,
        .curtain = {devices, show}};
    return WEFT_OK;
}

static weft_code open_camera(const weft_virtual_request *request, int index, weft_virtual_rig *rig, weft_error *error)
{
    *rig = (weft_virtual_rig){.world = weft_virtual_world_of_camera(&request->settings, request->seed, index)};
    WEFT_TRY(weft_virtual_sample_read(request->sample, &request->settings, request->seed, &rig->sample, rig->warning,
                                      error));
    weft_code code = open_devices(request, rig, error);
    if (code != WEFT_OK)
        weft_virtual_sample_free(&rig->sample);
    return code;
}

weft_code weft_virtual_rig_open(const weft_virtual_request *request, weft_virtual_rig *rig, weft_error *error)
{
    return open_camera(request, 0, rig, error);
}

void weft_virtual_rig_close(weft_virtual_rig *rig)
{
    free_devices(rig->rig.stage.device);
    weft_virtual_sample_free(&rig->sample);
}

/* One alone stays as it is. */
static void join(weft_virtual_rig *rigs, int count)
{
    virtual_devices *first = rigs[0].rig.camera.device;
    for (int i = 0; count > 1 && i < count; i++) {
        weft_virtual_rig *one = &rigs[i];
        virtual_devices *devices = one->rig.camera.device;
        devices->light_on = first->light_on;
        snprintf(one->camera_name, sizeof one->camera_name, "camera%d", i + 1);
        one->rig.camera_name = one->camera_name;
        one->rig.camera_model = "virtual";
        one->rig.first = &rigs[0].rig;
        one->rig.next = i + 1 < count ? &rigs[i + 1].rig : NULL;
        one->rig.stage.reach = reach;
        one->rig.stage.place = place;
        one->rig.stage.view_of = view_of;
    }
}

weft_code weft_virtual_rigs_open(const weft_virtual_request *request, weft_virtual_rig *rigs, int *count,
                                 weft_error *error)
{
    weft_code code = WEFT_OK;
    for (*count = 0; code == WEFT_OK && *count < (int)request->settings.cameras;) {
        code = open_camera(request, *count, &rigs[*count], error);
        *count += code == WEFT_OK;
    }
    while (code != WEFT_OK && *count > 0)
        weft_virtual_rig_close(&rigs[--*count]);
    if (code == WEFT_OK)
        join(rigs, *count);
    return code;
}

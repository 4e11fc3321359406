#include "capture/rig_virtual.h"

#include "capture/random.h"
#include "capture/virtual_sensor.h"
#include "capture/virtual_view.h"

#include <stdlib.h>

typedef struct virtual_rig {
    weft_virtual_world world;
    const weft_target *target;
    const weft_virtual_sample *sample;
    weft_virtual_optics optics;
    weft_virtual_sensor sensor;
    int next_stay, stay;
    bool homed, light_on, light_placed;
    weft_angles view; /* where the camera axes stand */
    weft_pose pose;
    weft_vec3 light; /* plate frame, mm */
    weft_virtual_view seen;
    bool seen_valid; /* whether `seen` belongs to this stay */
    float *radiance; /* [height][width][3] under full power, where the light is placed */
} virtual_rig;

/* ---- Stage ---- */

static weft_code move_camera(void *device, weft_angles view, bool *moved, weft_error *error)
{
    (void)error;
    virtual_rig *rig = device;
    *moved = !rig->homed || view.theta_rad != rig->view.theta_rad || view.phi_rad != rig->view.phi_rad;
    if (!*moved)
        return WEFT_OK;
    rig->homed = true;
    rig->stay = rig->next_stay++;
    rig->view = view;
    rig->pose = weft_virtual_world_pose(&rig->world, view, rig->stay);
    rig->seen_valid = rig->light_placed = false;
    return WEFT_OK;
}

/* What the camera sees from where it stands, under a light that stands, too. */
static weft_code look(virtual_rig *rig, weft_error *error)
{
    if (!rig->seen_valid) {
        weft_virtual_view_free(&rig->seen);
        WEFT_TRY(weft_virtual_view_make(&rig->optics, rig->target, rig->sample, &rig->pose, &rig->seen, error));
        rig->seen_valid = true;
    }
    bool shadowed = weft_virtual_world_shadowed(&rig->world, &rig->pose, rig->light);
    weft_virtual_view_light(&rig->seen, rig->sample, rig->light, rig->world.settings.light_distance_mm,
                            shadowed ? 0 : 1, rig->radiance);
    return WEFT_OK;
}

/* The view is made here, not when it is photographed: an exposure that fails is repeated, a lack of memory is not. */
static weft_code move_light(void *device, weft_angles light, weft_error *error)
{
    virtual_rig *rig = device;
    if (!rig->homed)
        return weft_fail(error, WEFT_SYSTEM, "virtual stage: the axes are not homed");
    rig->light = weft_virtual_world_light(&rig->world, light, rig->stay);
    WEFT_TRY(look(rig, error));
    rig->light_placed = true;
    return WEFT_OK;
}

/* ---- Light ---- */

static weft_code power_light(void *device, bool on, weft_error *error)
{
    (void)error;
    virtual_rig *rig = device;
    rig->light_on = on;
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
    virtual_rig *rig = device;
    const weft_rig_settings *settings = &rig->world.settings;
    uint64_t seed = rig->world.seed;
    if (weft_random_uniform(seed, WEFT_RANDOM_FAULT, frame) < settings->timeout_probability)
        return weft_fail(error, WEFT_SYSTEM, "virtual camera: frame %llu timed out", (unsigned long long)frame);
    if (!rig->light_placed)
        return weft_fail(error, WEFT_SYSTEM, "virtual camera: camera and light have not been driven anywhere");
    *read_back_s = shutter_time(exposure_s);
    double drift = 1 + settings->light_power_drift * weft_random_normal(seed, WEFT_RANDOM_POWER, frame);
    double gain = rig->light_on ? settings->sensitivity_electrons * *read_back_s * drift : 0;
    size_t count = (size_t)rig->optics.width * (size_t)rig->optics.height * 3;
    weft_virtual_sensor_read(&rig->sensor, rig->radiance, count, gain, weft_random_bits(seed, WEFT_RANDOM_NOISE, frame),
                             samples);
    return WEFT_OK;
}

/* ---- Opening and closing ---- */

static void close_rig(void *back_end)
{
    virtual_rig *rig = back_end;
    weft_virtual_view_free(&rig->seen);
    weft_virtual_optics_free(&rig->optics);
    weft_virtual_sensor_free(&rig->sensor);
    free(rig->radiance);
    free(rig);
}

static weft_code prepare(virtual_rig *rig, weft_error *error)
{
    WEFT_TRY(weft_virtual_optics_make(&rig->world, &rig->optics, error));
    WEFT_TRY(weft_virtual_sensor_make(&rig->world.settings, &rig->sensor, error));
    size_t bytes = (size_t)rig->optics.width * (size_t)rig->optics.height * 3 * sizeof *rig->radiance;
    rig->radiance = malloc(bytes);
    return rig->radiance ? WEFT_OK : weft_fail_memory(error, "virtual camera", bytes);
}

weft_code weft_rig_virtual_open(const weft_virtual_world *world, const weft_target *target,
                                const weft_virtual_sample *sample, int first_stay, weft_rig *rig, weft_error *error)
{
    virtual_rig *back_end = calloc(1, sizeof *back_end);
    if (!back_end)
        return weft_fail_memory(error, "virtual rig", sizeof *back_end);
    back_end->world = *world;
    back_end->target = target;
    back_end->sample = sample;
    back_end->next_stay = first_stay;
    weft_code code = prepare(back_end, error);
    if (code != WEFT_OK) {
        close_rig(back_end);
        return code;
    }
    *rig = (weft_rig){.camera = {back_end, expose},
                      .stage = {back_end, move_camera, move_light},
                      .light = {back_end, power_light},
                      .back_end = back_end,
                      .close = close_rig};
    return WEFT_OK;
}

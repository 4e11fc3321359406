#include "capture/settings.h"

#include "btf/json_text.h"
#include "geometry/stitch_sample.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SETTINGS_BYTES = 1 << 20 };

/* Name, place, default and bounds of every setting. */
typedef struct setting {
    const char *name;
    size_t offset;
    double value, low, high;
    bool whole;
} setting;

#define REAL(name, value, low, high)                                                                                   \
    {                                                                                                                  \
#name, offsetof(weft_rig_settings, name), value, low, high, false                                              \
    }
#define WHOLE(name, value, low, high)                                                                                  \
    {                                                                                                                  \
#name, offsetof(weft_rig_settings, name), value, low, high, true                                               \
    }

static const setting table[] = {
    WHOLE(width_px, 416, 32, 8192),
    WHOLE(height_px, 416, 32, 8192),
    REAL(focal_length_px, 1920, 10, 1e6),
    REAL(k1, -0.5, -2, 2),
    REAL(k2, 1, -10, 10),
    REAL(vignetting_r2, -6, -20, 0),
    REAL(vignetting_r4, 20, -100, 100),
    REAL(vignetting_r6, 0, -100, 100),
    WHOLE(bits, 12, 10, 16),
    WHOLE(black_level, 64, 0, 1023),
    REAL(opening_mm, 32, 1, 1000),
    REAL(camera_distance_mm, 500, 10, 1e5),
    REAL(light_distance_mm, 650, 10, 1e5),
    REAL(camera_half_angle_deg, 4, 0, 30),
    REAL(shortest_exposure_s, 1.0 / 4000, 1e-6, 10),
    REAL(longest_exposure_s, 2, 1e-6, 3600),
    WHOLE(retries, 3, 0, 20),
    REAL(full_well_electrons, 240000, 100, 1e7),
    REAL(read_noise_electrons, 10, 0, 1000),
    REAL(sensitivity_electrons, 2e7, 1, 1e12),
    REAL(aperture_mm, 4, 0, 100),
    WHOLE(samples_per_pixel, 12, 1, 64),
    REAL(focal_length_error, 0.0005, -0.1, 0.1),
    REAL(principal_point_error_px, 0.2, 0, 10),
    REAL(k1_error, 0.02, -0.5, 0.5),
    REAL(mounting_rotation_deg, 0.3, 0, 5),
    REAL(mounting_translation_mm, 0.3, 0, 10),
    REAL(stay_rotation_deg, 0.05, 0, 5),
    REAL(stay_translation_mm, 0.1, 0, 10),
    REAL(light_rotation_deg, 0.05, 0, 5),
    REAL(light_power_drift, 0.002, 0, 0.1),
    REAL(timeout_probability, 0, 0, 0.9),
    WHOLE(tiles_x, 0, 0, 10000),
    WHOLE(tiles_y, 0, 0, 10000),
    WHOLE(cloth_noise, 1, 0, 1),
    WHOLE(bounces, 3, 0, WEFT_STITCH_SAMPLE_MAX_BOUNCES),
};

enum { SETTING_COUNT = sizeof table / sizeof table[0] };

static double *place_of(weft_rig_settings *settings, const setting *entry)
{
    return (double *)((char *)settings + entry->offset);
}

weft_rig_settings weft_rig_settings_default(void)
{
    weft_rig_settings settings;
    for (int i = 0; i < SETTING_COUNT; i++)
        *place_of(&settings, &table[i]) = table[i].value;
    return settings;
}

/* ---- Reading ---- */

static const setting *find_setting(const char *name)
{
    for (int i = 0; i < SETTING_COUNT; i++) {
        if (strcmp(table[i].name, name) == 0)
            return &table[i];
    }
    return NULL;
}

static weft_code read_setting(const char *path, const char *name, json_t *json, weft_rig_settings *settings,
                              weft_error *error)
{
    const setting *entry = find_setting(name);
    if (!entry)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': there is no setting '%s'", path, name);
    double value = json_number_value(json);
    if (!json_is_number(json) || !(value >= entry->low && value <= entry->high) ||
        (entry->whole && value != floor(value)))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': '%s' must be a %snumber from %g to %g", path, name,
                         entry->whole ? "whole " : "", entry->low, entry->high);
    *place_of(settings, entry) = value;
    return WEFT_OK;
}

static weft_code read_settings(const char *path, json_t *root, weft_rig_settings *settings, weft_error *error)
{
    const char *name, *rig = json_string_value(json_object_get(root, "rig"));
    json_t *value;
    if (!json_is_object(root) || !rig)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is not a JSON object with a key 'rig'", path);
    if (strcmp(rig, "virtual") != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': this build has no rig '%s', only 'virtual'", path, rig);
    json_object_foreach(root, name, value)
    {
        if (strcmp(name, "rig") != 0)
            WEFT_TRY(read_setting(path, name, value, settings, error));
    }
    return WEFT_OK;
}

/* Bounds that tie two settings together. */
static weft_code check_settings(const char *path, const weft_rig_settings *s, weft_error *error)
{
    if (s->longest_exposure_s < s->shortest_exposure_s)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': the longest exposure, %g s, is below the shortest, %g s", path,
                         s->longest_exposure_s, s->shortest_exposure_s);
    if (s->light_distance_mm <= s->camera_distance_mm)
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "'%s': the light (%g mm) must be farther away than the camera (%g mm), or it stands in the view", path,
            s->light_distance_mm, s->camera_distance_mm);
    double radius = weft_target_radius_mm(&(weft_target){.opening_mm = s->opening_mm});
    if (s->camera_distance_mm <= 2 * radius)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': the camera is %g mm away from a plate of radius %g mm", path,
                         s->camera_distance_mm, radius);
    return WEFT_OK;
}

weft_code weft_rig_settings_read(const char *path, weft_rig_settings *settings, weft_error *error)
{
    json_t *root = NULL;
    WEFT_TRY(weft_json_read(path, MAX_SETTINGS_BYTES, &root, error));
    weft_code code = read_settings(path, root, settings, error);
    json_decref(root);
    if (code == WEFT_OK)
        code = check_settings(path, settings, error);
    return code;
}

/* ---- Writing ---- */

char *weft_rig_settings_text(const weft_rig_settings *settings, uint64_t seed, const char *sample_file,
                             uint32_t sample_crc32)
{
    json_t *root =
        json_pack("{sI so sI}", "seed", (json_int_t)seed, "sample_file",
                  weft_json_text(sample_file, strlen(sample_file)), "sample_crc32", (json_int_t)sample_crc32);
    for (int i = 0; root && i < SETTING_COUNT; i++) {
        double value = *place_of((weft_rig_settings *)settings, &table[i]);
        weft_json_put(&root, table[i].name, table[i].whole ? json_integer((json_int_t)value) : json_real(value));
    }
    char *text = root ? json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(15)) : NULL;
    json_decref(root);
    return text;
}

weft_camera weft_rig_settings_camera(const weft_rig_settings *s)
{
    return (weft_camera){
        .width = (int)s->width_px,
        .height = (int)s->height_px,
        .fx = s->focal_length_px,
        .fy = s->focal_length_px,
        .cx = (s->width_px - 1) / 2,
        .cy = (s->height_px - 1) / 2,
        .k1 = s->k1,
        .k2 = s->k2,
        .vignetting = {s->vignetting_r2, s->vignetting_r4, s->vignetting_r6},
    };
}

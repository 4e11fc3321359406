#include "capture/settings.h"

#include "base/text/json_text.h"

#include <math.h>
#include <string.h>

enum { MAX_SETTINGS_BYTES = 1 << 20 };

#define REAL(name, value, low, high) WEFT_SETTING(weft_rig_settings, name, value, low, high, false)
#define WHOLE(name, value, low, high) WEFT_SETTING(weft_rig_settings, name, value, low, high, true)

static const weft_rig_setting table[] = {
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
};

weft_setting_group weft_rig_settings_group(weft_rig_settings *settings)
{
    return (weft_setting_group){table, sizeof table / sizeof *table, settings};
}

weft_rig_settings weft_rig_settings_default(void)
{
    weft_rig_settings settings;
    weft_setting_group group = weft_rig_settings_group(&settings);
    weft_setting_group_reset(&group);
    return settings;
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

weft_code weft_rig_settings_check(const weft_rig_settings *s, const char *path, weft_error *error)
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

/* ---- Settings by name ---- */

static double *place_of(const weft_setting_group *group, const weft_rig_setting *setting)
{
    return (double *)((char *)group->values + setting->offset);
}

void weft_setting_group_reset(const weft_setting_group *group)
{
    for (int i = 0; i < group->count; i++)
        *place_of(group, &group->setting[i]) = group->setting[i].value;
}

/* The setting of that name and its group; NULL where there is none. */
static const weft_rig_setting *find_setting(const weft_setting_group *groups, int group_count, const char *name,
                                            const weft_setting_group **group)
{
    for (*group = groups; *group < groups + group_count; (*group)++) {
        for (int i = 0; i < (*group)->count; i++) {
            if (strcmp((*group)->setting[i].name, name) == 0)
                return &(*group)->setting[i];
        }
    }
    return NULL;
}

static weft_code read_setting(const char *path, const char *name, const json_t *json, const weft_setting_group *groups,
                              int group_count, weft_error *error)
{
    const weft_setting_group *group;
    const weft_rig_setting *setting = find_setting(groups, group_count, name, &group);
    if (!setting)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': there is no setting '%s'", path, name);
    double value = json_number_value(json);
    if (!json_is_number(json) || !(value >= setting->low && value <= setting->high) ||
        (setting->whole && value != floor(value)))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': '%s' must be a %snumber from %g to %g", path, name,
                         setting->whole ? "whole " : "", setting->low, setting->high);
    *place_of(group, setting) = value;
    return WEFT_OK;
}

void weft_settings_rename_former(json_t *object)
{
    static const char *const names[][2] = {{"stay_rotation_deg", "viewpoint_rotation_deg"},
                                           {"stay_translation_mm", "viewpoint_translation_mm"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        json_t *value = json_object_get(object, names[i][0]);
        if (value && json_object_set(object, names[i][1], value) == 0)
            json_object_del(object, names[i][0]);
    }
}

static weft_code read_settings(const char *path, json_t *root, const char *rig, const weft_setting_group *groups,
                               int group_count, weft_error *error)
{
    const char *name, *found = json_string_value(json_object_get(root, "rig"));
    json_t *value;
    if (!json_is_object(root) || !found)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is not a JSON object with a key 'rig'", path);
    if (strcmp(found, rig) != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': this build has no rig '%s', only '%s'", path, found, rig);
    weft_settings_rename_former(root);
    json_object_foreach (root, name, value) {
        if (strcmp(name, "rig") != 0)
            WEFT_TRY(read_setting(path, name, value, groups, group_count, error));
    }
    return WEFT_OK;
}

weft_code weft_setting_groups_read(const char *path, const char *rig, const weft_setting_group *groups, int group_count,
                                   weft_error *error)
{
    json_t *root = NULL;
    WEFT_TRY(weft_json_read(path, MAX_SETTINGS_BYTES, &root, error));
    weft_code code = read_settings(path, root, rig, groups, group_count, error);
    json_decref(root);
    return code;
}

void weft_setting_group_write(const weft_setting_group *group, json_t **object)
{
    for (int i = 0; i < group->count; i++) {
        const weft_rig_setting *setting = &group->setting[i];
        double value = *place_of(group, setting);
        weft_json_put(object, setting->name, setting->whole ? json_integer((json_int_t)value) : json_real(value));
    }
}

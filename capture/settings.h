/* Settings of a rig of any kind: how it is calibrated and set up and how it exposes; and how settings are read and
 * written. A file of settings is a JSON object whose keys are the names of the fields;
 * docs/reference/session-format.md lists them. */
#ifndef WEFT_CAPTURE_SETTINGS_H
#define WEFT_CAPTURE_SETTINGS_H

#include "btf/session/session.h"

#include <jansson.h>
#include <stddef.h>

typedef struct weft_rig_settings {
    /* The camera as calibrated (btf/session/camera.h); the principal point is the centre of the photograph. */
    double width_px, height_px, focal_length_px;
    double k1, k2;
    double vignetting_r2, vignetting_r4, vignetting_r6;
    double bits, black_level;
    /* The set-up. */
    double opening_mm;
    double camera_distance_mm, light_distance_mm;
    double camera_half_angle_deg; /* half the angle that the camera covers, seen from the sample */
    /* Exposure. */
    double shortest_exposure_s, longest_exposure_s;
    double retries; /* of an exposure that the camera did not deliver */
} weft_rig_settings;

/* Those of the virtual rig as it stands in Weft. */
weft_rig_settings weft_rig_settings_default(void);

/* The camera as calibrated. Pure. */
weft_camera weft_rig_settings_camera(const weft_rig_settings *settings);

/* Bounds that tie two settings together. Errors: WEFT_BAD_INPUT naming the file `path`. */
weft_code weft_rig_settings_check(const weft_rig_settings *settings, const char *path, weft_error *error);

/* ---- Settings by name ---- */

/* Name, place, default and bounds of a number, which is a double in the structure of its group. */
typedef struct weft_rig_setting {
    const char *name;
    size_t offset; /* bytes from the start of the structure */
    double value, low, high;
    bool whole;
} weft_rig_setting;

/* The setting of a field of `structure`. */
#define WEFT_SETTING(structure, field, default_value, least, most, is_whole)                                           \
    {                                                                                                                  \
        .name = #field, .offset = offsetof(structure, field), .value = (default_value), .low = (least),                \
        .high = (most), .whole = (is_whole)                                                                            \
    }

/* Settings, and the structure that holds their values (borrowed). A rig has the group below and those that its back
 * end adds. */
typedef struct weft_setting_group {
    const weft_rig_setting *setting;
    int count;
    void *values;
} weft_setting_group;

weft_setting_group weft_rig_settings_group(weft_rig_settings *settings);

/* Gives every setting its default. */
void weft_setting_group_reset(const weft_setting_group *group);

/* Overrides the values of `groups` by the numbers of a JSON file, whose key "rig" must be the name `rig`. Errors:
 * WEFT_BAD_INPUT naming the file and the key, for an unknown key or a value out of its bounds. */
weft_code weft_setting_groups_read(const char *path, const char *rig, const weft_setting_group *groups, int group_count,
                                   weft_error *error);

/* Gives settings of a JSON object that were called otherwise before 0.2 the names that they have now. */
void weft_settings_rename_former(json_t *object);

/* Adds every setting to a JSON object. */
void weft_setting_group_write(const weft_setting_group *group, json_t **object);

#endif

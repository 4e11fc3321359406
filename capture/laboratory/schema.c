#include "capture/laboratory/rig_file.h"

#include "btf/session/session.h"

#include <string.h>

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))
#define KEY(type, field, ...)                                                                                          \
    {                                                                                                                  \
        .name = #field, .offset = offsetof(type, field), __VA_ARGS__                                                   \
    }
#define NUMBER(type, field, usual, least, most)                                                                        \
    KEY(type, field, .kind = WEFT_KEY_NUMBER, .value = (usual), .low = (least), .high = (most))
#define WHOLE(type, field, usual, least, most)                                                                         \
    KEY(type, field, .kind = WEFT_KEY_WHOLE, .value = (usual), .low = (least), .high = (most))
#define NEEDED(type, field, least, most)                                                                               \
    KEY(type, field, .kind = WEFT_KEY_NUMBER, .required = true, .low = (least), .high = (most))
#define TEXT(type, field, usual) KEY(type, field, .kind = WEFT_KEY_TEXT, .text = (usual))
#define WORD(type, field, must, usual, list)                                                                           \
    KEY(type, field, .kind = WEFT_KEY_WORD, .required = (must), .text = (usual), .words = (list))
#define FLAG(type, field) KEY(type, field, .kind = WEFT_KEY_FLAG)

static const char *const stage_words[] = {"usb", "none", NULL};
static const char *const light_words[] = {"stage", "relay", "none", NULL};
static const char *const camera_words[] = {"folder", "video", "gphoto2", NULL};
static const char *const trigger_words[] = {"none", "stage", "hand", NULL};
static const char *const value_words[] = {"linear", "srgb", NULL};

static const weft_rig_key file_keys[] = {
    KEY(weft_rig_file, name, .kind = WEFT_KEY_TEXT, .required = true),
    NEEDED(weft_rig_file, opening_mm, 1, 1000),
    TEXT(weft_rig_file, poses, ""),
};

static const weft_rig_key axis_keys[] = {
    WORD(weft_axis, moves, true, NULL, weft_body_name),
    WORD(weft_axis, angle, true, NULL, weft_turn_name),
    KEY(weft_axis, channel, .kind = WEFT_KEY_INT, .high = WEFT_AXES_MAX - 1),
    NEEDED(weft_axis, low_deg, -3600, 3600),
    NEEDED(weft_axis, high_deg, -3600, 3600),
    NUMBER(weft_axis, zero_deg, 0, -3600, 3600),
    FLAG(weft_axis, reversed),
    FLAG(weft_axis, by_hand),
    NUMBER(weft_axis, speed_deg_s, 10, 1e-3, 1e4),
    NUMBER(weft_axis, acceleration_deg_s2, 20, 1e-3, 1e6),
    NUMBER(weft_axis, settle_s, 0.5, 0, 600),
    NUMBER(weft_axis, backlash_deg, 0, 0, 30),
    FLAG(weft_axis, approach_down),
};

static const weft_rig_key stage_keys[] = {
    WORD(weft_stage_description, backend, true, NULL, stage_words),
    WHOLE(weft_stage_description, usb_vendor, 0x1209, 0, 0xffff),
    WHOLE(weft_stage_description, usb_product, 0xb7f1, 0, 0xffff),
    TEXT(weft_stage_description, usb_serial, ""),
    FLAG(weft_stage_description, one_by_one),
    NUMBER(weft_stage_description, tolerance_deg, 0.01, 1e-3, 1),
    NUMBER(weft_stage_description, timeout_s, 0.5, 0.01, 60),
    WHOLE(weft_stage_description, retries, 3, 0, 20),
    NUMBER(weft_stage_description, replug_s, 60, 0, 86400),
    NUMBER(weft_stage_description, poll_s, 0.02, 0, 1),
};

static const weft_rig_key light_keys[] = {
    WORD(weft_light_description, backend, true, NULL, light_words),
    WHOLE(weft_light_description, usb_vendor, 0x16c0, 0, 0xffff),
    WHOLE(weft_light_description, usb_product, 0x05df, 0, 0xffff),
    TEXT(weft_light_description, usb_serial, ""),
    TEXT(weft_light_description, lamps, ""),
    NUMBER(weft_light_description, theta_deg, 0, 0, 90),
    NUMBER(weft_light_description, phi_deg, 0, -360, 360),
    NEEDED(weft_light_description, distance_mm, 10, 1e5),
    NUMBER(weft_light_description, lamp_tolerance_deg, 2, 0, 45),
    NUMBER(weft_light_description, level, 1, 0, 1),
    NUMBER(weft_light_description, warm_up_s, 0, 0, 3600),
};

static const weft_rig_key camera_keys[] = {
    WORD(weft_camera_description, backend, true, NULL, camera_words),
    WORD(weft_camera_description, trigger, false, "none", trigger_words),
    WORD(weft_camera_description, values, false, "linear", value_words),
    TEXT(weft_camera_description, device, ""),
    TEXT(weft_camera_description, pattern, "*"),
    KEY(weft_camera_description, lens, .kind = WEFT_KEY_TEXT, .required = true),
    TEXT(weft_camera_description, name, ""),
    TEXT(weft_camera_description, model, ""),
    TEXT(weft_camera_description, colour, ""),
    TEXT(weft_camera_description, poses, ""),
    NUMBER(weft_camera_description, theta_deg, 0, 0, 90),
    NUMBER(weft_camera_description, phi_deg, 0, -360, 360),
    NEEDED(weft_camera_description, distance_mm, 10, 1e5),
    NUMBER(weft_camera_description, half_angle_deg, 4, 0, 30),
    WHOLE(weft_camera_description, bin, 1, 1, 64),
    WHOLE(weft_camera_description, black_level, 0, 0, 1023),
    NUMBER(weft_camera_description, electrons_per_value, 1, 1e-3, 1e5),
    NUMBER(weft_camera_description, read_noise_electrons, 10, 0, 1e5),
    WHOLE(weft_camera_description, dark_frames, 0, 0, WEFT_SESSION_MAX_FRAMES),
    WHOLE(weft_camera_description, flat_frames, 0, 0, WEFT_SESSION_MAX_FRAMES),
    NUMBER(weft_camera_description, shortest_exposure_s, 1.0 / 4000, 1e-6, 3600),
    NUMBER(weft_camera_description, longest_exposure_s, 2, 1e-6, 3600),
    WHOLE(weft_camera_description, retries, 3, 0, 20),
    NUMBER(weft_camera_description, timeout_s, 30, 0.01, 3600),
    NUMBER(weft_camera_description, seconds_per_photograph, 2, 1e-3, 3600),
    NUMBER(weft_camera_description, pulse_s, 0.1, 1e-3, 60),
};

const weft_rig_section weft_rig_schema[WEFT_RIG_SECTION_COUNT] = {
    {"", 0, file_keys, COUNT(file_keys)},
    {"axis", 0, axis_keys, COUNT(axis_keys)},
    {"stage", offsetof(weft_rig_file, stage), stage_keys, COUNT(stage_keys)},
    {"light", offsetof(weft_rig_file, light), light_keys, COUNT(light_keys)},
    {"camera", 0, camera_keys, COUNT(camera_keys)},
};

const weft_rig_key *weft_rig_key_find(const char *section, const char *name)
{
    for (const weft_rig_section *s = weft_rig_schema; s < weft_rig_schema + WEFT_RIG_SECTION_COUNT; s++) {
        for (int k = 0; strcmp(s->name, section) == 0 && k < s->key_count; k++) {
            if (strcmp(s->key[k].name, name) == 0)
                return &s->key[k];
        }
    }
    return NULL;
}

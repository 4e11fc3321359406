/* A rig as its owner describes it: RIG.conf (docs/reference/rig-file.md). */
#ifndef WEFT_CAPTURE_LABORATORY_RIG_FILE_H
#define WEFT_CAPTURE_LABORATORY_RIG_FILE_H

#include "btf/session/camera_list.h"
#include "capture/axes/axes.h"

#include <stddef.h>

enum { WEFT_RIG_TEXT_SIZE = 256 };

typedef enum weft_stage_backend { WEFT_STAGE_USB, WEFT_STAGE_NONE } weft_stage_backend;
typedef enum weft_light_backend { WEFT_LIGHT_STAGE, WEFT_LIGHT_RELAY, WEFT_LIGHT_NONE } weft_light_backend;
typedef enum weft_camera_backend { WEFT_CAMERA_FOLDER, WEFT_CAMERA_VIDEO, WEFT_CAMERA_GPHOTO2 } weft_camera_backend;
typedef enum weft_camera_trigger { WEFT_TRIGGER_NONE, WEFT_TRIGGER_STAGE, WEFT_TRIGGER_HAND } weft_camera_trigger;
typedef enum weft_camera_values { WEFT_VALUES_LINEAR, WEFT_VALUES_SRGB } weft_camera_values;

typedef struct weft_stage_description {
    weft_stage_backend backend;
    double usb_vendor, usb_product;
    char usb_serial[WEFT_RIG_TEXT_SIZE]; /* empty: any */
    bool one_by_one;
    double tolerance_deg, timeout_s, retries, replug_s, poll_s;
} weft_stage_description;

typedef struct weft_light_description {
    weft_light_backend backend;
    double usb_vendor, usb_product;
    char usb_serial[WEFT_RIG_TEXT_SIZE]; /* empty: any */
    char lamps[WEFT_RIG_TEXT_SIZE];      /* table of their directions, beside the rig file; empty: one light */
    double theta_deg, phi_deg, distance_mm, lamp_tolerance_deg, level, warm_up_s;
} weft_light_description;

typedef struct weft_camera_description {
    weft_camera_backend backend;
    weft_camera_trigger trigger;
    weft_camera_values values;
    char device[WEFT_RIG_TEXT_SIZE];  /* folder, video device or port */
    char pattern[WEFT_RIG_TEXT_SIZE]; /* of file names in the folder */
    char lens[WEFT_RIG_TEXT_SIZE];    /* its calibration, beside the rig file */
    char name[WEFT_RIG_TEXT_SIZE];    /* of one of several */
    char model[WEFT_RIG_TEXT_SIZE];   /* cameras of one model see the same colours; empty: not known */
    char colour[WEFT_RIG_TEXT_SIZE];  /* its colours under the lamp, beside the rig file; empty: not known */
    char poses[WEFT_RIG_TEXT_SIZE];   /* where the axes truly put it, beside the rig file; empty: not known */
    double theta_deg, phi_deg, distance_mm, half_angle_deg;
    double electrons_per_value, read_noise_electrons, dark_frames, flat_frames;
    double bin, black_level, shortest_exposure_s, longest_exposure_s, retries, timeout_s, seconds_per_photograph,
        pulse_s;
} weft_camera_description;

typedef struct weft_rig_file {
    char path[WEFT_RIG_TEXT_SIZE];
    char name[WEFT_RIG_TEXT_SIZE];
    char poses[WEFT_RIG_TEXT_SIZE]; /* of the camera, where there is one, and its section names none */
    double opening_mm;
    weft_axes axes;
    weft_stage_description stage;
    weft_light_description light;
    int camera_count;
    weft_camera_description camera[WEFT_CAMERAS_MAX]; /* [camera_count] */
} weft_rig_file;

/* Reads and checks. Not thread-safe. Errors: WEFT_BAD_INPUT "PATH:LINE: ..." for what is no rig file, an unknown or
 * missing key, or a value out of its bounds; "PATH: ..." for parts that do not go together; WEFT_SYSTEM for memory. */
weft_code weft_rig_file_read(const char *path, weft_rig_file *rig, weft_error *error);

/* A file that a rig file names, beside it; `path` holds `size` bytes. Errors: WEFT_BAD_INPUT where that is too long. */
weft_code weft_rig_file_beside(const weft_rig_file *rig, const char *name, char *path, size_t size, weft_error *error);

/* ---- The keys: what each section may hold, and where it goes ---- */

typedef enum weft_key_kind {
    WEFT_KEY_NUMBER, /* double from low to high */
    WEFT_KEY_WHOLE,  /* the same, a whole number */
    WEFT_KEY_INT,    /* int from low to high */
    WEFT_KEY_TEXT,   /* char[WEFT_RIG_TEXT_SIZE] */
    WEFT_KEY_WORD,   /* an enum that counts from 0: one of `words` */
    WEFT_KEY_FLAG    /* bool: "yes" or "no" */
} weft_key_kind;

typedef struct weft_rig_key {
    const char *name;
    weft_key_kind kind;
    size_t offset; /* in the section's structure */
    bool required;
    double value, low, high; /* default and bounds */
    const char *text;        /* default of texts and words */
    const char *const *words;
} weft_rig_key;

typedef struct weft_rig_section {
    const char *name; /* "" for the file itself */
    size_t offset;    /* of its structure in weft_rig_file; of an axis: in weft_axis; of a camera:
                         in weft_camera_description */
    const weft_rig_key *key;
    int key_count;
} weft_rig_section;

enum { WEFT_RIG_SECTION_COUNT = 5, WEFT_RIG_KEYS_MAX = 32 };

/* The file itself, axis, stage, light, camera. */
extern const weft_rig_section weft_rig_schema[WEFT_RIG_SECTION_COUNT];

/* The key of that name in the section of that name, or NULL. */
const weft_rig_key *weft_rig_key_find(const char *section, const char *name);

#endif

/* The session: what capture hands to registration. A folder with
 *   session.json   what was planned, with which rig and calibration (docs/reference/session-format.md)
 *   journal.jsonl  one line for every photograph taken, appended after the photograph is complete
 *   sensor/...     frames of the sensor, where the rig takes any
 *   tvTTT_pvPPP/tlTTT_plPPP_tvTTT_pvPPP.tif  the photographs, raw linear camera values
 * A shot exists when its photograph lies under its final name and its journal line is complete. */
#ifndef WEFT_BTF_SESSION_SESSION_H
#define WEFT_BTF_SESSION_SESSION_H

#include "base/status.h"
#include "btf/session/colour.h"
#include "btf/session/rig_poses.h"
#include "btf/session/target.h"

#include <stdbool.h>
#include <stdint.h>

enum { WEFT_SESSION_MAX_SHOTS = 1000000, WEFT_SESSION_MAX_BRACKETS = 4, WEFT_SESSION_MAX_FRAMES = 256 };

/* One planned photograph. */
typedef struct weft_shot {
    weft_angles light, view;  /* of the grid: they name the file */
    weft_angles light_driven; /* where the light is really sent; differs where the camera would stand in its way */
} weft_shot;

/* One more photograph of a shot, with another exposure. */
typedef struct weft_bracket_record {
    double exposure_s;
    uint64_t bytes;
    uint32_t crc32;
} weft_bracket_record;

/* What the journal says of a shot. */
typedef struct weft_shot_record {
    bool taken;
    int viewpoint; /* counts the moves of the camera axes, below WEFT_SESSION_MAX_SHOTS: photographs of one viewpoint
                 share one pose */
    double exposure_s;
    uint64_t bytes; /* size of the file */
    uint32_t crc32; /* of its bytes */
    int line;       /* of the journal, from 1, as it was opened; 0: appended since */
    int bracket_count;
    weft_bracket_record bracket[WEFT_SESSION_MAX_BRACKETS];
} weft_shot_record;

/* What the camera alone is photographed for, before the shots: the faults of its sensor. */
typedef enum weft_frame_kind {
    WEFT_FRAME_DARK_BRIEF, /* without light, as briefly as the rig exposes */
    WEFT_FRAME_DARK_LONG,  /* without light, as long as it exposes */
    WEFT_FRAME_FLAT        /* of an even field */
} weft_frame_kind;

/* What the journal says of such a frame. */
typedef struct weft_frame_record {
    bool taken;
    double exposure_s;
    uint64_t bytes;
    uint32_t crc32;
} weft_frame_record;

/* How much a raw value of the camera varies: by shot noise, by read noise and by rounding. */
typedef struct weft_sensor_noise {
    double electrons_per_value;  /* 0: not known */
    double read_noise_electrons; /* standard deviation */
} weft_sensor_noise;

typedef struct weft_session {
    char *folder;
    char *rig;                                    /* name of the back end */
    char *sample;                                 /* name of the sample, for the report */
    char *rig_settings;                           /* JSON text of the back end's own settings (seed, ...) */
    weft_camera camera;                           /* as calibrated */
    double camera_distance_mm, light_distance_mm; /* as set up */
    int bits;                                     /* of the raw values; full scale is 2^bits - 1 */
    int black_level;                              /* raw value of no light */
    weft_sensor_noise noise;
    weft_target target;
    weft_colour colour; /* of the camera under the lamp; terms 0: not known */
    char *camera_model; /* cameras of one model see the same colours; NULL: not known */
    int shot_count;
    weft_shot *shot;          /* [shot_count], in the order of the plan */
    weft_shot_record *record; /* [shot_count] */
    weft_turns *turns;        /* [shot_count] of the axes of camera and sample; NULL: not known */
    weft_motion *pose;        /* [shot_count] where the rig is known to put the camera; NULL: as the view says */
    int dark_frames;          /* of each of the two exposures; 0: none */
    int flat_frames;
    weft_frame_record *frame; /* [weft_session_frame_count] of an open session; NULL where there are none */
} weft_session;

/* Where the rig promises the camera for a view: the pose of the first shot of it, or where nothing better is known,
 * that of a camera as set up. Pure. */
weft_pose weft_session_pose(const weft_session *session, weft_angles view);

/* Writes session.json atomically into session->folder, which must exist. Errors: WEFT_SYSTEM. */
weft_code weft_session_create(const weft_session *session, weft_error *error);

/* Reads session.json and the journal. A last journal line that is cut is ignored (the process died while it
 * wrote); any other malformed line is an error. The caller frees with weft_session_free.
 * Errors: WEFT_BAD_INPUT naming the file, and the line in the journal. */
weft_code weft_session_open(const char *folder, weft_session *session, weft_error *error);
void weft_session_free(weft_session *session);

/* Fills session->record from the journal in session->folder; no journal means no photographs. A shot named twice keeps
 * its last line. A last line without its newline is ignored. Errors: WEFT_BAD_INPUT naming file and line. */
weft_code weft_journal_read(weft_session *session, weft_error *error);

/* Path of the photograph of a shot inside the folder; `path` holds at least `size` bytes. Pure. */
void weft_session_photograph_path(const weft_session *session, int shot, char *path, int size);

/* The same for bracket `bracket` of a shot: "NAME.bracket1.tif" and so on. Pure. */
void weft_session_bracket_path(const weft_session *session, int shot, int bracket, char *path, int size);

/* Frames of the sensor that belong to the session: the brief dark ones, the long dark ones, then the flat ones. Pure.
 */
int weft_session_frame_count(const weft_session *session);
weft_frame_kind weft_session_frame_kind(const weft_session *session, int frame);

/* "sensor/dark_brief_001.tif" and so on. Pure. */
void weft_session_frame_path(const weft_session *session, int frame, char *path, int size);

/* Appends a frame of the sensor to the journal, as below. Errors: WEFT_SYSTEM. */
weft_code weft_session_append_frame(weft_session *session, int frame, const weft_frame_record *record,
                                    weft_error *error);

/* Appends a shot to the journal with one write() and updates session->record[shot]. A cut last line left by a
 * crash is removed first. Errors: WEFT_SYSTEM. */
weft_code weft_session_append(weft_session *session, int shot, const weft_shot_record *record, weft_error *error);

/* Waits until the lines of the journal, and the names in the folder of the session, are on the disk. Errors:
 * WEFT_SYSTEM. */
weft_code weft_session_sync(const weft_session *session, weft_error *error);

#endif

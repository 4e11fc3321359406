/* A path of camera and light through time: key frames in a table, and what lies between them. */
#ifndef WEFT_PLAYER_SETTINGS_KEY_FRAMES_H
#define WEFT_PLAYER_SETTINGS_KEY_FRAMES_H

#include "player/scene/scene.h"

enum { WEFT_PATH_VALUE_COUNT = 9, WEFT_PATH_MAX_FRAMES = 1000000 };

typedef struct weft_path {
    int key_count;
    double *time_s;                         /* [key_count] increasing */
    double (*value)[WEFT_PATH_VALUE_COUNT]; /* [key_count], as they are interpolated */
    bool given[WEFT_PATH_VALUE_COUNT];      /* the table has a column for it */
} weft_path;

/* Reads a CSV file (base/text/csv.h) with a line of names: time_s, and any of azimuth_deg, elevation_deg, distance,
 * pan_right, pan_up (of the camera), light_theta_deg, light_phi_deg (of the key light), exposure,
 * environment_turn_deg. The caller frees with weft_path_free. Errors: WEFT_BAD_INPUT naming file, line and column for
 * a column that is not known, a number out of range or times that do not increase; WEFT_SYSTEM. */
weft_code weft_path_read(const char *file, weft_path *path, weft_error *error);
void weft_path_free(weft_path *path);

/* Sets what the path has columns for; the rest of the scene stays. Cubic Hermite curves through the keys with the slope
 * (p[i+1] - p[i-1]) / (t[i+1] - t[i-1]) in key i (Catmull and Rom 1974, for keys at any times) and that of the only
 * neighbour at either end; before the first key and after the last the scene rests. Angles are interpolated as they
 * stand, so that 0 to 720 is two turns; exposure and the distance beyond the bounding sphere by their logarithms.
 * Elevation stays within 90 degrees. Pure. */
void weft_path_apply(const weft_path *path, double time_s, weft_scene *scene);

/* Bounds of the scene between two times: `low` and `high`, which are the scene itself, get the least and the largest
 * that each value of the path may have there, from the control points of its curves (a cubic lies within the hull of
 * its Bezier points). from_s <= to_s. Pure. */
void weft_path_span(const weft_path *path, double from_s, double to_s, weft_scene *low, weft_scene *high);

/* Frames from the first key to the last, both counted, frame i at time_s[0] + i / frames_per_second. Errors:
 * WEFT_BAD_INPUT for more than WEFT_PATH_MAX_FRAMES. */
weft_code weft_path_count_frames(const weft_path *path, double frames_per_second, int *count, weft_error *error);

#endif

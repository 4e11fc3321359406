/* The ground truth of a session of the virtual rig: what registration must find, in a file that it never reads. */
#ifndef WEFT_CAPTURE_VIRTUAL_GROUND_TRUTH_H
#define WEFT_CAPTURE_VIRTUAL_GROUND_TRUTH_H

#include "base/progress.h"
#include "capture/virtual/virtual_rig.h"

#include <limits.h>

typedef struct weft_truth_request {
    const char *path; /* HDF5 file (docs/reference/session-format.md); NULL = FOLDER.truth.h5 */
    int size;         /* texels along a side */
    int image_count;  /* shots whose reflectance is computed */
} weft_truth_request;

/* FOLDER and an ending, whether or not the folder was written with a slash behind it. */
void weft_beside_folder(const char *folder, const char *ending, char path[PATH_MAX]);

/* Whether the file can be written where it is asked for, before there is anything to write. Errors: WEFT_BAD_USAGE,
 * WEFT_SYSTEM. */
weft_code weft_truth_check_path(const weft_truth_request *request, const weft_session *session, weft_error *error);

/* Removes what was left by a process that died here, and writes, atomically, the true pose of every viewpoint, the true
 * camera, the true light position of every shot, and the reflectance of a choice of shots. Follows from the rig and the
 * journal, whatever interruptions the session had. Parallel. Errors: WEFT_SYSTEM. */
weft_code weft_truth_write(const weft_truth_request *request, const weft_session *session, const weft_virtual_rig *rig,
                           const weft_progress *progress, weft_error *error);

/* The choice: one shot of each view in turn, each time with another light, so that all rings of views meet all rings of
 * lights. shots [image_count] receives indices of shots; returns their number, at most `image_count` and at most that
 * of the plan. Pure. */
int weft_truth_choose(const weft_session *session, int image_count, int *shots);

/* pi BRDF cos(theta_light), averaged over the footprint of texel (x, y) of size x size texels over the opening (row 0
 * at the top) by 8 x 8 samples, each with the directions to a light and a camera at `light` and `camera` (plate frame,
 * mm). No falloff. Pure. */
weft_rgb weft_truth_reflectance(const weft_virtual_sample *sample, int size, int x, int y, weft_vec3 light,
                                weft_vec3 camera);

#endif

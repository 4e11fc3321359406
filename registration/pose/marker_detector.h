/* Fiducial markers found in a picture. */
#ifndef WEFT_REGISTRATION_POSE_MARKER_DETECTOR_H
#define WEFT_REGISTRATION_POSE_MARKER_DETECTOR_H

#include "base/status.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { WEFT_MARKERS_LIMIT = 64 };

/* A marker found: its corners in pixels (origin at the centre of the top left pixel), clockwise from the one that is
 * top left when the marker is upright. */
typedef struct weft_marker {
    int id;
    double corner[4][2];
} weft_marker;

/* Whether markers of a dictionary can be found, and how many it has: "4X4_50" to "7X7_1000" and "ARUCO_ORIGINAL" of
 * ArUco, "APRILTAG_16h5", "APRILTAG_25h9", "APRILTAG_36h10", "APRILTAG_36h11". 0: there is none of that name. Pure. */
int weft_marker_dictionary_size(const char *dictionary);

/* Finds the markers of a dictionary in an 8-bit grey picture. The corners lie where lines along the edges of a marker
 * meet (registration/pose/marker_edges.h). At most `limit` are written to `marker`. Errors: WEFT_BAD_USAGE for a
 * dictionary that there is not; WEFT_SYSTEM with the library's message. */
weft_code weft_opencv_find_markers_of(const char *dictionary, const uint8_t *grey, int width, int height,
                                      weft_marker *marker, int limit, int *count, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif

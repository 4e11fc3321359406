/* The corners of a marker where the lines along its four edges meet. A corner itself is rounded by blur and by the area
 * of a pixel, the more the steeper it is seen; its edges are straight all the same. */
#ifndef WEFT_REGISTRATION_POSE_MARKER_EDGES_H
#define WEFT_REGISTRATION_POSE_MARKER_EDGES_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Moves the corners of a dark marker on light ground, in an 8-bit grey picture, to where lines through its edges meet.
 * An edge is where the grey is halfway between both of its sides; its line is the total least squares of points along
 * it. `cells` are those across the marker with its border: the outermost are dark. A marker of which an edge cannot be
 * seen, or whose corners would move by more than half a cell, stays as it was. Pure. */
void weft_marker_refine(const uint8_t *grey, int width, int height, int cells, double corner[4][2]);

#ifdef __cplusplus
}
#endif
#endif

/* The order in which a stage takes poses, so that it is soon done. */
#ifndef WEFT_CAPTURE_AXES_PATH_H
#define WEFT_CAPTURE_AXES_PATH_H

#include "base/status.h"
#include "capture/axes/axes.h"

typedef struct weft_axes_path {
    double seconds; /* of moving and settling, from the first pose to the last */
    int moves;
} weft_axes_path;

/* Sorts `number` [count], which index `pose`. The poses of one viewpoint of the camera follow each other, since they
 * share what registration finds of it; where an operator turns the light, those of one place of the light do.
 * Deterministic; the time grows with the square of the poses of a viewpoint and of the viewpoints. Errors: WEFT_SYSTEM
 * for memory.
 *
 * The order: viewpoints by their nearest neighbour, then segments are moved and turned round while that saves time (Or
 * 1976; Croes 1958), then the same within each viewpoint, from the pose where the last one ended. */
weft_code weft_axes_order(const weft_axes *axes, const weft_axis_positions *pose, int count, int *number,
                          weft_axes_path *path, weft_error *error);

/* A short way through places whose distances differ with the direction: the travelling salesman who need not return. */

/* Cost of going from one place to another; from -1: of beginning at the other. */
typedef double weft_tour_cost(const void *context, int from, int to);

enum { WEFT_TOUR_MAX = 3000 };

/* Sorts `place` [count], which holds 0 .. count - 1, by nearest neighbours and then by moving and turning round
 * segments until no such change is shorter. More than WEFT_TOUR_MAX places stay as they are. Deterministic. Errors:
 * WEFT_SYSTEM for memory. */
weft_code weft_tour(int count, weft_tour_cost *cost, const void *context, int *place, weft_error *error);

#endif

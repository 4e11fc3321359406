/* A short way through places whose distances differ with the direction: the travelling salesman who need not return. */
#ifndef WEFT_CAPTURE_AXES_TOUR_H
#define WEFT_CAPTURE_AXES_TOUR_H

#include "base/status.h"

/* Cost of going from one place to another; from -1: of beginning at the other. */
typedef double weft_tour_cost(const void *context, int from, int to);

enum { WEFT_TOUR_MAX = 3000 };

/* Sorts `place` [count], which holds 0 .. count - 1, by nearest neighbours and then by moving and turning round
 * segments until no such change is shorter. More than WEFT_TOUR_MAX places stay as they are. Deterministic. Errors:
 * WEFT_SYSTEM for memory. */
weft_code weft_tour(int count, weft_tour_cost *cost, const void *context, int *place, weft_error *error);

#endif

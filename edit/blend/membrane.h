/* A field that is as steep across the edges of a grid as it is asked to be, in the mean of squares. Private to the
 * room. */
#ifndef WEFT_EDIT_BLEND_MEMBRANE_H
#define WEFT_EDIT_BLEND_MEMBRANE_H

#include "base/status.h"

/* A grid that goes round in x and in y. Every texel has an edge to the right and one downwards. */
typedef struct weft_membrane {
    int width, height;
    float *step[2]; /* [height][width] what the field should rise by across the edge to the right, and downwards */
    float *value;   /* [height][width] the field */
} weft_membrane;

/* Room for a grid, zeroed. Freed with weft_membrane_free. Errors: WEFT_SYSTEM. */
weft_code weft_membrane_create(int width, int height, weft_membrane *membrane, weft_error *error);
void weft_membrane_free(weft_membrane *membrane);

/* Sets the field, whose mean is 0, to the one that minimises the sum over edges of (rise - step)^2: a discrete Poisson
 * equation (Perez, Gangnet and Blake 2003). Where the steps around are 0 the field is the mean of its neighbours.
 * Conjugate gradients, begun from the solution on a grid half as fine, down to 1e-4 of the steps. Errors: WEFT_SYSTEM.
 */
weft_code weft_membrane_solve(weft_membrane *membrane, weft_error *error);

#endif

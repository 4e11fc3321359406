/* The stitches of assets/stitches, for tests that hold for all of them. */
#ifndef WEFT_TESTS_SHIPPED_STITCHES_H
#define WEFT_TESTS_SHIPPED_STITCHES_H

#include "geometry/yarn/tile_mesh.h"

enum { SHIPPED_STITCHES = 8 };
extern const char *const shipped_stitch[SHIPPED_STITCHES];

/* From one of those that a test holds for to the next: a knit and a weave, or with an argument of the suite all. */
int shipped_stitch_step(void);

/* Reads a shipped stitch and makes its mesh; `resolution` 0 is its own. A failure ends the test. */
void shipped_stitch_open(const char *name, int resolution, weft_stitch *stitch, weft_tile_mesh *mesh);

#endif

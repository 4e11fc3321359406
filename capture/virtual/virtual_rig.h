/* The virtual rig: camera, stage and light computed instead of driven. */
#ifndef WEFT_CAPTURE_VIRTUAL_VIRTUAL_RIG_H
#define WEFT_CAPTURE_VIRTUAL_VIRTUAL_RIG_H

#include "capture/rig.h"
#include "capture/virtual/sample.h"
#include "capture/virtual/world.h"

/* Opens a rig that photographs `sample` in `target`. It borrows both. Its stage counts stays from `first_stay`, the
 * number of stays that the session has already seen: the same seed and stay always give the same errors. The caller
 * closes with rig->close(rig->back_end). Errors: WEFT_SYSTEM. */
weft_code weft_rig_virtual_open(const weft_virtual_world *world, const weft_target *target,
                                const weft_virtual_sample *sample, int first_stay, weft_rig *rig, weft_error *error);

#endif

/* How soon no order of poses can be through: the least spanning tree (Prim 1957). See capture/axes/path.h. */
#ifndef WEFT_CAPTURE_AXES_TREE_H
#define WEFT_CAPTURE_AXES_TREE_H

#include "capture/axes/axes.h"

/* Of pose[number[0 .. count - 1]]. Errors: WEFT_SYSTEM for memory. */
weft_code weft_tree_bound(const weft_axes *axes, const weft_axis_positions *pose, int count, const int *number,
                          double *seconds, weft_error *error);

#endif

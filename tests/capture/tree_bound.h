/* How soon no order of poses can be through: the least spanning tree (Prim 1957). */
#ifndef WEFT_TESTS_CAPTURE_TREE_BOUND_H
#define WEFT_TESTS_CAPTURE_TREE_BOUND_H

#include "capture/axes/axes.h"

/* Of pose[0 .. count - 1]. Asserts.
 *
 * * A path through n poses is a spanning tree of them, and no tree costs less than the least. A move against
 * backlash costs more than its way back, so each pair of poses is counted as min(c(a, b) + d, c(b, a) - d) with
 * d = p(b) - p(a) of a potential p linear in the positions. Along a path p(b) - p(a) sums to at most the range R of p,
 * so that a path costs at least the least tree less R, whatever p is; p = 0 and the p that evens out both ways of the
 * usual step of each axis are tried, and the better bound counts. */
double tree_bound(const weft_axes *axes, const weft_axis_positions *pose, int count);

#endif

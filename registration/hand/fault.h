/* What is wrong with a photograph in which the target is not seen. */
#ifndef WEFT_REGISTRATION_HAND_FAULT_H
#define WEFT_REGISTRATION_HAND_FAULT_H

#include "registration/hand/read.h"

/* In words: it is dark, overexposed, blurred, or of something else. An edge between two greys that is spread over w
 * pixels has the sum of squared differences 1 / w at a lag of one pixel, and lag / w (w >= lag) at a longer lag; so the
 * share of the two tells how wide edges are, whatever the picture shows. The least of four directions counts, because a
 * shake blurs one. Static text. Pure. */
const char *weft_photograph_fault(const weft_light_values *values);

#endif

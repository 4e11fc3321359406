/* What stands on the sheet, the pin and the mirror balls, hides parts of the sample from a low lamp or a low camera.
 * The dataset does not have these texels: they show no cloth in that light. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_HIDDEN_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_HIDDEN_H

#include "registration/photographs/photographs.h"

/* Masks the texels [height][width] whose line to the lamp or to the camera at `eye` (mm, as the lamp) comes nearer to
 * the pin or a ball of `settings` than its radius and what is soft of a shadow: 0.03 of the way for the lamp, 0.01 for
 * the camera. Sets WEFT_MASK_MISSING; *hidden_texels receives how many texels that adds. A pin and balls that are not
 * there hide nothing: their height or diameter is 0. Pure. */
void weft_photographs_mask_hidden(const weft_photographs_settings *settings, weft_vec3 lamp, weft_vec3 eye,
                                  uint8_t *mask, long *hidden_texels);

#endif

/* How little of the linear layers will do: images, layers and digits. Private to study/prune. */
#ifndef WEFT_STUDY_PRUNE_SHRINK_H
#define WEFT_STUDY_PRUNE_SHRINK_H

#include "study/prune/pictures.h"

/* Takes away of the layers of `material` what pictures allow: first images far from the pairs of the reach, then the
 * last layers, then digits of the values, each within a part of what is allowed. `pictures` are those of the whole
 * material. The player then shows the result. Errors: those of drawing; WEFT_SYSTEM. */
weft_code weft_prune_shrink(const weft_prune_pictures *pictures, const weft_reach *reach, weft_prune_error allowed,
                            weft_material *material, weft_prune_report *report, weft_error *error);

#endif

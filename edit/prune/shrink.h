/* How little of the components will do: images, components and digits. Private to edit/prune. */
#ifndef WEFT_EDIT_PRUNE_SHRINK_H
#define WEFT_EDIT_PRUNE_SHRINK_H

#include "edit/prune/pictures.h"

/* Takes away of the components of `material` what pictures allow: first images far from the pairs of the reach, then
 * the last components, then digits of the values, each within a part of what is allowed. `pictures` are those of the
 * whole material. The player then shows the result. Errors: those of drawing; WEFT_SYSTEM. */
weft_code weft_prune_shrink(const weft_prune_pictures *pictures, const weft_reach *reach, weft_prune_error allowed,
                            weft_material *material, weft_prune_report *report, weft_error *error);

#endif

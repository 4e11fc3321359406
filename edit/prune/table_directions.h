/* Which entries of the tables T and S the directions of a reach interpolate between, and a material without the others.
 * Private to edit/prune. */
#ifndef WEFT_EDIT_PRUNE_TABLE_DIRECTIONS_H
#define WEFT_EDIT_PRUNE_TABLE_DIRECTIONS_H

#include "edit/prune/reach.h"

/* Leaves out the views and lights of the tables that no direction of the reach takes a weight of. What is left is
 * interpolated as before in all cells that are reached, or nothing is left out: directions that lie on one circle could
 * be triangulated another way without their neighbours. Errors: WEFT_SYSTEM. */
weft_code weft_prune_tables(const weft_reach *reach, weft_material *material, weft_error *error);

#endif

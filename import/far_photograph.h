/* Photographs lit and seen from far away: their angles become directions. */
#ifndef WEFT_IMPORT_FAR_PHOTOGRAPH_H
#define WEFT_IMPORT_FAR_PHOTOGRAPH_H

#include "import/angle_name.h"
#include "import/collection.h"

/* Appends a photograph of the given angles. Errors: WEFT_BAD_INPUT where light or view is not above the horizon. */
weft_code weft_collection_add_far(weft_collection *collection, const char *name, int missing,
                                  const weft_named_angles *angles, weft_error *error);

/* Sorts the photographs by view, then light. Of those with the same light and view it keeps one that is there, the
 * first by its name, and notes the others, where the collection leaves out doubles, or they are copies byte for byte.
 * Errors: WEFT_BAD_INPUT for such photographs where it does not. */
weft_code weft_collection_sort_far(weft_collection *collection, const char *folder, weft_error *error);

/* Appends what a grid lacks: where at least nine tenths of all pairs of a light and a view that occur were
 * photographed, the others are missing photographs; a collection that is no grid stays as it is. Expects the order of
 * weft_collection_sort_far. */
weft_code weft_collection_complete_grid(weft_collection *collection, weft_error *error);

#endif

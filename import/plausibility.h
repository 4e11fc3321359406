/* Whether the brightness of photographs agrees with what is said of them: the cosine in their values, the angles of
 * their lamps, lamps that are far. */
#ifndef WEFT_IMPORT_PLAUSIBILITY_H
#define WEFT_IMPORT_PLAUSIBILITY_H

#include "base/half.h"
#include "base/text/lines.h"
#include "import/collection.h"

#include <stddef.h>

/* Of a photograph. */
typedef struct weft_photograph_light {
    double mean; /* of the samples that are not masked; 0: nothing is known */
    double
        slope[2]; /* logarithm of the mean of the right half over that of the left one; of the upper over the lower */
} weft_photograph_light;

/* Of samples [height][width][3], mask [height][width]. Pure. */
weft_photograph_light weft_photograph_light_of(const weft_half *samples, const uint8_t *mask, int width, int height);

/* Adds a line for each contradiction. light [collection->count] belongs to the photographs in order; `values` are those
 * of the dataset. Nothing is said of near lights, or of fewer than eight photographs. Errors: WEFT_SYSTEM for memory.
 */
weft_code weft_check_plausibility(const weft_collection *collection, weft_values values,
                                  const weft_photograph_light *light, weft_lines *notes, weft_error *error);

#endif

/* Which models are worth their price. */
#ifndef WEFT_STUDY_TRADEOFF_CHOICE_H
#define WEFT_STUDY_TRADEOFF_CHOICE_H

#include <stdbool.h>
#include <stddef.h>

typedef enum weft_preset {
    WEFT_PRESET_NONE,
    WEFT_PRESET_SMALL,
    WEFT_PRESET_BALANCED,
    WEFT_PRESET_BEST,
    WEFT_PRESET_COUNT
} weft_preset;

/* "", "small", "balanced", "best". Pure. */
const char *weft_preset_name(weft_preset preset);

/* Why a preset is what it is: a sentence. Pure. */
const char *weft_preset_reason(weft_preset preset);

/* What a model costs and what it is worth. */
typedef struct weft_offer {
    double bytes, error; /* error: relative RMSE where it was not fitted */
    bool may_be_chosen;  /* `weft compress` makes it of this dataset; others neither are chosen nor beat one that is */
} weft_offer;

/* Whether another offer that may be chosen has neither more bytes nor more error, and less of one. Of two that are
 * equal in both the first is not beaten. Pure. */
bool weft_offer_is_beaten(const weft_offer *offer, size_t count, size_t which);

/* The offer that a preset chooses among those that may be chosen and are not beaten:
 *
 *     best:     the fewest bytes with an error within a hundredth of the least, which says nothing
 *     small:    the fewest bytes with an error of at most sqrt(least error x error of the smallest file): halfway, by
 *               ratio, between the best and the smallest
 *     balanced: of those between small and best the one farthest below the straight line between the two, both axes
 *               logarithmic: the bend of the curve; small where there is none below it
 *
 * Returns `count` where nothing may be chosen. Pure. */
size_t weft_preset_choose(const weft_offer *offer, size_t count, weft_preset preset);

#endif

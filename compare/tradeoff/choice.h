/* Which models are worth their price. */
#ifndef WEFT_COMPARE_TRADEOFF_CHOICE_H
#define WEFT_COMPARE_TRADEOFF_CHOICE_H

#include "base/status.h"

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

/* Milliseconds of a frame of an offer; 0 where nothing can be drawn. */
typedef weft_code weft_offer_time(void *context, size_t which, double *frame_ms, weft_error *error);

/* The same among those whose frames take at most `most_ms`. A time is asked for only where the offer would be chosen:
 * one that is too slow may be chosen no longer, and the preset chooses anew. Where none is left *chosen is `count`, and
 * *fastest the offer that came nearest (`count` without any). Errors: those of `ask`. */
weft_code weft_preset_choose_fast(weft_offer *offer, size_t count, weft_preset preset, double most_ms,
                                  weft_offer_time *ask, void *context, size_t *chosen, size_t *fastest,
                                  weft_error *error);

#endif

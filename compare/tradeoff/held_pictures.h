/* Held-out images beside what a model makes of them, as pictures. */
#ifndef WEFT_COMPARE_TRADEOFF_HELD_PICTURES_H
#define WEFT_COMPARE_TRADEOFF_HELD_PICTURES_H

#include "compare/tradeoff/held_error.h"

enum { WEFT_HELD_PICTURES = 64 };

/* Of the images with the most reasons to be held out all, or WEFT_HELD_PICTURES of them, evenly, in their order: sets
 * image and returns how many. Reads the held-out images of the trial and their flags alone. Pure. */
int weft_held_pictures_choose(const weft_trial *trial, int image[WEFT_HELD_PICTURES]);

/* Lets the trial ask for these images alone, and for no fitted ones; weft_held_pictures_choose chooses the same again.
 */
void weft_held_pictures_keep(weft_trial *trial);

/* Compares some images that a trial holds out, of those with the most reasons to be, with what is said of them, under
 * the exposure that the photograph needs. Masked texels are black in both and do not count. `kinds` are those of the
 * samples of the excerpt (compare/tradeoff/sample_kind.h). Sets the pictures and their quality in `measured`. Errors:
 * WEFT_SYSTEM. */
weft_code weft_held_pictures_compare(const weft_trial *trial, const weft_asked_samples *said, const uint8_t *kinds,
                                     weft_held_error *measured, weft_error *error);

#endif

/* The analytic cloth of weft_compare. Private to study/. */
#ifndef WEFT_STUDY_COMPARE_WEAVE_H
#define WEFT_STUDY_COMPARE_WEAVE_H

#include "capture/virtual_cloth.h"
#include "study/compare.h"

/* Empty without a weave. Freed with weft_compare_weave_close, also after failure. */
typedef struct weft_compared_weave {
    char *path; /* of the file that is compared: the given or the fitted one */
    weft_virtual_cloth cloth;
} weft_compared_weave;

/* Reads options->weave, fitted to the dataset first where options->fit; then folder/fitted.wv is written. Fills fit,
 * weave_origin, weave_layout and weave_on_yarns of the comparison. Errors: those of reading, fitting and writing. */
weft_code weft_compare_weave_open(const weft_compare_options *options, weft_dataset *dataset,
                                  const weft_progress *progress, weft_compared_weave *weave,
                                  weft_comparison *comparison, weft_error *error);
void weft_compare_weave_close(weft_compared_weave *weave);

#endif

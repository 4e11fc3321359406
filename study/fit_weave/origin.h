/* What a weave file says of the dataset that it was fitted to: its first line. */
#ifndef WEFT_STUDY_FIT_WEAVE_ORIGIN_H
#define WEFT_STUDY_FIT_WEAVE_ORIGIN_H

#include "study/fit_weave/fit_weave.h"

/* Writes a fitted weave whose first line tells the dataset (name and fingerprint) and the error. Atomic. Errors: those
 * of reading and writing. */
weft_code weft_fit_weave_write(const char *path, const weft_weave *weave, weft_dataset *dataset,
                               const weft_fit_weave_report *report, weft_error *error);

/* `origin`: "fitted to this dataset", "fitted to another dataset, ..." or "as its file gives it, fitted to no
 * dataset". Errors: those of reading. */
weft_code weft_fit_weave_origin(const char *path, weft_dataset *dataset, char origin[WEFT_MESSAGE_SIZE],
                                weft_error *error);

#endif

/* The analytic cloth of weft_compare. Private to the room. */
#ifndef WEFT_COMPARE_REPORT_ANALYTIC_H
#define WEFT_COMPARE_REPORT_ANALYTIC_H

#include "compare/report/compare.h"
#include "reflectance/microcylinder/file.h"

/* Empty without a weave. Freed with weft_compare_weave_close, also after failure. */
typedef struct weft_compared_weave {
    char *path; /* of the file that is compared: the given or the fitted one */
    bool is_threads;
    weft_weave weave;                       /* a weave */
    weft_microcylinder_description threads; /* or microcylinder cloth */
} weft_compared_weave;

/* Reads options->weave, a weave fitted to the dataset first where options->fit; then folder/fitted.wv is written. Fills
 * what the comparison tells of it: weave_name to weave_on_yarns. Errors: those of reading, fitting and writing;
 * WEFT_BAD_USAGE for microcylinder cloth to be fitted. */
weft_code weft_compare_weave_open(const weft_compare_options *options, weft_dataset *dataset,
                                  const weft_progress *progress, weft_compared_weave *weave,
                                  weft_comparison *comparison, weft_error *error);
void weft_compare_weave_close(weft_compared_weave *weave);

#endif

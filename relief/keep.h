/* What a search for heights decided, as JSON and in a dataset. */
#ifndef WEFT_RELIEF_KEEP_H
#define WEFT_RELIEF_KEEP_H

#include "relief/relief.h"

#include <jansson.h>

/* The verdict and the numbers behind it; NULL where memory is short. The caller owns it. */
json_t *weft_relief_report_pack(const weft_relief_report *report);

/* Gives the closed dataset `path` what was decided, in the place of what it has: heights, a plane, or nothing; and the
 * report in its provenance. The file is written anew and then takes the name `output`, which may be `path`. Errors:
 * those of weft_dataset_put_relief. */
weft_code weft_relief_keep(const char *path, const char *output, const weft_relief_report *report, weft_error *error);

#endif

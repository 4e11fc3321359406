/* What was found out about the heights of a dataset, as a page with pictures. */
#ifndef WEFT_RELIEF_PAGE_H
#define WEFT_RELIEF_PAGE_H

#include "relief/relief.h"

#include <jansson.h>

/* One sentence: what was decided, and the numbers behind it. */
void weft_relief_reason(const weft_relief_report *report, char *text, size_t size);

/* Writes FOLDER/index.html with height.png and confidence.png. `name` is that of the dataset. Errors: WEFT_SYSTEM. */
weft_code weft_relief_page_write(const char *folder, const char *name, const weft_relief_report *report,
                                 weft_error *error);

/* ---- In the dataset ---- */

/* The verdict and the numbers behind it; NULL where memory is short. The caller owns it. */
json_t *weft_relief_report_pack(const weft_relief_report *report);

/* Gives the closed dataset `path` what was decided, in the place of what it has: heights, a plane, or nothing; and the
 * report in its provenance. The file is written anew and then takes the name `output`, which may be `path`. Errors:
 * those of weft_dataset_put_relief. */
weft_code weft_relief_keep(const char *path, const char *output, const weft_relief_report *report, weft_error *error);

#endif

/* What was found out about the heights of a dataset, as a page with pictures. */
#ifndef WEFT_RELIEF_PAGE_H
#define WEFT_RELIEF_PAGE_H

#include "relief/relief.h"

/* One sentence: what was decided, and the numbers behind it. */
void weft_relief_reason(const weft_relief_report *report, char *text, size_t size);

/* Writes FOLDER/index.html with height.png and confidence.png. `name` is that of the dataset. Errors: WEFT_SYSTEM. */
weft_code weft_relief_page_write(const char *folder, const char *name, const weft_relief_report *report,
                                 weft_error *error);

#endif

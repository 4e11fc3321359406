/* The contact sheet: what a pre-flight saw, on one picture. */
#ifndef WEFT_CAPTURE_PREFLIGHT_SHEET_H
#define WEFT_CAPTURE_PREFLIGHT_SHEET_H

#include "capture/preflight/measure.h"

/* A black sheet for so many poses. Errors: WEFT_SYSTEM. */
weft_code weft_sheet_create(const weft_session *session, int poses, weft_image *sheet, weft_error *error);

/* Puts the photographs of a pose into its row. Pure. */
void weft_sheet_put(const weft_session *session, int row, const weft_preflight_photographs *photographs,
                    weft_image *sheet);

#endif

/* The quality report: one page that names every view, its error and what was used, with pictures. */
#ifndef WEFT_REGISTRATION_REPORT_REPORT_H
#define WEFT_REGISTRATION_REPORT_REPORT_H

#include "registration/outcome/outcome.h"

/* What there is to see of a viewpoint; any may be NULL. */
typedef struct weft_report_pictures {
    const float *average; /* [camera height][width] */
    const float *fitted;  /* the same of the drawn target under the fitted lighting */
    const float *texel;   /* [height][width][3] reflectance times cosine of one photograph, rectified */
} weft_report_pictures;

/* Makes the folder. Errors: WEFT_SYSTEM. */
weft_code weft_report_prepare(const char *folder, weft_error *error);

/* Writes the pictures of viewpoint `viewpoint` (an index into the survey) as PNG. Errors: WEFT_SYSTEM. */
weft_code weft_report_write_pictures(const weft_registration *registration, const weft_sight *sight, int viewpoint,
                                     const weft_report_pictures *pictures, weft_error *error);

/* Writes index.html; `dataset` is the path of what was made. Errors: WEFT_SYSTEM. */
weft_code weft_report_write_page(const weft_session *session, const weft_registration *registration,
                                 const char *dataset, weft_error *error);

#endif

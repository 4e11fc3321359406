/* The quality report of a registration: one page that names every view, its error and what was used, with pictures. */
#ifndef WEFT_REGISTRATION_REPORT_REPORT_H
#define WEFT_REGISTRATION_REPORT_REPORT_H

#include "registration/outcome/outcome.h"

/* Over the viewpoints that did not fail. */
typedef struct weft_registration_summary {
    double median_uncertainty, worst_uncertainty; /* of a position, texels */
    double median_shift_mm;                       /* against the pose that the rig predicts */
    double saturated;                             /* share of the samples */
} weft_registration_summary;

/* Errors: WEFT_SYSTEM for memory. */
weft_code weft_registration_summarise(const weft_session *session, const weft_registration *registration,
                                      weft_registration_summary *summary, weft_error *error);

/* How deep the plate is bent between its middle and its rim along the direction where that is most, mm. Pure. */
double weft_bend_depth_mm(const weft_bend_found *found);

/* Share of the light that the vignetting takes at its reach. Pure. */
double weft_vignetting_loss(const weft_vignetting *vignetting);

/* Makes the folder. Errors: WEFT_SYSTEM. */
weft_code weft_report_prepare(const char *folder, weft_error *error);

/* Writes pictures of viewpoint `viewpoint` (an index into the survey) as PNG: the mean of its photographs, average
 * [camera height][width], and one rectified photograph, texel [height][width][3], reflectance times cosine. Either may
 * be NULL. Errors: WEFT_SYSTEM. */
weft_code weft_report_write_pictures(const weft_registration *registration, const weft_camera *camera, int viewpoint,
                                     const float *average, const float *texel, weft_error *error);

/* Writes index.html; `dataset` is the path of what was made. Errors: WEFT_SYSTEM. */
weft_code weft_report_write_page(const weft_session *session, const weft_registration *registration,
                                 const char *dataset, weft_error *error);

#endif

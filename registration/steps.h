/* The steps of a registration, in their order. */
#ifndef WEFT_REGISTRATION_STEPS_H
#define WEFT_REGISTRATION_STEPS_H

#include "btf/dataset/dataset.h"
#include "registration/outcome/outcome.h"
#include "registration/radiometry/sensor_defects.h"
#include "registration/viewpoint_photographs.h"

/* What the viewpoints of a registration share. */
typedef struct weft_rectifier {
    const weft_session *session; /* as the faults of its sensor let it be seen: &faults->seen */
    const weft_sensor_defects *faults;
    const weft_sight *sight;
    weft_dataset_writer *writer;
    int first_image; /* of the dataset: that of shot 0 */
    weft_registration *registration;
} weft_rectifier;

/* Resamples and calibrates the usable photographs of viewpoint `viewpoint` (an index into the survey) under its pose
 * and puts them into the dataset. Photographs without a measured white level are left out unless `estimated` gives them
 * one. `shown` [height][width][3] (may be NULL) receives the one under the highest light, as reflectance times cosine;
 * it is left as it is where no photograph is put. Errors: WEFT_SYSTEM. Uses OpenMP. */
weft_code weft_rectify_viewpoint(const weft_rectifier *rectifier, int viewpoint,
                                 const weft_viewpoint_photographs *photographs, const weft_white *estimated,
                                 float *shown, weft_error *error);

/* What the photographs of a session tell of the rig beside its calibration: the bend of the plate and the vignetting of
 * the lens. Both are the same for the whole session, so they are found once, before the poses, from some of its
 * viewpoints. */

/* Finds both, writes them into registration->found and makes `sight` see by them. Photographs that cannot be used are
 * named in registration->fault. Where no viewpoint shows the target, nothing is found and nothing is changed. Errors:
 * WEFT_SYSTEM. Uses OpenMP. Memory: 256 MB of photographs at most, or those of one viewpoint. */
weft_code weft_calibrate(const weft_sensor_defects *faults, weft_registration *registration, weft_sight *sight,
                         weft_error *error);

/* White levels of photographs in which no reference patch could be measured, from those of the others. */

/* Whether a registered viewpoint holds a usable photograph without a white level. Pure. */
bool weft_white_lacking(const weft_registration *registration, int viewpoint);

/* For every photograph of the session (*estimated, [shot_count], owned by the caller, free) the median of the levels
 * measured under the same light where there are three or more, else of all levels measured. Nothing is computed where
 * none is lacking. Errors: WEFT_BAD_INPUT where some are lacking and none was measured; WEFT_SYSTEM. */
weft_code weft_white_estimate(const weft_session *session, const weft_registration *registration,
                              weft_white **estimated, weft_error *error);

#endif

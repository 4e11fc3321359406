/* The photographs of a registered viewpoint, turned into images of the dataset. */
#ifndef WEFT_REGISTRATION_RECTIFY_H
#define WEFT_REGISTRATION_RECTIFY_H

#include "btf/dataset/dataset.h"
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

#endif

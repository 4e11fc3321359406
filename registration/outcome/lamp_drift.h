/* How the lamp changed over a session, as the white patches saw it. Each photograph is divided by its own white level,
 * so the change is in no sample; it is told, and kept in the provenance. */
#ifndef WEFT_REGISTRATION_OUTCOME_LAMP_DRIFT_H
#define WEFT_REGISTRATION_OUTCOME_LAMP_DRIFT_H

#include "registration/outcome/outcome.h"

/* The mean white level (registration/radiometry/radiometry.h) of the photographs of a viewpoint on which it was
 * measured. */
typedef struct weft_viewpoint_white {
    int photographs; /* 0: none */
    double level[3];
} weft_viewpoint_white;

/* Pure. */
weft_viewpoint_white weft_viewpoint_white_of(const weft_registration *registration, int viewpoint);

/* Of the viewpoints, brightest and dimmest against the mean of all: 0.01 is one per cent more light. */
typedef struct weft_lamp_drift {
    int viewpoints; /* it was measured in */
    double lowest, highest;
} weft_lamp_drift;

/* Pure. */
weft_lamp_drift weft_lamp_drift_of(const weft_registration *registration);

#endif

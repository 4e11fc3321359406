/* The exposure that a camera means by the numbers that it writes. */
#ifndef WEFT_REGISTRATION_LAMP_EXPOSURE_H
#define WEFT_REGISTRATION_LAMP_EXPOSURE_H

#include "base/picture/exif.h"

/* Cameras count in thirds of a stop and write round numbers: 1/60 s is 1/64 s. Returns 2^(k/3) for such a number of
 * seconds, and every other one as it is: telephones write what they mean. Pure. */
double weft_exposure_meant(double written);

/* Time x sensitivity / f-number^2: time as meant; ISO 125 is 126; the f-number as written. 0 where the camera wrote
 * none. Pure. */
double weft_exif_exposure(const weft_exif *exif);

#endif

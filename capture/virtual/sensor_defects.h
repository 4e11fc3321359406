/* What is wrong with the pixels of the virtual sensor. Nothing here is shared with what finds it. */
#ifndef WEFT_CAPTURE_VIRTUAL_SENSOR_DEFECTS_H
#define WEFT_CAPTURE_VIRTUAL_SENSOR_DEFECTS_H

#include "capture/virtual/sensor.h"

/* Dark current: that of the usual pixel, with a normal spread, never negative. Hot pixels, by chance, have more:
 * exponentially distributed with their mean. They blink, as random telegraph noise lets them. Response: normal about 1,
 * times what specks of dust let through, whose shadows are soft discs 3 to 9 pixels in radius, alike in all channels.
 * Owned by the caller (weft_virtual_sensor_defects_free), also after a failure. Errors: WEFT_SYSTEM. */
weft_code weft_virtual_sensor_defects_make(const weft_virtual_settings *settings, uint64_t seed,
                                           weft_virtual_sensor_defects *faults, weft_error *error);
void weft_virtual_sensor_defects_free(weft_virtual_sensor_defects *faults);

#endif

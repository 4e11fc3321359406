/* The defects of a sensor, found in the frames that a session begins with, and taken out of its photographs.
 *
 * A pixel shows  raw = offset + dark t + response light t  for an exposure of t seconds. The mean of the dark frames at
 * two exposures gives offset and dark current of each pixel and channel, so that its dark value is known at any
 * exposure. The mean of the frames of an even field, without their own dark value and without the declared vignetting
 * of the lens, gives the response, relative to the median of its channel. */
#ifndef WEFT_REGISTRATION_RADIOMETRY_SENSOR_DEFECTS_H
#define WEFT_REGISTRATION_RADIOMETRY_SENSOR_DEFECTS_H

#include "btf/session/session.h"
#include "registration/pose/prediction.h"

/* What people are told. */
typedef struct weft_sensor_summary {
    int dark_frames, flat_frames; /* it was found from, at each exposure; 0: nothing is known */
    double dark_rate;             /* median dark current, raw values per second */
    double longest_s;             /* exposure of the long dark frames */
    double least, most;           /* response: 0.1st and 99.9th percentile, of its median */
    double fall_off;              /* response in the outer tenth of the picture beside that of its middle, less 1 */
    int hot, dead;                /* pixels that are masked */
} weft_sensor_summary;

typedef struct weft_sensor_defects {
    weft_sensor_summary summary;
    weft_session seen; /* a copy: the session as registration sees it when the faults are taken out. Where there are no
                          frames, the session itself. Borrows from it */
    int bits, black_level; /* of the files */
    float *offset, *dark;  /* [height][width][3] raw values, and per second; NULL where there are no dark frames */
    float *inverse;        /* [height][width][3] 1 / response, scaled to at most 1; NULL where there are no flat ones */
    uint8_t *blind;        /* [height][width] 1: a pixel that is hot or dead; NULL where there are no frames */
} weft_sensor_defects;

/* Reads the frames of the session. A pixel is hot where its dark current, in any channel, is beyond the median by more
 * than 8 standard deviations (1.4826 times the median distance from it), and by more than a thousandth of full scale
 * in the long dark frames: such pixels blink, so that it cannot be subtracted. It is dead where its response is below a
 * quarter or above four times the median. The caller frees with weft_sensor_defects_free, also after a failure. Errors:
 * WEFT_BAD_INPUT naming a frame that is not taken or cannot be read; WEFT_SYSTEM. */
weft_code weft_sensor_defects_find(const weft_session *session, weft_sensor_defects *faults, weft_error *error);
void weft_sensor_defects_free(weft_sensor_defects *faults);

/* Reads a photograph of the session that was exposed for `exposure_s`, without the defects of the sensor:
 *   value = black level + (raw - offset - dark exposure_s) scale / response
 * in 16 bits, with the black level and the full scale of faults->seen. Values that were saturated are at full scale,
 * and no others. The values of a session without frames stay as they are. Thread-safe. Errors: as weft_photograph_read.
 */
weft_code weft_sensor_read(const weft_sensor_defects *faults, const char *path, double exposure_s, uint16_t *samples,
                           weft_error *error);

/* Lets the blind pixels count for nothing: their inverse vignetting becomes 0. */
void weft_sensor_blind(const weft_sensor_defects *faults, weft_sight *sight);

#endif

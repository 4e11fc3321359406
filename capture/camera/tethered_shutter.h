/* The shutter of a camera on a cable, as libgphoto2 lets it be set: by the names of its times, or by bulb, which opens
 * it until it is told to close. Cameras are open; results are those of libgphoto2. */
#ifndef WEFT_CAPTURE_CAMERA_TETHERED_SHUTTER_H
#define WEFT_CAPTURE_CAMERA_TETHERED_SHUTTER_H

#include <gphoto2/gphoto2.h>
#include <stdbool.h>

/* Sets the longest time that is no longer than asked, or else the shortest. A camera whose shutter no program can set
 * keeps what it has. */
int weft_shutter_set(Camera *camera, GPContext *context, double exposure_s);

/* What the camera says its shutter is set to; 0: nothing. */
double weft_shutter_reported(Camera *camera, GPContext *context);

/* The longest of the times that it names; 0: it names none, or does not answer. May take a tenth of a second. */
double weft_shutter_longest(Camera *camera, GPContext *context);

/* Whether an exposure is longer than the longest that the camera names (0: not known), and bulb would make it. */
bool weft_shutter_needs_bulb(Camera *camera, GPContext *context, double longest_s, double exposure_s);

/* Sets the shutter to "bulb", which some cameras want first; others have no such choice. */
int weft_shutter_choose_bulb(Camera *camera, GPContext *context);

/* Opens (1) or closes (0) the shutter. */
int weft_shutter_press(Camera *camera, GPContext *context, int down);

#endif

/* A camera on a cable or a network, through libgphoto2: most that photographers use. */
#ifndef WEFT_CAPTURE_CAMERA_TETHERED_CAMERA_H
#define WEFT_CAPTURE_CAMERA_TETHERED_CAMERA_H

#include "capture/camera/frame.h"
#include "capture/rig.h"

typedef struct weft_tethered_camera_settings {
    const char *port; /* "": the first camera on USB; else as gphoto2 --port has it: "usb:001,011", "ptpip:HOST" */
    double timeout_s; /* of a camera that is busy or gone, tried again meanwhile */
    weft_frame_format format;
    const volatile sig_atomic_t *stop; /* borrowed; NULL: never */
} weft_tethered_camera_settings;

typedef struct weft_tethered_camera weft_tethered_camera;

/* Opens the camera. The caller frees with weft_tethered_camera_free. Errors: WEFT_SYSTEM where it does not answer, or
 * hands over its files but cannot be released. */
weft_code weft_tethered_camera_create(const weft_tethered_camera_settings *settings, weft_tethered_camera **camera,
                                      weft_error *error);
void weft_tethered_camera_free(weft_tethered_camera *camera);

/* The way in. The shutter is set to the choice of the camera that is nearest to the exposure, and the file is fetched
 * as the camera took it. A camera that is busy or gone is opened again; a full card is told at once. */
weft_rig_camera weft_tethered_camera_for_rig(weft_tethered_camera *camera);

#endif

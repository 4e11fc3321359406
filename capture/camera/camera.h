/* Cameras of a laboratory behind the rig's interface: what they are told, and how they are opened. */
#ifndef WEFT_CAPTURE_CAMERA_CAMERA_H
#define WEFT_CAPTURE_CAMERA_CAMERA_H

#include "base/clock.h"
#include "base/picture/image.h"
#include "capture/rig.h"

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

enum { WEFT_FRAME_BITS = 16 };

typedef struct weft_frame_format {
    int bin;           /* the mean of this many columns and rows of the camera is one pixel */
    int width, height; /* then, of the calibration: a frame of another size is refused */
    bool srgb;         /* the camera's values went through the curve of sRGB; else they are linear */
    double exposure_s; /* set at the camera by hand, so that it need not say; 0: it must say */
} weft_frame_format;

/* Whoever releases the shutter; `release` NULL: nobody, the camera does it by itself. Errors: WEFT_SYSTEM. */
typedef struct weft_shutter {
    void *context;
    weft_code (*release)(void *context, double exposure_s, weft_error *error);
} weft_shutter;

/* All borrowed. */
typedef struct weft_camera_settings {
    const char *device;  /* see below */
    const char *pattern; /* of file names in a folder, as the shell has them */
    double timeout_s;    /* from the release to the whole file; of a camera that is busy or gone */
    int stale_frames;    /* that a live video camera still holds from before: thrown away at each exposure */
    weft_frame_format format;
    weft_shutter shutter;              /* of a folder and of a video camera */
    const volatile sig_atomic_t *stop; /* NULL: never */
    const weft_clock *clock;           /* NULL: weft_system_clock */
} weft_camera_settings;

/* Each opens a camera, which the caller closes with camera->close. Errors: WEFT_SYSTEM. */

/* Any camera whose software drops its photographs into the folder `device`: the next one that appears there is the
 * frame. A file is taken when it was closed after writing, or moved into the folder, and can be read to its end; until
 * then, it is waited for. Files that lie there already, and those that come between two exposures, are no frames. A
 * file stays where it is. */
weft_code weft_folder_camera_open(const weft_camera_settings *settings, weft_rig_camera *camera, weft_error *error);

/* Webcams and machine vision, through OpenCV's VideoCapture; also films and numbered pictures, frame by frame. `device`
 * is the number of a camera, or a file or address that OpenCV opens. */
weft_code weft_video_camera_open(const weft_camera_settings *settings, weft_rig_camera *camera, weft_error *error);

/* A camera on a cable or a network, through libgphoto2: most that photographers use. `device` is "" for the first
 * camera on USB, else as gphoto2 --port has it: "usb:001,011", "ptpip:HOST". The shutter is set to the choice of the
 * camera that is nearest to the exposure, and the file is fetched as the camera took it. A camera that is busy or gone
 * is opened again; a full card is reported at once. Errors: also where the camera cannot be released by a program. */
weft_code weft_tethered_camera_open(const weft_camera_settings *settings, weft_rig_camera *camera, weft_error *error);

/* ---- What the cameras share ---- */

/* Linear values of WEFT_FRAME_BITS, [height][width][3], of which the highest is where the camera saturates. Pure.
 * Errors: WEFT_SYSTEM naming `camera` for a frame of another size. */
weft_code weft_frame_develop(const weft_image *image, const weft_frame_format *format, const char *camera,
                             uint16_t *samples, weft_error *error);

/* The exposure of a frame: what the camera said (0: nothing), or what was set by hand. Errors: WEFT_SYSTEM where nobody
 * knows. */
weft_code weft_frame_exposure(double said_s, const weft_frame_format *format, const char *camera, double *exposure_s,
                              weft_error *error);

/* Seconds of the words in which cameras name exposure times: "1/60", "0.5", "1.3s", "30". 0 for what is no time:
 * "bulb", "Auto", "Unknown value 00f8". Pure, whatever the locale. */
double weft_shutter_seconds(const char *choice);

#endif

/* Any camera whose software drops its photographs into a folder: the next one that appears there is the frame. */
#ifndef WEFT_CAPTURE_CAMERA_FOLDER_CAMERA_H
#define WEFT_CAPTURE_CAMERA_FOLDER_CAMERA_H

#include "base/clock.h"
#include "capture/camera/frame.h"
#include "capture/rig.h"

typedef struct weft_folder_camera_settings {
    const char *folder, *pattern; /* of file names, as the shell has them; borrowed */
    double timeout_s;             /* from the release to the whole file */
    weft_frame_format format;
    weft_shutter shutter;
    const volatile sig_atomic_t *stop; /* borrowed; NULL: never */
    const weft_clock *clock;           /* copied; NULL: weft_system_clock */
} weft_folder_camera_settings;

typedef struct weft_folder_camera weft_folder_camera;

/* Begins to watch. Files that lie there already, and those that come between two exposures, are no frames. The caller
 * frees with weft_folder_camera_free. Errors: WEFT_SYSTEM where the folder cannot be watched. */
weft_code weft_folder_camera_create(const weft_folder_camera_settings *settings, weft_folder_camera **camera,
                                    weft_error *error);
void weft_folder_camera_free(weft_folder_camera *camera);

/* The way in. A file is taken when it was closed after writing, or moved into the folder, and can be read to its end;
 * until then, it is waited for. It stays where it is. */
weft_rig_camera weft_folder_camera_for_rig(weft_folder_camera *camera);

#endif

/* The folder that the sessions of several cameras lie in (btf/session/camera_list.h). */
#ifndef WEFT_CAPTURE_CAMERA_FOLDER_H
#define WEFT_CAPTURE_CAMERA_FOLDER_H

#include "btf/session/camera_list.h"
#include "capture/rig.h"

/* The cameras of a rig; none where it has one without a name. Pure. */
weft_camera_list weft_camera_list_of(const weft_rig *rig);

/* Makes the folder and writes the list, or checks that the list there is the same. Errors: WEFT_BAD_INPUT where the
 * folder holds something else or was begun with other cameras; WEFT_SYSTEM. */
weft_code weft_camera_folder_prepare(const char *folder, const weft_camera_list *list, weft_error *error);

/* Removes what a process left that died while it wrote the list. Whoever holds the session of the first camera is
 * alone. */
void weft_camera_folder_sweep(const char *folder);

#endif

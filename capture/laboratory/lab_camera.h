/* A camera of a laboratory: what the rig file says of it, its back end once it is connected, and the rig that it is. */
#ifndef WEFT_CAPTURE_LABORATORY_LAB_CAMERA_H
#define WEFT_CAPTURE_LABORATORY_LAB_CAMERA_H

#include "btf/session/colour.h"
#include "btf/session/poses_file.h"
#include "capture/camera/folder_camera.h"
#include "capture/camera/tethered_camera.h"
#include "capture/camera/video_camera.h"
#include "capture/laboratory/laboratory.h"
#include "capture/motion/controller.h"

#include <limits.h>
#include <pthread.h>

/* What releases a shutter that the camera does not release itself. All borrowed. */
typedef struct weft_releases {
    weft_controller *controller; /* of the stage, with a contact; NULL: none */
    weft_operator rig_operator;
    pthread_mutex_t one_question; /* a person is asked one thing at a time */
} weft_releases;

typedef struct weft_lab_camera {
    const weft_rig_file *file;
    const weft_camera_description *description;
    weft_releases *releases;
    const volatile sig_atomic_t *stop;
    char lens[PATH_MAX], device[PATH_MAX];
    weft_colour colour; /* terms 0: not known */
    char poses_path[PATH_MAX];
    weft_poses_file poses; /* where the axes truly put it; read where the rig file names them */
    char *identity;
    weft_axes axes;    /* with this camera's fixed angles */
    weft_stage *stage; /* as it stands on it */
    weft_folder_camera *folder;
    weft_video_camera *video;
    weft_tethered_camera *tethered;
    bool asked_to_show; /* something else than the sample */
    weft_rig rig;
} weft_lab_camera;

/* Reads what the rig file names of camera `index`, and fills in of `camera->rig` what follows from that alone: lens,
 * colours, poses, noise, settings, identity, name. The caller frees with weft_lab_camera_free, also after a failure.
 * Errors: WEFT_BAD_INPUT naming a file; WEFT_SYSTEM. */
weft_code weft_lab_camera_describe(const weft_rig_file *file, int index, weft_lab_camera *camera, weft_error *error);
void weft_lab_camera_free(weft_lab_camera *camera);

/* Opens the device. Errors: WEFT_SYSTEM naming it. */
weft_code weft_lab_camera_connect(weft_lab_camera *camera, weft_error *error);

#endif

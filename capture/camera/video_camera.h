/* Webcams and machine vision, through OpenCV's VideoCapture; also films and numbered pictures, frame by frame. */
#ifndef WEFT_CAPTURE_CAMERA_VIDEO_CAMERA_H
#define WEFT_CAPTURE_CAMERA_VIDEO_CAMERA_H

#include "capture/camera/frame.h"
#include "capture/rig.h"

typedef struct weft_video_camera_settings {
    const char *device; /* the number of a camera, or a file or address that OpenCV opens; borrowed */
    int stale_frames;   /* that a live camera still holds of before: thrown away at each exposure */
    weft_frame_format format;
    weft_shutter shutter;
} weft_video_camera_settings;

typedef struct weft_video_camera weft_video_camera;

/* Opens it. The caller frees with weft_video_camera_free. Errors: WEFT_SYSTEM where it cannot be opened, or OpenCV's
 * part for it is missing. */
weft_code weft_video_camera_create(const weft_video_camera_settings *settings, weft_video_camera **camera,
                                   weft_error *error);
void weft_video_camera_free(weft_video_camera *camera);

weft_rig_camera weft_video_camera_for_rig(weft_video_camera *camera);

#endif

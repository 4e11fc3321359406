/* OpenCV's VideoCapture, loaded when the first camera is opened: it brings every codec of the machine with it. */
#ifndef WEFT_CAPTURE_CAMERA_VIDEO_LIBRARY_H
#define WEFT_CAPTURE_CAMERA_VIDEO_LIBRARY_H

#include "base/picture/image.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct weft_video weft_video;

/* What the module weft_video_library.so does. */
typedef struct weft_video_library {
    weft_code (*open)(const char *device, weft_video **video, weft_error *error);
    void (*close)(weft_video *video);
    /* Asks for an exposure; *said_s receives what the driver then says, 0 where it says nothing. Errors: WEFT_SYSTEM.
     */
    weft_code (*set_exposure)(weft_video *video, double exposure_s, double *said_s, weft_error *error);
    /* The next frame but `skip`, values 0 to 1. Errors: WEFT_SYSTEM where none comes. */
    weft_code (*read)(weft_video *video, int skip, weft_image *image, weft_error *error);
} weft_video_library;

/* What the module exports under this name. */
extern const weft_video_library weft_video_library_table;

#ifdef __cplusplus
}
#endif
#endif

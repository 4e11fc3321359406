/* What every camera of a laboratory shares: the pixels that a session wants, who releases the shutter, and an exposure
 * that is read back. */
#ifndef WEFT_CAPTURE_CAMERA_FRAME_H
#define WEFT_CAPTURE_CAMERA_FRAME_H

#include "base/picture/image.h"

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

/* Linear values of WEFT_FRAME_BITS, [height][width][3], of which the highest is where the camera saturates. Pure.
 * Errors: WEFT_SYSTEM naming `camera` for a frame of another size. */
weft_code weft_frame_develop(const weft_image *image, const weft_frame_format *format, const char *camera,
                             uint16_t *samples, weft_error *error);

/* The exposure of a frame: what the camera said (0: nothing), or what was set by hand. Errors: WEFT_SYSTEM where nobody
 * knows. */
weft_code weft_frame_exposure(double said_s, const weft_frame_format *format, const char *camera, double *exposure_s,
                              weft_error *error);

#endif

/* Everything that a capture is asked to do, and what follows from it before the first photograph. */
#ifndef WEFT_CAPTURE_SETUP_H
#define WEFT_CAPTURE_SETUP_H

#include "capture/settings.h"
#include "capture/virtual/sample.h"
#include "capture/virtual/world.h"

typedef struct weft_capture_request {
    const char *folder; /* of the session */
    const char *plan;   /* "ubo81" or a CSV file, see capture/plan.h */
    const char *sample; /* weave or stitch file */
    uint64_t seed;      /* below 2^63 */
    weft_rig_settings settings;
    const char *truth; /* file of the ground truth; NULL = FOLDER.truth.h5 */
    int truth_size;    /* texels along a side */
    int truth_images;  /* shots whose reflectance it holds; fewer where the plan has fewer */
} weft_capture_request;

/* ubo81, no sample, seed 1, the settings of the default rig, truth of 64 x 64 texels for 81 images. */
weft_capture_request weft_capture_request_default(void);

typedef struct weft_capture_setup {
    weft_session session; /* as planned; nothing of it is on disk */
    weft_virtual_world world;
    weft_virtual_sample sample;
    char warning[WEFT_MESSAGE_SIZE]; /* of the weave file; empty if all is well */
} weft_capture_setup;

/* Reads plan and sample. The caller frees with weft_capture_setup_free. Errors: WEFT_BAD_INPUT naming the file. */
weft_code weft_capture_setup_make(const weft_capture_request *request, weft_capture_setup *setup, weft_error *error);
void weft_capture_setup_free(weft_capture_setup *setup);

/* Bytes that a photograph of the session takes on disk, rounded up. Pure. */
uint64_t weft_photograph_bytes(const weft_session *session);

#endif

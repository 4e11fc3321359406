/* A rig of a laboratory, as its file describes it, behind the rig's interface. */
#ifndef WEFT_CAPTURE_LABORATORY_LABORATORY_H
#define WEFT_CAPTURE_LABORATORY_LABORATORY_H

#include "capture/laboratory/rig_file.h"
#include "capture/motion/stage.h"

#include <signal.h>

typedef struct weft_laboratory_request {
    const char *rig_file, *sample; /* sample: what lies in the opening, in the owner's words */
    weft_operator rig_operator;
    const volatile sig_atomic_t *stop; /* NULL: never; all borrowed */
} weft_laboratory_request;

typedef struct weft_laboratory weft_laboratory;

/* Reads the rig file and what it names. Touches no device: what is known of the rig without it, as a rehearsal needs,
 * is there. The caller closes with weft_laboratory_close. Errors: those of weft_rig_file_read; WEFT_BAD_INPUT for a
 * lens or a table of lamps that cannot be used; WEFT_SYSTEM. */
weft_code weft_laboratory_open(const weft_laboratory_request *request, weft_laboratory **laboratory, weft_error *error);

/* Opens the cameras; the stage and its lamps are found when they are homed. Errors: WEFT_SYSTEM naming the device. */
weft_code weft_laboratory_connect(weft_laboratory *laboratory, weft_error *error);

/* Stops what moves and switches off what burns. */
void weft_laboratory_close(weft_laboratory *laboratory);

/* What a capture drives: the rig of the first camera, which leads to the others. Lives as long as the laboratory. */
weft_rig *weft_laboratory_rig(weft_laboratory *laboratory);

#endif

/* The virtual rig: camera, stage and light computed instead of driven. With several cameras, a rig is one of them. */
#ifndef WEFT_CAPTURE_VIRTUAL_VIRTUAL_RIG_H
#define WEFT_CAPTURE_VIRTUAL_VIRTUAL_RIG_H

#include "capture/rig.h"
#include "capture/virtual/sample.h"
#include "capture/virtual/world.h"

/* What makes a virtual rig: the same request and the same viewpoints always give the same photographs. */
typedef struct weft_virtual_request {
    const char *sample; /* weave or stitch file */
    uint64_t seed;      /* below 2^63 */
    weft_virtual_settings settings;
} weft_virtual_request;

/* An open virtual rig. The photographs follow from its world and its sample, and so does the ground truth. */
typedef struct weft_virtual_rig {
    weft_rig rig; /* what a capture drives */
    weft_virtual_world world;
    weft_virtual_sample sample;
    char warning[WEFT_MESSAGE_SIZE]; /* of the weave file; empty if all is well */
    char camera_name[24];            /* "camera1" and so on, of several cameras */
} weft_virtual_rig;

/* Reads the sample and opens the rig; its identity holds the settings, the seed, and name and checksum of the sample's
 * file. The structure must stay where it is until the caller closes it. Errors: those of weft_virtual_sample_read;
 * WEFT_SYSTEM. */
weft_code weft_virtual_rig_open(const weft_virtual_request *request, weft_virtual_rig *rig, weft_error *error);
void weft_virtual_rig_close(weft_virtual_rig *rig);

/* Opens all cameras of a request, rigs [settings.cameras], as rigs that stand on one ring under one lamp
 * (capture/rig.h); *count receives how many, each to be closed by itself. Errors: as above; nothing is open then. */
weft_code weft_virtual_rigs_open(const weft_virtual_request *request, weft_virtual_rig *rigs, int *count,
                                 weft_error *error);

#endif

/* A volley: the photographs of all cameras that see one light in one pose of the stage, exposed together. */
#ifndef WEFT_CAPTURE_VOLLEY_H
#define WEFT_CAPTURE_VOLLEY_H

#include "capture/shooting.h"

/* One camera of a volley. `samples` holds all photographs of the shot, one after the other. */
typedef struct weft_exposing {
    weft_shooting *shooting;
    int shot;
    uint16_t *samples;
    weft_shot_record record; /* viewpoint, exposure, brackets */
    weft_code code;          /* of this camera alone; what follows is for volleys */
    weft_error error;        /* why */
    double exposure_s, read_back_s;
    bool wanted; /* whether it exposes now */
} weft_exposing;

/* Takes the first photograph of each: drives the stage, switches the lamp on once, and lets each camera meter and
 * expose, each in a thread of its own where there are several. A volley during which the stage did not keep its pose is
 * taken again. A camera that fails has its own `code`, and the others have their photographs. Errors: those of stage
 * and light. Then, and where all cameras fail, axes stand still and the light is off. */
weft_code weft_volley_take(weft_exposing *exposing, int count, weft_error *error);

/* Fails: the stage moved during a photograph, `times` times. Its axes stand still then. */
weft_code weft_volley_fail_disturbed(const weft_exposing *exposing, int times, weft_error *error);

/* Takes the next photograph of the bracket of each that needs one and did not fail: shorter where the sensor clipped in
 * the opening, else longer, up to 16 times, until the darkest of the opening reaches a thirty-second of full scale. It
 * goes behind the last one in `samples`; record gets its exposure. *taken says how many there were, and `wanted` whose.
 * *held says whether the stage kept its pose: where it did not, the volley is to be taken again from its beginning, for
 * its photographs share one pose. Errors: as above. */
weft_code weft_volley_bracket(weft_exposing *exposing, int count, int most, int *taken, bool *held, weft_error *error);

#endif

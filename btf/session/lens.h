/* The lens of a camera, as `weft lens` calibrates it: a JSON file (docs/reference/lens-format.md). */
#ifndef WEFT_BTF_SESSION_LENS_H
#define WEFT_BTF_SESSION_LENS_H

#include "base/status.h"
#include "btf/session/camera.h"

enum { WEFT_LENS_PARAMETERS = 9 };

/* "fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3". */
extern const char *const weft_lens_parameter_name[WEFT_LENS_PARAMETERS];

typedef struct weft_lens {
    weft_camera camera;
    double standard_error[WEFT_LENS_PARAMETERS]; /* in the order of the names; 0: held fast */
    double rms_px;                               /* of the corners about where the lens puts them */
} weft_lens;

/* A photograph of the calibration of a lens or a rig. */
typedef struct weft_lens_photograph {
    const char *name;
    const char *left_out; /* why; NULL: it was used */
} weft_lens_photograph;

/* In the order of the names. Pure. */
double weft_lens_parameter(const weft_camera *camera, int parameter);

/* Writes a lens atomically, with the board as `weft lens` takes it and the photographs. Errors: WEFT_SYSTEM;
 * WEFT_BAD_USAGE where the path names no file. */
weft_code weft_lens_write(const char *path, const weft_lens *lens, const char *board,
                          const weft_lens_photograph *photograph, int count, weft_error *error);

/* Reads what can be computed with. Errors: WEFT_BAD_INPUT naming the file and the field or value that cannot be;
 * WEFT_SYSTEM. Thread-safe. */
weft_code weft_lens_read(const char *path, weft_lens *lens, weft_error *error);

#endif

/* What would go wrong in a capture run, found before it: a few photographs at the poses where it goes wrong first. */
#ifndef WEFT_CAPTURE_PREFLIGHT_PREFLIGHT_H
#define WEFT_CAPTURE_PREFLIGHT_PREFLIGHT_H

#include "base/picture/image.h"
#include "base/progress.h"
#include "capture/capture.h"

typedef enum weft_preflight_kind {
    WEFT_CHECK_TARGET,        /* fewest markers of the target found; the drawing found in all poses */
    WEFT_CHECK_PLACE,         /* largest shift of the target against the predicted pose, mm */
    WEFT_CHECK_FOCUS,         /* frontal: standard deviation of the point spread in the opening, pixels */
    WEFT_CHECK_FOCUS_GRAZING, /* the same where the view is lowest, at the corner of the opening where it is widest */
    WEFT_CHECK_CLIPPING,      /* largest share of the opening at full scale */
    WEFT_CHECK_WHITE,         /* lowest brightness of the white patches, of full scale */
    WEFT_CHECK_WHITE_CLIPPED, /* largest share of the white patches at full scale */
    WEFT_CHECK_NOISE,         /* of a pixel of the white patches, from two photographs, relative */
    WEFT_CHECK_LINEARITY,     /* how far white patches are from growing with the exposure, relative */
    WEFT_CHECK_STRAY,         /* what is seen without the lamp, of what the white patches show with it */
    WEFT_CHECK_DARK,          /* what the sensor shows without light, in the longest exposure, of full scale */
    WEFT_CHECK_HOT,           /* share of the pixels that show more than that there, by a hundredth of full scale */
    WEFT_CHECK_VIBRATION,     /* largest move of the plate between two photographs, pixels */
    WEFT_CHECK_DISK,          /* GB that the disk has */
    WEFT_CHECK_CALIBRATION,   /* age of the lens, days */
    WEFT_CHECK_KINDS
} weft_preflight_kind;

typedef struct weft_preflight_check {
    bool done; /* false where the rig has no such thing, or nothing could be measured */
    bool passed;
    double value;
    weft_angles view; /* where it was worst; of the photographs alone */
} weft_preflight_check;

/* What is known of each check. */
typedef struct weft_preflight_limits {
    const char *name, *unit;
    double limit;
    bool is_least; /* whether the value must reach the limit, not stay below it */
    double scale;  /* of the value, for people */
    bool of_view;
    const char *advice;
} weft_preflight_limits;

extern const weft_preflight_limits weft_preflight_limits_of[WEFT_CHECK_KINDS];

typedef struct weft_preflight {
    weft_preflight_check check[WEFT_CHECK_KINDS];
    double disk_needed; /* GB */
    int pose_count;
    weft_image sheet; /* for each pose: with the lamp; twice the difference to a second one, about grey, times 8;
                         without the lamp, times 100 */
} weft_preflight;

/* Goes to the frontal view and to the lowest ones of the plan, up to four round the sample, each under its highest
 * light. Takes two photographs with the lamp, one with a quarter of the exposure, and one without the lamp; in the
 * first view one more without, as long as the rig exposes. Writes nothing. The caller frees with weft_preflight_free.
 * Errors: those of the plan and of the rig; WEFT_SYSTEM. A check that is not passed is none. */
weft_code weft_preflight_run(const weft_capture_request *request, weft_rig *rig, const weft_progress *progress,
                             weft_preflight *result, weft_error *error);
void weft_preflight_free(weft_preflight *result);

/* Whether all that was done was passed. Pure. */
bool weft_preflight_passed(const weft_preflight *result);

#endif

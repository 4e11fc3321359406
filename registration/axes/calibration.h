/* The axes of a rig out of photographs of the target that they took it to. */
#ifndef WEFT_REGISTRATION_AXES_CALIBRATION_H
#define WEFT_REGISTRATION_AXES_CALIBRATION_H

#include "base/text/lines.h"
#include "btf/session/poses_file.h"
#include "registration/axes/fit.h"

enum { WEFT_AXES_FEWEST = 8, WEFT_AXES_FOLDS = 5 };

typedef struct weft_axes_report {
    weft_axes_fit fit; /* of all shots that are used */
    weft_poses_file file;
    int used;
    weft_lines found;        /* of each axis, for the user */
    weft_lines undetermined; /* what stays as specified, and why */
} weft_axes_report;

/* Adjusts home and lines, then what else makes the shots more probable: scale, unevenness and wobble of each joint,
 * and, where `free_lens`, the lens. A term is taken if it lowers minus twice the log probability by more than its
 * numbers times log(6 shots) (Schwarz 1978), the best first.
 *
 * The line of a joint is free if its turns have three values that differ by half a degree; of fewer it is held as
 * `nominal` has it. Shots whose own place is three times as far off as is usual, and more than 0.3 pixels, are left
 * out, the worst first.
 *
 * What is held out in turn is a fifth of the shots each: the terms are those of all, their numbers are not.
 *
 * `report` is to be freed with weft_axes_report_free, whatever is returned. Errors: WEFT_BAD_INPUT for fewer than
 * WEFT_AXES_FEWEST shots that can be used, or where no axis turns; WEFT_SYSTEM. */
weft_code weft_axes_calibrate(weft_axes_shot *shot, int count, const weft_rig_poses *nominal, bool free_lens,
                              weft_axes_report *report, weft_error *error);
void weft_axes_report_free(weft_axes_report *report);

#endif

/* The lens of a camera out of photographs of a board (Zhang 2000), robustly: what does not fit is left out and named.
 */
#ifndef WEFT_REGISTRATION_LENS_CALIBRATION_H
#define WEFT_REGISTRATION_LENS_CALIBRATION_H

#include "base/progress.h"
#include "base/text/lines.h"
#include "btf/session/lens.h"
#include "registration/lens/board.h"

#include <stdbool.h>

enum { WEFT_LENS_FEWEST = 3 }; /* photographs that a lens needs */

typedef struct weft_lens_settings {
    weft_board board;
    bool full_model; /* keep k2, p1, p2 and k3, whether the photographs tell them or not */
} weft_lens_settings;

typedef struct weft_lens_report {
    weft_lens lens;
    int used, point_count; /* photographs, and corners in them */
    int stray_count;       /* corners that were left out */
    double focal_error;    /* of fx, relative: the larger standard error of the two (see weft_lens_calibrate) */
    double tilt_rad;       /* the largest angle between two places of the board */
    double reach;          /* of the farthest corner from the middle of the photograph, of half its diagonal */
    double pattern, noise; /* RMS of residuals that neighbouring corners share, and of what they do not, pixels */
    weft_lines fixed;      /* parameters that were fixed at 0, and why */
    weft_lines warnings;   /* what the photographs cannot tell */
    int count;
    weft_lens_photograph *photograph; /* [count]; the names are the caller's, the reasons the report's */
    weft_lines reasons;
} weft_lens_report;

/* Photographs in which the board is not seen, blurred ones and ones of another size are left out. Then, one after the
 * other, corners farther than 6 standard deviations from where the lens puts them, and photographs whose corners are
 * three times as far off as in others.
 *
 * Of the models that leave out k3, k2 and k3, or p1 and p2, and are plausible over the whole photograph, the one is
 * taken that Akaike's criterion prefers, corrected for few residuals (Hurvich and Tsai 1989).
 *
 * A standard error is the larger of two: that of least squares, which takes errors for independent, and the jackknife's
 * (Efron 1982), from leaving out photographs in turn, at most 10 groups of them.
 *
 * `report` is to be freed with weft_lens_report_free, whatever is returned: on failure it still has the photographs.
 * Errors: WEFT_BAD_INPUT where fewer than WEFT_LENS_FEWEST photographs can be used; WEFT_SYSTEM. */
weft_code weft_lens_calibrate(const weft_lens_settings *settings, const weft_lines *names,
                              const weft_progress *progress, weft_lens_report *report, weft_error *error);
void weft_lens_report_free(weft_lens_report *report);

#endif

/* One calibration over the photographs that are used. */
#ifndef WEFT_REGISTRATION_LENS_FIT_H
#define WEFT_REGISTRATION_LENS_FIT_H

#include "registration/lens/calibration.h"
#include "registration/lens/photographs.h"
#include "registration/pose/opencv_bridge.h"

typedef struct weft_lens_fit {
    weft_camera camera;
    weft_corner_fit corners; /* pose [views], residual_px [points] */
    int views;
    int *photograph;                    /* [views]: which */
    weft_corner_view *view;             /* [views]: the points that are used */
    int points;                         /* of all views */
    double (*board_mm)[2], (*pixel)[2]; /* [points] */
    int *source;                        /* [points]: index into the points of the photograph */
} weft_lens_fit;

/* Fits the photographs that are used, with `fixed` terms of the lens at 0 (WEFT_FIX_K2 and the like), without stray
 * corners, and without those with index `fold` modulo `folds` among the used ones (0 folds: with all). The caller frees
 * with weft_lens_fit_free. Errors: WEFT_BAD_INPUT where no lens fits; WEFT_SYSTEM. */
weft_code weft_lens_fit_run(const weft_board_photograph *photograph, int count, unsigned fixed, int fold, int folds,
                            weft_lens_fit *fit, weft_error *error);
void weft_lens_fit_free(weft_lens_fit *fit);

/* ---- How well photographs tell a lens ---- */

/* Raises the standard errors of the fit to the jackknife's where those are larger, as far as there are photographs to
 * leave out. Errors: WEFT_SYSTEM. */
weft_code weft_lens_jackknife(const weft_board_photograph *photograph, int count, unsigned fixed,
                              const weft_progress *progress, weft_lens_fit *fit, weft_error *error);

/* Measures tilt, reach, pattern and noise, and warns. The lens of the report is that of the fit. Errors: WEFT_SYSTEM.
 */
weft_code weft_lens_judge(const weft_lens_fit *fit, weft_lens_report *report, weft_error *error);

#endif

/* One calibration over the photographs that are used. */
#ifndef WEFT_REGISTRATION_LENS_FIT_H
#define WEFT_REGISTRATION_LENS_FIT_H

#include "base/progress.h"
#include "base/text/lines.h"
#include "registration/lens/board.h"
#include "registration/lens/calibration.h"
#include "registration/pose/opencv_bridge.h"

#include <stdbool.h>

/* ---- Photographs of a board, and what was found in them ---- */

enum { WEFT_REASON_SIZE = 200 };

typedef struct weft_board_photograph {
    const char *name;
    char left_out[WEFT_REASON_SIZE]; /* why; "": it is used */
    int width, height;               /* as stored */
    double edge_width;               /* of its edges, pixels */
    int count;
    weft_board_point *point; /* [count] */
    bool *stray;             /* [count]: far from where the lens puts it, not used */
} weft_board_photograph;

/* Finds the board in each; what cannot be used says why. The names must live on. The caller frees with
 * weft_board_photographs_free. Errors: WEFT_SYSTEM. */
weft_code weft_board_photographs_read(const weft_board *board, const weft_lines *names, const weft_progress *progress,
                                      weft_board_photograph **photograph, weft_error *error);
void weft_board_photographs_free(weft_board_photograph *photograph, int count);

void weft_board_leave_out(weft_board_photograph *photograph, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
bool weft_board_is_used(const weft_board_photograph *photograph);
int weft_board_used(const weft_board_photograph *photograph, int count);

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

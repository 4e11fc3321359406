/* Photographs of a board, and what was found in them. */
#ifndef WEFT_REGISTRATION_LENS_PHOTOGRAPHS_H
#define WEFT_REGISTRATION_LENS_PHOTOGRAPHS_H

#include "base/progress.h"
#include "base/text/lines.h"
#include "registration/lens/board_points.h"

#include <stdbool.h>

enum { WEFT_REASON_SIZE = 200 };

typedef struct weft_board_photograph {
    const char *name;
    char left_out[WEFT_REASON_SIZE]; /* why; "": it is used */
    int width, height;               /* as stored */
    double edge_width;               /* weft_board_edge_width */
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

/* The middle of `count` values, which it sorts; 0 of none. */
double weft_board_median(double *value, int count);

#endif

/* How long a frame of a model takes here: of the drape, every texel, level and direction evaluated. */
#ifndef WEFT_COMPARE_TRADEOFF_FRAME_TIMER_H
#define WEFT_COMPARE_TRADEOFF_FRAME_TIMER_H

#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/material/material.h"
#include "reflectance/microcylinder/microcylinder.h"
#include "reflectance/weave/weave.h"

/* A player without a window. One thread uses it. */
typedef struct weft_frame_timer weft_frame_timer;

/* Without OpenGL there is a timer, too, which draws nothing. The caller closes it. Errors: WEFT_SYSTEM. */
weft_code weft_frame_timer_open(weft_frame_timer **result, weft_error *error);
void weft_frame_timer_close(weft_frame_timer *timer);

/* Why nothing is drawn, or "". */
const char *weft_frame_timer_why_not(const weft_frame_timer *timer);
/* Who draws, or "". */
const char *weft_frame_timer_renderer(const weft_frame_timer *timer);

/* Milliseconds a frame of 730 x 400 pixels, through the heights of the material where it has some; 0 where nothing is
 * drawn. Errors: those of drawing. */
weft_code weft_frame_timer_of_material(weft_frame_timer *timer, const weft_material *material, double *frame_ms,
                                       weft_error *error);

/* The same of the photographs, interpolated. Errors: those of reading and drawing. */
weft_code weft_frame_timer_of_dataset(weft_frame_timer *timer, weft_dataset *dataset, bool through_heights,
                                      const weft_progress *progress, double *frame_ms, weft_error *error);

/* The same of analytic cloth, which stays the caller's: of `weave`, or of `threads` where that is NULL. Errors: those
 * of drawing.
 */
weft_code weft_frame_timer_of_cloth(weft_frame_timer *timer, const weft_weave *weave,
                                    const weft_microcylinder_cloth *threads, double *frame_ms, weft_error *error);

#endif

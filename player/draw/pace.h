/* How interactive frames keep their target of 30 a second: they are sampled less and, if need be, drawn smaller. The
 * pace is pure: times in, what to draw out; no OpenGL and no clock. */
#ifndef WEFT_PLAYER_DRAW_PACE_H
#define WEFT_PLAYER_DRAW_PACE_H

#include "player/draw/player.h"

#include <stdbool.h>

/* Target of an interactive frame: 30 frames/s. */
#define WEFT_PACE_MS (1000.0 / 30)
/* Slower exact frames are replaced by interactive ones (weft_sampling) while something changes. */
#define WEFT_PACE_INTERACTIVE_MS 15.0

/* Zeroed: no frame was timed yet, and nothing is left out. */
typedef struct weft_pace {
    double exact_ms;  /* smoothed, of exact frames; 0: none yet */
    double last_ms;   /* of the last exact frame */
    int step;         /* index into the sides of an interactive frame; 0: the whole side */
    int slow, fast;   /* successive interactive frames that took too long, and that had time for the next side */
    double slow_side; /* the largest side that these slow ones had time for */
} weft_pace;

/* Whether frames are interactive while something changes; otherwise all are exact. */
bool weft_pace_is_interactive(const weft_pace *pace);

/* Side of an interactive frame as a share of the side of the canvas, in (0, 1]; 1 for exact frames. */
double weft_pace_side(const weft_pace *pace);

/* Notes the time of a frame in ms: drawn_ms to draw it at weft_pace_side, and shown_ms to bring it and the panel to the
 * screen, which a smaller side does not shorten. `interactive`: the frame was one (converging frames are not). Of exact
 * frames the faster of two in a row counts, because the first one with other programs of the graphics driver is slow.
 * The second slow frame in a row makes the picture as small as necessary, so one hiccup changes nothing. Eight frames
 * in a row with time for the next larger side, and some to spare, get that side. Times that are negative or not finite
 * are ignored. */
void weft_pace_note(weft_pace *pace, bool interactive, double drawn_ms, double shown_ms);

/* ---- The frames of a window: interactive ones, and those whose mean is the converged picture ---- */

/* Draws an interactive frame as `pace` says. A smaller frame is enlarged, its labels are not. Clears the canvas.
 * Errors: those of weft_player_draw. */
weft_code weft_player_draw_interactive(weft_player *player, const weft_scene *scene, const weft_pace *pace,
                                       weft_canvas *canvas, weft_error *error);

/* Sampling of frame number `frame`, from 0: the first lies on the centres of the pixels, any first few are evenly
 * distributed over them. Pure. */
weft_sampling weft_sampling_converging(int frame);

#endif

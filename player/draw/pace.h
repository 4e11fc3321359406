/* How a moving picture keeps its promise of so many frames a second: by what it draws less of. Pure: times in, what to
 * draw out; no OpenGL and no clock. */
#ifndef WEFT_PLAYER_DRAW_PACE_H
#define WEFT_PLAYER_DRAW_PACE_H

#include <stdbool.h>

/* What a frame may take while things move: that of 30 frames/s. */
#define WEFT_PACE_MS (1000.0 / 30)
/* What a frame may take that evaluates everything: beyond that, moving ones hurry (weft_sampling). */
#define WEFT_PACE_HURRY_MS 15.0

/* Zeroed, it has heard of no frame: nothing is left out. */
typedef struct weft_pace {
    double exact_ms;  /* smoothed, of frames that did not hurry; 0: none yet */
    double last_ms;   /* of the last of them */
    int step;         /* of the sides that a hurried frame may have, from the whole one */
    int slow, fast;   /* hurried frames in a row that took too long, and that had time for the next larger side */
    double slow_side; /* the largest that these slow ones had time for */
} weft_pace;

/* Whether moving frames hurry. */
bool weft_pace_hurries(const weft_pace *pace);

/* Side of a moving picture as a share of that of the canvas, in (0, 1]; 1 unless it hurries. */
double weft_pace_side(const weft_pace *pace);

/* Takes in how long a frame took, in ms: drawn_ms to draw at weft_pace_side, and shown_ms to bring it and the panel to
 * the screen, which no smaller side saves. `hurried`: whether it did (frames at rest do not). Of frames that did not,
 * the faster one of two in a row counts: the first one with other programs of the graphics driver takes long. The
 * second slow frame in a row makes the picture as small as it has to be, so that one hiccup does not; eight in a row
 * that had time for the next larger side, and some to spare, give it that. Times that are negative or not finite are
 * ignored. */
void weft_pace_note(weft_pace *pace, bool hurried, double drawn_ms, double shown_ms);

#endif

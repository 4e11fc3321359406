/* Names over parts of a picture, in the typeface of the user interface. */
#ifndef WEFT_PLAYER_GL_LABEL_H
#define WEFT_PLAYER_GL_LABEL_H

#include "base/picture/letters.h"
#include "player/gl/gl.h"

#include <stdbool.h>

typedef struct weft_labels {
    GLuint program, font, vertex_array, vertex_buffer;
    weft_letters letters; /* that `font` holds; size 0: none yet */
} weft_labels;

/* The caller frees with weft_labels_free, also on failure. Errors: WEFT_SYSTEM. */
weft_code weft_labels_create(weft_labels *labels, weft_error *error);
void weft_labels_free(weft_labels *labels);

/* Height of the letters that suits a picture, pixels. Pure. */
int weft_label_size(int picture_height);

/* Linear radiance, and how much of what is behind is covered. */
typedef struct weft_label_ink {
    float plate[4], letters[4];
} weft_label_ink;

/* Light letters on a dark plate. */
extern const weft_label_ink weft_plain_ink;

/* Draws a line of ASCII, other characters as '?', on a plate in a viewport of width x height pixels. The plate's
 * corner lies at (x, y) pixels from the upper left: its upper left one, or, to_the_left, its upper right one. Errors:
 * WEFT_SYSTEM. */
weft_code weft_label_draw(weft_labels *labels, int width, int height, int x, int y, bool to_the_left, const char *text,
                          const weft_label_ink *ink, weft_error *error);

#endif

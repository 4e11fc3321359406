/* Text over a picture. */
#ifndef WEFT_PLAYER_OVERLAY_H
#define WEFT_PLAYER_OVERLAY_H

#include "player/gl.h"

typedef struct weft_overlay {
    GLuint program, font, vertex_array, vertex_buffer;
} weft_overlay;

/* The caller frees with weft_overlay_free, also on failure. Errors: WEFT_SYSTEM. */
weft_code weft_overlay_create(weft_overlay *overlay, weft_error *error);
void weft_overlay_free(weft_overlay *overlay);

/* Height of a line of text at a magnification, pixels. Pure. */
int weft_overlay_line_height(int scale);

/* Draws lines of ASCII separated by '\n' on a dark plate whose upper left corner is (x, y) pixels from that of the
 * viewport of width x height. Other characters become '?'. */
void weft_overlay_text(const weft_overlay *overlay, int width, int height, int x, int y, int scale, const char *text);

#endif

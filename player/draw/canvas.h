/* Where frames are drawn and summed: the mean of slightly shifted frames is a supersampled picture. */
#ifndef WEFT_PLAYER_DRAW_CANVAS_H
#define WEFT_PLAYER_DRAW_CANVAS_H

#include "base/picture/image.h"
#include "player/gl/gl.h"
#include "player/scene/scene.h"

typedef struct weft_canvas {
    int width, height;
    int frame_count;                   /* summed so far */
    int drawn_width, drawn_height;     /* of the last frame begun, which may have been enlarged */
    GLuint frame_buffer, frame, depth; /* the frame being drawn, unless it is the first: linear RGB, floats */
    GLuint sum_buffer, sum;            /* the first frame is drawn here */
    GLuint vertex_array;               /* empty, for full-screen triangles */
    GLuint add_program, enlarge_program, present_program;
} weft_canvas;

/* The caller frees with weft_canvas_free, also on failure. Errors: WEFT_SYSTEM. */
weft_code weft_canvas_create(int width, int height, weft_canvas *canvas, weft_error *error);
void weft_canvas_free(weft_canvas *canvas);

/* Forgets the frames. */
void weft_canvas_clear(weft_canvas *canvas);

/* Drawing goes to a new frame from here, until weft_canvas_end_frame adds it to the sum. */
void weft_canvas_begin_frame(weft_canvas *canvas);
void weft_canvas_end_frame(weft_canvas *canvas);

/* The same for the only frame of a canvas: one of fewer pixels, drawn_width x drawn_height, which weft_canvas_end_frame
 * enlarges. side: of it, as a share of that of the canvas, in (0, 1]. The sum of frames is bound from the end on, for
 * what is to be drawn over it in full. */
void weft_canvas_begin_small_frame(weft_canvas *canvas, double side);

/* Draws the mean of the frames as the screen shows it (weft_scene_show) into the framebuffer that is bound, `left`
 * pixels from its left edge. */
void weft_canvas_present(const weft_canvas *canvas, const weft_scene *scene, int left);

/* The mean of the frames, linear. The caller frees the image. Errors: WEFT_SYSTEM. */
weft_code weft_canvas_read(const weft_canvas *canvas, weft_image *image, weft_error *error);

#endif

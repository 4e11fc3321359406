/* Frames of the widgets without a window or OpenGL: where they stand is computed, nothing is drawn. */
#ifndef WEFT_TESTS_PLAYER_WINDOW_UI_FRAMES_BRIDGE_H
#define WEFT_TESTS_PLAYER_WINDOW_UI_FRAMES_BRIDGE_H

#ifdef __cplusplus
extern "C" {
#endif

void ui_frames_open(double width, double height);
void ui_frames_close(void);
void ui_frames_begin(void);
/* Where the pointer is from now on. */
void ui_frames_point(double x, double y);
/* `name`: of a panel or note of this frame; 0 and 0 where there is none. */
void ui_frames_end(const char *name, double *width, double *height);
/* Where its upper end was in the frame that ended last. */
double ui_frames_top(const char *name);

#ifdef __cplusplus
}
#endif
#endif

#include "player/draw/pace.h"

#include <math.h>

/* However small, it has a pixel for every pane. */
static double side_of(const weft_scene *scene, const weft_pace *pace, const weft_canvas *canvas)
{
    return fmin(1, fmax(weft_pace_side(pace), (double)weft_scene_panes(scene) / canvas->width));
}

weft_code weft_player_draw_interactive(weft_player *p, const weft_scene *scene, const weft_pace *pace,
                                       weft_canvas *canvas, weft_error *error)
{
    const weft_sampling sampling = {.frame = -1, .interactive = weft_pace_is_interactive(pace)};
    double side = side_of(scene, pace, canvas);
    weft_canvas_clear(canvas);
    if (side == 1) {
        weft_canvas_begin_frame(canvas);
        WEFT_TRY(weft_player_draw(p, scene, canvas->width, canvas->height, sampling, error));
        weft_canvas_end_frame(canvas);
        return WEFT_OK;
    }
    weft_scene unlabelled = *scene;
    unlabelled.labels = false;
    weft_canvas_begin_small_frame(canvas, side);
    WEFT_TRY(weft_player_draw(p, &unlabelled, canvas->drawn_width, canvas->drawn_height, sampling, error));
    weft_canvas_end_frame(canvas);
    return weft_player_draw_labels(p, scene, canvas->width, canvas->height, error);
}

/* ---- Converging frames ---- */

/* Any four frames in a row lie well apart along a pixel. */
static const double longest_pixel = 4;

static double radical_inverse(int index, int base)
{
    double result = 0, digit = 1;
    for (; index > 0; index /= base) {
        digit /= base;
        result += digit * (index % base);
    }
    return result;
}

weft_sampling weft_sampling_converging(int frame)
{
    return (weft_sampling){
        .shift_x = frame > 0 ? radical_inverse(frame, 2) - 0.5 : 0,
        .shift_y = frame > 0 ? radical_inverse(frame, 3) - 0.5 : 0,
        .longest_pixel = longest_pixel,
        .frame = frame,
        .neighbours_differ = true,
    };
}

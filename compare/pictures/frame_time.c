#include "compare/pictures/frame_time.h"

#include "base/clock.h"

#include <math.h>

/* How often, and how many frames along a side of the grid within a pixel: few and many. */
typedef struct frame_series {
    int tries, few, many;
} frame_series;

static weft_code time_picture(weft_player *player, const weft_scene *scene, int width, int height, int samples,
                              double *least_ms, weft_error *error)
{
    weft_image picture;
    double started_s = weft_now_s();
    WEFT_TRY(weft_player_picture(player, scene, width, height, samples, NULL, &picture, error));
    *least_ms = fmin(*least_ms, 1e3 * (weft_now_s() - started_s));
    weft_image_free(&picture);
    return WEFT_OK;
}

static weft_code measure(weft_player *player, const weft_scene *scene, int width, int height, frame_series series,
                         double *frame_ms, weft_error *error)
{
    double few_ms = INFINITY, many_ms = INFINITY;
    for (int i = 0; i < series.tries; i++) {
        WEFT_TRY(time_picture(player, scene, width, height, series.few, &few_ms, error));
        WEFT_TRY(time_picture(player, scene, width, height, series.many, &many_ms, error));
    }
    *frame_ms = fmax(many_ms - few_ms, 0) / (series.many * series.many - series.few * series.few);
    return WEFT_OK;
}

weft_code weft_frame_time_measure(weft_player *player, const weft_scene *scene, int width, int height, double *frame_ms,
                                  weft_error *error)
{
    return measure(player, scene, width, height, (frame_series){3, 1, 3}, frame_ms, error);
}

weft_code weft_frame_time_measure_once(weft_player *player, const weft_scene *scene, int width, int height,
                                       double *frame_ms, weft_error *error)
{
    return measure(player, scene, width, height, (frame_series){1, 1, 2}, frame_ms, error);
}

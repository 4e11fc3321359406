#include "compare/pictures/frame_time.h"

#include "base/clock.h"

#include <math.h>

/* Frames along a side of the grid within a pixel: few and many. */
enum { TRIES = 3, FEW = 1, MANY = 3 };

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

weft_code weft_frame_time_measure(weft_player *player, const weft_scene *scene, int width, int height, double *frame_ms,
                                  weft_error *error)
{
    double few_ms = INFINITY, many_ms = INFINITY;
    for (int i = 0; i < TRIES; i++) {
        WEFT_TRY(time_picture(player, scene, width, height, FEW, &few_ms, error));
        WEFT_TRY(time_picture(player, scene, width, height, MANY, &many_ms, error));
    }
    *frame_ms = fmax(many_ms - few_ms, 0) / (MANY * MANY - FEW * FEW);
    return WEFT_OK;
}

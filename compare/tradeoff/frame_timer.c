#include "compare/tradeoff/frame_timer.h"

#include "compare/pictures/frame_time.h"
#include "player/draw/player.h"
#include "player/gl/context.h"

#include <stdio.h>
#include <stdlib.h>

enum { FRAME_WIDTH = 730, FRAME_HEIGHT = 400 };

struct weft_frame_timer {
    weft_headless *headless;
    weft_player *player;
    char why_not[WEFT_MESSAGE_SIZE], renderer[128];
};

static weft_code set_drape(weft_player *player, weft_error *error)
{
    weft_mesh mesh;
    WEFT_TRY(weft_mesh_open("drape", &mesh, error));
    weft_code code = weft_player_set_mesh(player, &mesh, error);
    weft_mesh_free(&mesh);
    return code;
}

static weft_code open_player(weft_frame_timer *timer, weft_error *error)
{
    weft_error absence = {0};
    if (weft_headless_create(WEFT_GL_CORE, &timer->headless, &absence) != WEFT_OK) {
        timer->headless = NULL;
        snprintf(timer->why_not, sizeof timer->why_not, "%s", absence.message);
        return WEFT_OK;
    }
    snprintf(timer->renderer, sizeof timer->renderer, "%s", weft_gl_renderer());
    WEFT_TRY(weft_player_create(&timer->player, error));
    return set_drape(timer->player, error);
}

weft_code weft_frame_timer_open(weft_frame_timer **result, weft_error *error)
{
    *result = NULL;
    weft_frame_timer *timer = calloc(1, sizeof *timer);
    if (!timer)
        return weft_fail_memory(error, "frames", sizeof *timer);
    weft_code code = open_player(timer, error);
    if (code == WEFT_OK)
        *result = timer;
    else
        weft_frame_timer_close(timer);
    return code;
}

void weft_frame_timer_close(weft_frame_timer *timer)
{
    if (!timer)
        return;
    weft_player_free(timer->player);
    weft_headless_free(timer->headless);
    free(timer);
}

const char *weft_frame_timer_why_not(const weft_frame_timer *timer)
{
    return timer->why_not;
}

const char *weft_frame_timer_renderer(const weft_frame_timer *timer)
{
    return timer->renderer;
}

static weft_code time_frame(weft_frame_timer *timer, weft_mode mode, bool through_heights, double *frame_ms,
                            weft_error *error)
{
    weft_scene scene = weft_scene_default();
    scene.pane_count = 1;
    scene.pane[0] = mode;
    scene.labels = false;
    scene.relief = through_heights;
    scene.filter = WEFT_FILTER_EXACT;
    return weft_frame_time_measure(timer->player, &scene, FRAME_WIDTH, FRAME_HEIGHT, frame_ms, error);
}

weft_code weft_frame_timer_of_material(weft_frame_timer *timer, const weft_material *material, double *frame_ms,
                                       weft_error *error)
{
    *frame_ms = 0;
    if (!timer->player)
        return WEFT_OK;
    weft_player_clear(timer->player, WEFT_MODE_RAW); /* which is large */
    WEFT_TRY(weft_player_set_material(timer->player, material, error));
    return time_frame(timer, WEFT_MODE_COMPRESSED, true, frame_ms, error);
}

weft_code weft_frame_timer_of_dataset(weft_frame_timer *timer, weft_dataset *dataset, bool through_heights,
                                      const weft_progress *progress, double *frame_ms, weft_error *error)
{
    int skipped_levels;
    *frame_ms = 0;
    if (!timer->player)
        return WEFT_OK;
    weft_player_clear(timer->player, WEFT_MODE_RAW);
    WEFT_TRY(weft_player_set_dataset(timer->player, dataset, progress, &skipped_levels, error));
    return time_frame(timer, WEFT_MODE_RAW, through_heights, frame_ms, error);
}

weft_code weft_frame_timer_of_cloth(weft_frame_timer *timer, const weft_weave *weave,
                                    const weft_microcylinder_cloth *threads, double *frame_ms, weft_error *error)
{
    *frame_ms = 0;
    if (!timer->player)
        return WEFT_OK;
    weft_player_clear(timer->player, WEFT_MODE_RAW);
    if (weave) {
        const weft_weave_layout tiles = weft_weave_lay_out(weave, 0, 0);
        WEFT_TRY(weft_player_set_weave(timer->player, weave, &tiles, error));
    } else {
        WEFT_TRY(weft_player_set_threads(timer->player, threads, error));
    }
    return time_frame(timer, WEFT_MODE_ANALYTIC, false, frame_ms, error);
}

#include "player/window/application_state.h"

#include "base/clock.h"
#include "player/draw/pace.h"
#include "player/settings/exposure.h"

#include <epoxy/gl.h>

enum { STILL_FRAMES = 16, STILL_FRAMES_OF_ENVIRONMENT = 64 };

static const double settle_s = 0.12; /* after the last change the mean of a picture at rest begins */

bool weft_application_has_something(const weft_application *a)
{
    const bool *has = a->interaction.available;
    bool has_model = has[WEFT_MODE_RAW] || has[WEFT_MODE_COMPRESSED] || has[WEFT_MODE_ANALYTIC];
    return has_model && weft_player_has_mesh(a->player);
}

void weft_application_speed(const weft_application *a, long *frames, double *frame_ms)
{
    *frames = a->frame_count;
    *frame_ms = a->frame_count > 0 ? a->total_ms / (double)a->frame_count : 0;
}

/* ---- Frames ---- */

weft_code weft_application_prepare_canvas(weft_application *a, int width, int height, weft_error *error)
{
    weft_interaction *i = &a->interaction;
    i->width = width;
    i->height = height;
    bool is_resized = width != a->canvas.width || height != a->canvas.height;
    if (is_resized) {
        weft_canvas_free(&a->canvas);
        WEFT_TRY(weft_canvas_create(width, height, &a->canvas, error));
    }
    if (i->changed || is_resized) {
        weft_canvas_clear(&a->canvas);
        a->moved_s = weft_now_s();
        a->converges = false;
        a->errors[0] = a->unmeasured[0] = 0;
    } else if (!a->converges && weft_now_s() - a->moved_s > settle_s) {
        weft_canvas_clear(&a->canvas);
        a->converges = true;
    }
    i->changed = false;
    return WEFT_OK;
}

static weft_code draw_converging(weft_application *a, weft_error *error)
{
    weft_canvas *canvas = &a->canvas;
    weft_sampling sampling = weft_sampling_converging(canvas->frame_count);
    weft_canvas_begin_frame(canvas);
    WEFT_TRY(weft_player_draw(a->player, &a->interaction.scene, canvas->width, canvas->height, sampling, error));
    weft_canvas_end_frame(canvas);
    return WEFT_OK;
}

static weft_code draw_frame(weft_application *a, weft_error *error)
{
    double start = weft_now_s();
    a->drew_interactive = !a->converges && weft_pace_is_interactive(&a->pace);
    WEFT_TRY(a->converges
                 ? draw_converging(a, error)
                 : weft_player_draw_interactive(a->player, &a->interaction.scene, &a->pace, &a->canvas, error));
    glFinish();
    a->drawn_ms = 1000 * (weft_now_s() - start);
    a->total_ms += a->drawn_ms;
    a->frame_count++;
    return WEFT_OK;
}

/* The first frame builds programs and is no measure of the others. */
void weft_application_note_time(weft_application *a, double shown_ms)
{
    double whole_ms = a->drawn_ms + shown_ms;
    if (a->drawn_ms > 0 && a->frame_count > 1) {
        weft_pace_note(&a->pace, a->drew_interactive, a->drawn_ms, shown_ms);
        a->frame_ms = a->frame_ms > 0 ? 0.8 * a->frame_ms + 0.2 * whole_ms : whole_ms;
    }
    a->drawn_ms = 0;
}

static int still_frames(const weft_application *a)
{
    bool many_lights = a->interaction.scene.environment && weft_player_has_environment(a->player);
    return many_lights ? STILL_FRAMES_OF_ENVIRONMENT : STILL_FRAMES;
}

bool weft_application_is_finished(const weft_application *a)
{
    return a->converges && a->canvas.frame_count >= still_frames(a);
}

static void measure(weft_application *a)
{
    weft_error error = {0};
    if (a->setup.measure(a->player, &a->interaction.scene, a->canvas.width, a->canvas.height, a->errors, &error) !=
        WEFT_OK)
        weft_application_show_message(a, true, error.message);
    if (weft_describe_unmeasured(a->setup.settings, a->player, &a->interaction.scene, a->unmeasured, &error) != WEFT_OK)
        weft_application_show_message(a, true, error.message);
}

/* When all is there that the command line named; later the user's is the exposure. */
static weft_code expose_once(weft_application *a, weft_error *error)
{
    weft_interaction *i = &a->interaction;
    bool changed = false;
    if (a->is_exposed || a->progress >= 0)
        return WEFT_OK;
    a->is_exposed = true;
    if (i->scene.exposure == i->start.exposure)
        WEFT_TRY(weft_expose(a->setup.settings, a->player, &i->scene, &changed, error));
    if (changed)
        i->start.exposure = i->scene.exposure;
    i->changed |= changed;
    return WEFT_OK;
}

/* One frame more, unless the mean is finished or a moving picture stands. */
static weft_code advance(weft_application *a, weft_error *error)
{
    if (a->setup.frame_limit > 0 && weft_application_is_finished(a))
        weft_canvas_clear(&a->canvas);
    if (weft_application_is_finished(a) || (!a->converges && a->canvas.frame_count > 0))
        return WEFT_OK;
    WEFT_TRY(draw_frame(a, error));
    if (weft_application_is_finished(a))
        measure(a);
    return WEFT_OK;
}

weft_code weft_application_draw(weft_application *a, weft_error *error)
{
    WEFT_TRY(expose_once(a, error));
    return advance(a, error);
}

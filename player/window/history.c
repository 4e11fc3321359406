#include "player/window/history.h"

#include <stdlib.h>
#include <string.h>

static void free_state(weft_history_state *state)
{
    free(state->yarn);
    *state = (weft_history_state){0};
}

void weft_history_free(weft_history *history)
{
    for (int i = 0; i < history->count; i++)
        free_state(&history->state[i]);
    history->count = history->now = 0;
}

/* ---- Keeping ---- */

static weft_history_state state_of(const weft_scene *scene, const weft_weave_edit *edit)
{
    const weft_weave *weave = &edit->weave;
    weft_history_state state = {
        .scene = *scene, .weave_reads = edit->reads, .fineness = weave->fineness, .period = weave->period};
    memcpy(state.inclination_noise_deg, weave->inclination_noise_deg, sizeof state.inclination_noise_deg);
    size_t size = sizeof *state.yarn * (size_t)weave->yarn_count;
    state.yarn = size > 0 ? malloc(size) : NULL;
    if (state.yarn) {
        memcpy(state.yarn, weave->yarn, size);
        state.yarn_count = weave->yarn_count;
    }
    return state;
}

/* Bytes, padding included: a difference there alone would only be one state more. */
static bool is_same(const void *a, const void *b, size_t size)
{
    return memcmp(a, b, size) == 0;
}

static bool is_same_scene(const weft_scene *a, const weft_scene *b)
{
    weft_scene turned = *a;
    turned.orbit = b->orbit;
    return is_same(&turned, b, sizeof turned);
}

static bool is_same_weave(const weft_history_state *state, const weft_weave_edit *edit)
{
    const weft_weave *weave = &edit->weave;
    bool same_yarns =
        state->yarn_count == weave->yarn_count &&
        (state->yarn_count == 0 || is_same(state->yarn, weave->yarn, sizeof *state->yarn * (size_t)state->yarn_count));
    return state->weave_reads == edit->reads && same_yarns && state->fineness == weave->fineness &&
           state->period == weave->period &&
           is_same(state->inclination_noise_deg, weave->inclination_noise_deg, sizeof state->inclination_noise_deg);
}

static bool is_now(const weft_history *history, const weft_scene *scene, const weft_weave_edit *edit)
{
    const weft_history_state *state = &history->state[history->now];
    return history->count > 0 && is_same_scene(&state->scene, scene) && is_same_weave(state, edit);
}

void weft_history_note(weft_history *history, const weft_scene *scene, const weft_weave_edit *weave)
{
    if (is_now(history, scene, weave))
        return;
    while (history->count > 0 && history->count > history->now + 1)
        free_state(&history->state[--history->count]);
    if (history->count == WEFT_HISTORY_LENGTH) {
        free_state(&history->state[0]);
        memmove(history->state, history->state + 1, sizeof history->state - sizeof history->state[0]);
        history->count--;
    }
    history->now = history->count;
    history->state[history->count++] = state_of(scene, weave);
}

/* ---- Going back ---- */

static bool restore_weave(const weft_history_state *state, weft_weave_edit *edit)
{
    weft_weave *weave = &edit->weave;
    bool is_another = state->weave_reads != edit->reads || state->yarn_count != weave->yarn_count;
    if (state->yarn_count == 0 || is_another || is_same_weave(state, edit))
        return false;
    memcpy(weave->yarn, state->yarn, sizeof *state->yarn * (size_t)state->yarn_count);
    memcpy(weave->inclination_noise_deg, state->inclination_noise_deg, sizeof state->inclination_noise_deg);
    weave->fineness = state->fineness;
    weave->period = state->period;
    edit->is_changed = edit->is_unsaved = true;
    return true;
}

static bool go_to(weft_history *history, int index, weft_scene *scene, weft_weave_edit *weave, bool *weave_changed)
{
    *weave_changed = false;
    if (index < 0 || index >= history->count)
        return false;
    weft_orbit orbit = scene->orbit;
    history->now = index;
    *scene = history->state[index].scene;
    scene->orbit = orbit;
    *weave_changed = restore_weave(&history->state[index], weave);
    return true;
}

bool weft_history_undo(weft_history *history, weft_scene *scene, weft_weave_edit *weave, bool *weave_changed)
{
    weft_history_note(history, scene, weave);
    return go_to(history, history->now - 1, scene, weave, weave_changed);
}

bool weft_history_redo(weft_history *history, weft_scene *scene, weft_weave_edit *weave, bool *weave_changed)
{
    weft_history_note(history, scene, weave);
    return go_to(history, history->now + 1, scene, weave, weave_changed);
}

#include "player/window/weave_edit.h"

#include <stddef.h>
#include <stdio.h>
#include <unistd.h>

const weft_weave_parameter_range weft_weave_ranges[WEFT_WEAVE_RANGES] = {
    {"Twist", offsetof(weft_yarn, segment.psi), -0.5 * WEFT_PI, 0.5 * WEFT_PI, true, false},
    {"Incline", offsetof(weft_yarn, segment.umax), WEFT_PI / 180, 0.5 * WEFT_PI, true, false},
    {"Curvature", offsetof(weft_yarn, segment.kappa), -0.95, 4, false, false},
    {"Uniform", offsetof(weft_yarn, segment.alpha), 0, 1, false, false},
    {"Forward", offsetof(weft_yarn, segment.beta), 0, 20, false, false},
    {"Fade", offsetof(weft_yarn, segment.delta), 0, 1, false, false},
    {"Highlight", offsetof(weft_yarn, segment.highlight_width), 0.02, 1, false, false},
    {"Width", offsetof(weft_yarn, segment.width), 0.1, 4, false, true},
    {"Length", offsetof(weft_yarn, segment.length), 0.1, 16, false, true},
};

void weft_weave_edit_free(weft_weave_edit *edit)
{
    weft_weave_worker_free(edit->worker);
    weft_weave_free(&edit->weave);
    *edit = (weft_weave_edit){0};
}

weft_code weft_weave_edit_follow(weft_weave_edit *edit, const weft_player *player, const char *path, weft_error *error)
{
    long revision = weft_player_weave_revision(player);
    if (edit->revision == revision)
        return WEFT_OK;
    int reads = edit->reads;
    weft_weave_edit_free(edit);
    edit->reads = reads + 1;
    edit->revision = revision;
    edit->alike = true;
    if (!path)
        return WEFT_OK;
    WEFT_TRY(weft_weave_read(path, NULL, 0, &edit->weave, NULL, error));
    weft_code code = weft_weave_worker_create(&edit->weave, &edit->worker, error);
    if (code != WEFT_OK)
        weft_weave_free(&edit->weave);
    return code;
}

static weft_real *value_in(weft_yarn *yarn, const weft_weave_parameter_range *range)
{
    return (weft_real *)(void *)((char *)yarn + range->offset);
}

double weft_weave_edit_get(const weft_weave_edit *edit, const weft_weave_parameter_range *range)
{
    return (double)*value_in(&edit->weave.yarn[edit->yarn], range);
}

static bool is_edited(const weft_weave_edit *edit, int yarn)
{
    const weft_yarn *all = edit->weave.yarn;
    return yarn == edit->yarn || (edit->alike && all[yarn].alike == all[edit->yarn].alike);
}

void weft_weave_edit_set(weft_weave_edit *edit, const weft_weave_parameter_range *range, double value)
{
    for (int i = 0; i < edit->weave.yarn_count; i++) {
        if (is_edited(edit, i))
            *value_in(&edit->weave.yarn[i], range) = (weft_real)value;
    }
    edit->is_changed = edit->is_unsaved = true;
}

void weft_weave_edit_set_colours(weft_weave_edit *edit, weft_rgb kd, weft_rgb ks)
{
    for (int i = 0; i < edit->weave.yarn_count; i++) {
        if (is_edited(edit, i)) {
            edit->weave.yarn[i].kd = kd;
            edit->weave.yarn[i].ks = ks;
        }
    }
    edit->is_changed = edit->is_unsaved = true;
}

void weft_weave_edit_set_noise(weft_weave_edit *edit, double fineness, double period, const double amplitude_deg[4])
{
    edit->weave.fineness = (weft_real)fineness;
    edit->weave.period = (weft_real)period;
    for (int i = 0; i < 4; i++)
        edit->weave.inclination_noise_deg[i] = (weft_real)amplitude_deg[i];
    edit->is_changed = edit->is_unsaved = true;
}

weft_code weft_weave_edit_ask(weft_weave_edit *edit, weft_error *error)
{
    WEFT_TRY(weft_weave_worker_ask(edit->worker, &edit->weave, error));
    edit->is_pending = true;
    return WEFT_OK;
}

weft_code weft_weave_edit_poll(weft_weave_edit *edit, weft_player *player, bool *shown, weft_error *error)
{
    bool exact = false;
    weft_weave_texels texels;
    *shown = false;
    if (!edit->is_pending || edit->revision != weft_player_weave_revision(player))
        return WEFT_OK;
    WEFT_TRY(weft_weave_worker_take(edit->worker, &texels, shown, &exact, error));
    if (!*shown)
        return WEFT_OK;
    weft_weave_layout layout = weft_player_weave_layout(player);
    weft_code code = weft_player_set_weave_texels(player, &texels, &layout, error);
    weft_weave_texels_free(&texels);
    edit->revision = weft_player_weave_revision(player);
    edit->is_pending = !exact;
    return code;
}

weft_code weft_weave_edit_save(weft_weave_edit *edit, char path[32], weft_error *error)
{
    int number = 1;
    do
        snprintf(path, 32, "weft-%03d.wv", number++);
    while (access(path, F_OK) == 0 && number < 1000);
    WEFT_TRY(weft_weave_write(path, &edit->weave, "Edited in weft play.", error));
    edit->is_unsaved = false;
    return WEFT_OK;
}

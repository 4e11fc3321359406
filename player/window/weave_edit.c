#include "player/window/weave_edit.h"

#include "reflectance/weave/batch.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* So long after the last change the exact scale is computed: while a slider moves nobody waits for it. */
static const double rest_s = 0.15;

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

/* ---- What follows from a change ---- */

struct weft_derived {
    weft_loader *loader;
    double correction; /* of estimated scales; the background's alone once a change is derived */
    bool is_awaited;   /* the estimate of the last change has not come yet */
    bool is_new, is_exact;
    weft_weave_texels texels; /* where new */
};

/* One change being derived. */
typedef struct derivation {
    struct weft_derived *derived;
    weft_weave weave;
    weft_weave_texels texels;
} derivation;

/* In the drawing thread. */
static weft_code hand_over(void *data, weft_error *error)
{
    (void)error;
    derivation *d = data;
    struct weft_derived *derived = d->derived;
    weft_weave_texels_free(&derived->texels);
    derived->texels = d->texels;
    d->texels = (weft_weave_texels){0};
    derived->is_exact = !derived->is_awaited;
    derived->is_awaited = false;
    derived->is_new = true;
    return WEFT_OK;
}

static void free_derivation(void *data)
{
    derivation *d = data;
    weft_weave_texels_free(&d->texels);
    weft_weave_free(&d->weave);
    free(d);
}

/* The texels of the weave with its estimated scale go ahead. */
static weft_code post_estimate(derivation *d, weft_load *load, weft_error *error)
{
    derivation *ahead = calloc(1, sizeof *ahead);
    if (!ahead)
        return weft_fail_memory(error, "weave", sizeof *ahead);
    ahead->derived = d->derived;
    weft_code code = weft_weave_texels_of(&d->weave, &ahead->texels, error);
    if (code == WEFT_OK)
        return weft_load_post(load, (weft_load_piece){hand_over, free_derivation, ahead, 0}, error);
    free_derivation(ahead);
    return code;
}

static weft_code derive(void *data, weft_load *load, weft_error *error)
{
    derivation *d = data;
    weft_weave *weave = &d->weave;
    weft_real estimate = 0;
    weft_weave_update_yarns(weave);
    WEFT_TRY(weft_weave_specular_scale_batch(weave, &estimate, error));
    weave->specular_scale = estimate * (weft_real)d->derived->correction;
    WEFT_TRY(post_estimate(d, load, error));
    if (!weft_load_rest(load, rest_s))
        return WEFT_OK;
    weave->specular_scale = weft_weave_specular_scale(weave);
    if (estimate > 0)
        d->derived->correction = (double)(weave->specular_scale / estimate);
    return weft_weave_texels_of(weave, &d->texels, error);
}

static void free_derived(struct weft_derived *derived)
{
    if (!derived)
        return;
    weft_loader_free(derived->loader);
    weft_weave_texels_free(&derived->texels);
    free(derived);
}

static weft_code create_derived(const weft_weave *start, struct weft_derived **result, weft_error *error)
{
    weft_real estimate;
    WEFT_TRY(weft_weave_specular_scale_batch(start, &estimate, error));
    struct weft_derived *derived = calloc(1, sizeof *derived);
    if (!derived)
        return weft_fail_memory(error, "weave", sizeof *derived);
    derived->correction = estimate > 0 ? (double)(start->specular_scale / estimate) : 1;
    weft_code code = weft_loader_create(&derived->loader, error);
    if (code == WEFT_OK)
        *result = derived;
    else
        free(derived);
    return code;
}

/* A change waits until the estimate of the one before has come: while a slider moves, all would be given up else. */
static weft_code start_deriving(weft_weave_edit *edit, weft_error *error)
{
    static const weft_load_steps steps = {derive, hand_over, free_derivation};
    struct weft_derived *derived = edit->derived;
    if (!edit->is_stale || derived->is_awaited)
        return WEFT_OK;
    derivation *d = calloc(1, sizeof *d);
    if (!d)
        return weft_fail_memory(error, "weave", sizeof *d);
    d->derived = derived;
    weft_code code = weft_weave_copy(&edit->weave, &d->weave, error);
    if (code != WEFT_OK) {
        free_derivation(d);
        return code;
    }
    edit->is_stale = false;
    derived->is_awaited = true;
    return weft_loader_start(derived->loader, 0, &steps, d, error);
}

/* ---- The weave ---- */

void weft_weave_edit_free(weft_weave_edit *edit)
{
    free_derived(edit->derived);
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
    weft_code code = create_derived(&edit->weave, &edit->derived, error);
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
    edit->is_stale = edit->is_pending = true;
    return start_deriving(edit, error);
}

weft_code weft_weave_edit_poll(weft_weave_edit *edit, weft_player *player, bool *shown, weft_error *error)
{
    struct weft_derived *derived = edit->derived;
    bool finished;
    *shown = false;
    if (!edit->is_pending || edit->revision != weft_player_weave_revision(player))
        return WEFT_OK;
    weft_code code = weft_loader_poll(derived->loader, 0, &finished, error);
    derived->is_awaited &= code == WEFT_OK;
    WEFT_TRY(code);
    WEFT_TRY(start_deriving(edit, error));
    if (!derived->is_new)
        return WEFT_OK;
    weft_weave_layout layout = weft_player_weave_layout(player);
    derived->is_new = false;
    WEFT_TRY(weft_player_set_weave_texels(player, &derived->texels, &layout, error));
    *shown = true;
    edit->revision = weft_player_weave_revision(player);
    edit->is_pending = !derived->is_exact || derived->is_awaited;
    return WEFT_OK;
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

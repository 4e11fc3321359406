#include "player/window/panel.h"

#include "player/window/ui/ui_bridge.h"

#include <limits.h>
#include <stdio.h>

static void tell(weft_application *a, weft_code code, const weft_error *error)
{
    if (code != WEFT_OK)
        weft_application_show_message(a, true, error->message);
}

static bool range_row(weft_weave_edit *edit, const weft_weave_parameter_range *range)
{
    double value = weft_weave_edit_get(edit, range);
    bool changed = range->is_angle
                       ? weft_ui_angle(range->name, &value, weft_deg_of_rad(range->low), weft_deg_of_rad(range->high))
                       : weft_ui_slider(range->name, &value, range->low, range->high, "%.3f", range->logarithmic);
    if (changed)
        weft_weave_edit_set(edit, range, value);
    return changed;
}

static weft_rgb rgb_of(const double value[3])
{
    return (weft_rgb){(weft_real)value[0], (weft_real)value[1], (weft_real)value[2]};
}

static bool colour_rows(weft_weave_edit *edit)
{
    const weft_yarn *yarn = &edit->weave.yarn[edit->yarn];
    double kd[3] = {(double)yarn->kd.r, (double)yarn->kd.g, (double)yarn->kd.b};
    double ks[3] = {(double)yarn->ks.r, (double)yarn->ks.g, (double)yarn->ks.b};
    bool changed = weft_ui_colour("Diffuse", kd);
    changed |= weft_ui_colour("Specular", ks);
    if (changed)
        weft_weave_edit_set_colours(edit, rgb_of(kd), rgb_of(ks));
    return changed;
}

static void choose_yarn(weft_weave_edit *edit)
{
    int number = edit->yarn + 1;
    char text[64];
    weft_ui_whole("Yarn", &number, 1, edit->weave.yarn_count);
    edit->yarn = number - 1;
    const weft_yarn *yarn = &edit->weave.yarn[edit->yarn];
    snprintf(text, sizeof text, "%s, %s%s", yarn->warp ? "warp" : "weft",
             yarn->prepared.filament ? "filament" : "staple",
             yarn->admissible ? "" : "; no such segment: no highlight");
    weft_ui_value("", text);
    weft_ui_toggle("Change all yarns like it", &edit->alike);
}

/* Whether there is noise; switched off and on again it is the same. */
static bool noise_toggle(weft_application *a)
{
    weft_interaction *i = &a->interaction;
    int *seed = &i->scene.noise_seed;
    bool noisy = *seed != 0;
    if (noisy)
        a->noise_seed = *seed;
    if (weft_ui_toggle("Noise", &noisy)) {
        *seed = !noisy ? 0 : a->noise_seed ? a->noise_seed : 1;
        i->changed = true;
    }
    return noisy;
}

/* Whether there is noise belongs to the picture, how strong it is to the weave. */
static bool noise_rows(weft_application *a)
{
    static const char *const label[] = {"Warp by warp", "Warp by weft", "Weft by warp", "Weft by weft"};
    weft_interaction *i = &a->interaction;
    weft_weave_edit *edit = &a->weave;
    if (!noise_toggle(a))
        return false;
    double fineness = (double)edit->weave.fineness, period = (double)edit->weave.period, amplitude[4];
    i->changed |= weft_ui_whole_input("Seed", &i->scene.noise_seed, 1, INT_MAX);
    bool changed = weft_ui_slider("Fineness", &fineness, 0, 10, "%.1f", false);
    changed |= weft_ui_slider("Period", &period, 0, 500, "%.0f", false);
    for (int k = 0; k < 4; k++) {
        amplitude[k] = (double)edit->weave.inclination_noise_deg[k];
        changed |= weft_ui_slider(label[k], &amplitude[k], 0, 40, "%.1f\xc2\xb0", false);
    }
    if (changed)
        weft_weave_edit_set_noise(edit, fineness, period, amplitude);
    return changed;
}

/* From then on the saved file is shown, so that pictures name it. */
static void save(weft_application *a)
{
    char path[32], note[WEFT_NOTE_SIZE];
    weft_error error = {0};
    weft_code code = weft_weave_edit_save(&a->weave, path, &error);
    tell(a, code, &error);
    if (code != WEFT_OK)
        return;
    weft_application_open(a, path);
    snprintf(note, sizeof note, "saved %s", path);
    weft_application_show_message(a, false, note);
}

void weft_panel_follow_weave(weft_application *a)
{
    bool shown;
    weft_error error = {0};
    tell(a, weft_weave_edit_poll(&a->weave, a->player, &shown, &error), &error);
    a->interaction.changed |= shown;
}

void weft_panel_show_weave(weft_application *a)
{
    weft_weave_edit *edit = &a->weave;
    weft_error error = {0};
    if (weft_player_has_threads(a->player)) {
        weft_ui_dim_text("Microcylinder cloth: change its file.");
        return;
    }
    tell(a, weft_weave_edit_follow(edit, a->player, weft_application_file(a, WEFT_MODE_ANALYTIC), &error), &error);
    if (edit->weave.yarn_count == 0)
        return;
    choose_yarn(edit);
    bool changed = false;
    for (int i = 0; i < WEFT_WEAVE_RANGES; i++)
        changed |= range_row(edit, &weft_weave_ranges[i]);
    changed |= colour_rows(edit);
    changed |= noise_rows(a);
    a->has_warned &= !changed;
    if (changed)
        tell(a, weft_weave_edit_ask(edit, &error), &error);
    if (weft_ui_button("Save this weave"))
        save(a);
}

#include "player/window/panel.h"

#include "base/clock.h"
#include "player/gl/label.h"
#include "player/scene/false_colour.h"
#include "player/window/keys.h"
#include "player/window/ui/ui_bridge.h"

#include <stdio.h>

enum { MAX_LINES = 64, MARGIN = 24, NARROWEST_WITH_ERRORS = 640 };

/* ---- What goes on ---- */

static void show_progress(const weft_application *a, double middle, double bottom)
{
    char text[64];
    snprintf(text, sizeof text, "Reading %.0f %%", 100 * a->progress);
    weft_ui_room_for("Reading 100 %");
    weft_ui_note_begin("progress", middle, bottom, 0.5, 1);
    weft_ui_text(text);
    weft_ui_panel_end();
}

static void show_note(const weft_application *a, double middle, double bottom)
{
    weft_ui_room_for(a->note);
    weft_ui_note_begin("note", middle, bottom, 0.5, 1);
    if (a->note_is_error)
        weft_ui_heading(a->note);
    else
        weft_ui_text(a->note);
    weft_ui_panel_end();
}

/* ---- What colours mean ---- */

static void show_levels(void)
{
    static const char *const name[WEFT_LEVEL_COLOURS] = {"0", "1", "2", "3", "4", "5 and more"};
    weft_ui_text("Mip level");
    for (int level = 0; level < WEFT_LEVEL_COLOURS; level++) {
        weft_ui_same_line();
        weft_ui_swatch(weft_level_swatch(level), name[level]);
    }
}

static void show_tints(void)
{
    weft_ui_text("Not measured:");
    weft_ui_same_line();
    weft_ui_swatch(weft_extrapolation_swatch((weft_missing){.view = true}), "view");
    weft_ui_same_line();
    weft_ui_swatch(weft_extrapolation_swatch((weft_missing){.light = true}), "light");
    weft_ui_same_line();
    weft_ui_swatch(weft_extrapolation_swatch((weft_missing){.view = true, .light = true}), "both");
    weft_ui_same_line();
    weft_ui_swatch(weft_extrapolation_swatch((weft_missing){.place = true}), "texel (pruned)");
}

static void show_colours(const weft_scene *scene, double left, double bottom, double scale)
{
    if ((!scene->show_level && !scene->show_extrapolation) || scene->layout == WEFT_LAYOUT_DIFFERENCE)
        return;
    weft_ui_note_begin("colours", left + 12 * scale, bottom - 12 * scale, 0, 1);
    if (scene->show_level)
        show_levels();
    else
        show_tints();
    weft_ui_panel_end();
}

/* How far what is compared is from raw; else what the compressed material says of itself. Not both: the one is of what
 * is visible, the other of directions. What is compared with raw says nothing until it rests. */
static const char *errors_of(const weft_application *a)
{
    const weft_scene *scene = &a->interaction.scene;
    bool shows_compressed = false;
    int panes = weft_scene_panes(scene);
    if (panes > 1 && a->interaction.available[WEFT_MODE_RAW])
        return a->errors;
    for (int pane = 0; pane < panes; pane++)
        shows_compressed |= scene->pane[pane] == WEFT_MODE_COMPRESSED;
    return shows_compressed ? a->held_out : "";
}

static void show_errors(const weft_application *a, double right, double bottom)
{
    const char *text = errors_of(a);
    bool fits = a->canvas.width >= NARROWEST_WITH_ERRORS * a->scale;
    if (!text[0] || !fits)
        return;
    weft_ui_note_begin("errors", right - 12 * a->scale, bottom - 12 * a->scale, 1, 1);
    weft_ui_wrap_within(a->canvas.width - 24 * a->scale);
    weft_ui_text(text);
    weft_ui_panel_end();
}

/* Below the labels of what is compared, which lie in the corners. */
static double top_of(const weft_application *a)
{
    const weft_scene *scene = &a->interaction.scene;
    bool is_labelled = scene->labels && scene->layout != WEFT_LAYOUT_DIFFERENCE && weft_scene_panes(scene) > 1;
    return 12 * a->scale + (is_labelled ? 2.0 * weft_label_size(a->canvas.height) : 0);
}

static void show_unmeasured(const weft_application *a, double left)
{
    if (!a->unmeasured[0])
        return;
    weft_ui_note_begin("unmeasured", left + 12 * a->scale, top_of(a), 0, 0);
    weft_ui_wrap_within(a->canvas.width - 24 * a->scale);
    weft_ui_text(a->unmeasured);
    weft_ui_panel_end();
}

/* ---- Mouse and keys ---- */

/* The heading that parts the list into two of about the same length. */
static size_t middle_heading(const weft_ui_entry *line, size_t count)
{
    size_t best = count;
    for (size_t i = 1; i < count; i++) {
        size_t longer = i > count - i ? i : count - i, best_longer = best > count - best ? best : count - best;
        if (!line[i].meaning && longer < best_longer)
            best = i;
    }
    return best;
}

static void show_help(const weft_ui_box *room)
{
    size_t key_count, count = 0;
    const weft_key *key = weft_keys(&key_count);
    weft_ui_entry line[MAX_LINES];
    for (size_t i = 0; i < key_count && count < MAX_LINES; i++) {
        if (key[i].name)
            line[count++] = (weft_ui_entry){key[i].name, key[i].meaning};
    }
    weft_ui_list("help", line, count, middle_heading(line, count), room);
}

void weft_panel_show_notes(const weft_application *a, int left, int width, int height)
{
    double middle = (left + width) / 2.0, bottom = height - MARGIN * a->scale;
    show_colours(&a->interaction.scene, left, height, a->scale);
    show_errors(a, width, height);
    show_unmeasured(a, left);
    const weft_ui_box room = {left, 0, width - left, height};
    if (a->progress >= 0) {
        show_progress(a, middle, bottom);
        bottom -= 2 * MARGIN * a->scale;
    }
    if (a->note[0] && weft_now_s() < a->note_ends_s)
        show_note(a, middle, bottom);
    if (a->interaction.shows_help)
        show_help(&room);
}

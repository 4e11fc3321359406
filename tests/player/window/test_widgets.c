/* Where a pointer that rests is told what a widget does: anywhere on it, on its label and on its value. */
#include "player/window/ui/ui_bridge.h"
#include "tests/player/window/ui_frames_bridge.h"
#include "tests/support/expect_ok.h"

#include <stdio.h>

enum {
    WIDTH = 1280,
    HEIGHT = 800,
    PANEL = 330,
    MIDDLE = 18,
    SETTLES = 3,
    LABEL = 12,
    VALUE = 96,
    END = 316,
    STEP = 10
};

typedef void widget(const char *label);

static void slider(const char *label)
{
    double value = 1;
    weft_ui_slider(label, &value, 0, 2, "%.2f", false);
}

static void whole(const char *label)
{
    int value = 4;
    weft_ui_whole(label, &value, 0, 8);
}

static void whole_input(const char *label)
{
    int value = 4;
    weft_ui_whole_input(label, &value, 0, 8000);
}

static void colour(const char *label)
{
    double value[3] = {1, 0.5, 0.25};
    weft_ui_colour(label, value);
}

static void nothing(const char *label)
{
    (void)label;
}

/* With the pointer at x in the line of the widget, the first of a panel, for some frames of half a second. */
static bool is_told_at(double x, widget *put, const char *label)
{
    double width = 0, height = 0;
    ui_frames_point(x, MIDDLE);
    for (int i = 0; i < SETTLES; i++) {
        ui_frames_begin();
        weft_ui_panel_begin("panel", 0, 0, PANEL, HEIGHT);
        put(label);
        weft_ui_panel_end();
        ui_frames_end("##Tooltip_00", &width, &height);
    }
    return width > 0;
}

static void a_hint_is_shown_all_along_its_widget(void **state)
{
    (void)state;
    static const struct {
        widget *put;
        const char *label;
    } widgets[] = {{slider, "Strength"}, {whole, "Yarn"}, {whole_input, "Seed"}, {colour, "Irradiance"}};
    for (size_t i = 0; i < sizeof widgets / sizeof *widgets; i++) {
        const char *label = widgets[i].label;
        assert_non_null(weft_hint_of(label));
        if (!is_told_at(LABEL, widgets[i].put, label))
            fail_msg("no hint on the label of %s", label);
        for (int x = VALUE; x <= END; x += STEP) {
            if (!is_told_at(x, widgets[i].put, label))
                fail_msg("no hint on the value of %s, %d pixels from the left", label, x);
        }
        assert_false(is_told_at(PANEL + 20, widgets[i].put, label));
    }
    assert_false(is_told_at(VALUE, nothing, ""));
    assert_false(is_told_at(VALUE, slider, "Rew"));
}

static int open_frames(void **state)
{
    (void)state;
    ui_frames_open(WIDTH, HEIGHT);
    return 0;
}

static int close_frames(void **state)
{
    (void)state;
    ui_frames_close();
    return 0;
}

int test_widgets(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hint_is_shown_all_along_its_widget),
    };
    return cmocka_run_group_tests(tests, open_frames, close_frames);
}

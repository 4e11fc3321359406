/* The notes over the picture: one that grows is as large at once as its new text, however long the next frame takes. */
#include "base/clock.h"
#include "player/gl/label.h"
#include "player/window/panel.h"
#include "tests/player/window/ui_frames_bridge.h"
#include "tests/support/expect_ok.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 1280, HEIGHT = 800, LEFT = 330, SETTLES = 6 };

typedef struct size {
    double width, height;
} size;

static size note_after(const weft_application *a, const char *name, int frames)
{
    size note = {0, 0};
    for (int i = 0; i < frames; i++) {
        ui_frames_begin();
        weft_panel_show_notes(a, LEFT, WIDTH, HEIGHT);
        ui_frames_end(name, &note.width, &note.height);
    }
    return note;
}

static weft_application *with_nothing_to_say(void)
{
    weft_application *a = calloc(1, sizeof *a);
    assert_non_null(a);
    a->scale = 1;
    a->progress = -1;
    a->interaction.scene = weft_scene_default();
    return a;
}

static void expect_whole_at_once(const weft_application *a, const char *name)
{
    size first = note_after(a, name, 1), later = note_after(a, name, SETTLES);
    printf("%s: %.0f x %.0f at first, then %.0f x %.0f\n", name, first.width, first.height, later.width, later.height);
    assert_true(later.width > 0 && later.height > 0);
    assert_true(first.width >= later.width && first.height >= later.height);
}

static void what_is_read_has_room_to_the_end(void **state)
{
    (void)state;
    weft_application *a = with_nothing_to_say();
    a->progress = 0.03;
    size before = note_after(a, "progress", SETTLES);
    a->progress = 1;
    expect_whole_at_once(a, "progress");
    size after = note_after(a, "progress", 1);
    assert_true(after.width == before.width); /* nor does it jump */
    free(a);
}

/* The second is wider, the third wraps into several lines. */
static void a_note_in_place_of_a_shorter_one_is_whole(void **state)
{
    (void)state;
    static const char *const said[] = {
        "drape", "wipe: compressed left, analytic right",
        "warning: the material was not made from 'a dataset with a name that is quite long "
        "of satin photographed in may.btf.h5' as it is: sizes, lights or views differ"};
    weft_application *a = with_nothing_to_say();
    a->note_ends_s = weft_now_s() + 1000;
    for (int i = 0; i < 3; i++) {
        snprintf(a->note, sizeof a->note, "%s", said[i]);
        if (i == 0)
            note_after(a, "note", SETTLES);
        expect_whole_at_once(a, "note");
    }
    free(a);
}

static void let(weft_application *a, int panes, weft_mode first, weft_mode second)
{
    a->interaction.scene.pane_count = panes;
    a->interaction.scene.pane[0] = first;
    a->interaction.scene.pane[1] = second;
}

static bool tells_errors(const weft_application *a)
{
    return note_after(a, "errors", SETTLES).width > 0;
}

/* Of a wide enough picture. */
static void a_material_says_its_error_where_it_is_shown(void **state)
{
    (void)state;
    weft_application *a = with_nothing_to_say();
    a->canvas.width = WIDTH - LEFT;
    let(a, 1, WEFT_MODE_COMPRESSED, WEFT_MODE_RAW);
    assert_false(tells_errors(a));
    snprintf(a->held_out, sizeof a->held_out, "error on directions that were not fitted: compressed 20.2 %%");
    assert_true(tells_errors(a));
    let(a, 1, WEFT_MODE_ANALYTIC, WEFT_MODE_COMPRESSED);
    assert_false(tells_errors(a));
    let(a, 2, WEFT_MODE_ANALYTIC, WEFT_MODE_COMPRESSED);
    assert_true(tells_errors(a));
    a->canvas.width = 300;
    assert_false(tells_errors(a));
    free(a);
}

/* One figure at a time: beside raw it is that of what is visible, when it is there. */
static void beside_raw_it_is_silent(void **state)
{
    (void)state;
    weft_application *a = with_nothing_to_say();
    a->canvas.width = WIDTH - LEFT;
    snprintf(a->held_out, sizeof a->held_out, "error on directions that were not fitted: compressed 20.2 %%");
    a->interaction.available[WEFT_MODE_RAW] = true;
    let(a, 2, WEFT_MODE_RAW, WEFT_MODE_COMPRESSED);
    assert_false(tells_errors(a));
    snprintf(a->errors, sizeof a->errors, "from raw: compressed 4.2 %%");
    double beside_raw = note_after(a, "errors", SETTLES).width;
    let(a, 1, WEFT_MODE_COMPRESSED, WEFT_MODE_RAW);
    double alone = note_after(a, "errors", SETTLES).width;
    assert_true(beside_raw > 0 && alone > 1.5 * beside_raw);
    free(a);
}

/* A label is twice as high as its letters, with what is above it. */
static void what_lies_beyond_hides_no_label(void **state)
{
    (void)state;
    weft_application *a = with_nothing_to_say();
    a->canvas.width = WIDTH - LEFT;
    a->canvas.height = HEIGHT;
    snprintf(a->unmeasured, sizeof a->unmeasured, "beyond the photographs: 14 %% of the lit cloth is seen");
    let(a, 1, WEFT_MODE_COMPRESSED, WEFT_MODE_RAW);
    note_after(a, "unmeasured", SETTLES);
    assert_true(ui_frames_top("unmeasured") < 20);
    let(a, 2, WEFT_MODE_RAW, WEFT_MODE_COMPRESSED);
    for (int layout = WEFT_LAYOUT_PANES; layout <= WEFT_LAYOUT_WIPE; layout++) {
        a->interaction.scene.layout = (weft_layout)layout;
        note_after(a, "unmeasured", SETTLES);
        assert_true(ui_frames_top("unmeasured") > 2 * weft_label_size(HEIGHT));
    }
    a->interaction.scene.labels = false;
    note_after(a, "unmeasured", SETTLES);
    assert_true(ui_frames_top("unmeasured") < 20);
    free(a);
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

int test_notes(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_read_has_room_to_the_end),
        cmocka_unit_test(a_note_in_place_of_a_shorter_one_is_whole),
        cmocka_unit_test(a_material_says_its_error_where_it_is_shown),
        cmocka_unit_test(beside_raw_it_is_silent),
        cmocka_unit_test(what_lies_beyond_hides_no_label),
    };
    return cmocka_run_group_tests(tests, open_frames, close_frames);
}

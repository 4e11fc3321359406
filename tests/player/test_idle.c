/* A window is shown again when something happens, and only then. */
#include "player/window/idle.h"
#include "tests/support/cmocka_all.h"

enum { TENTHS = 10 };

/* How many of the turns in so many seconds find the window at work: ten a second. */
static int turns_at_work(weft_idle *idle, weft_stir stir, double *now_s, double seconds)
{
    int count = 0;
    for (int i = 0; i < (int)(seconds * TENTHS); i++) {
        *now_s += 1.0 / TENTHS;
        count += !weft_idle_at(idle, &stir, *now_s);
        stir.has_events = false;
    }
    return count;
}

static void nothing_is_shown_where_nothing_happens(void **state)
{
    (void)state;
    weft_idle idle = {0};
    weft_stir quiet = {0};
    double now_s = 1000;
    assert_int_equal(turns_at_work(&idle, quiet, &now_s, 3600), 0);
}

static void what_happens_is_shown_until_a_late_hint_has_come(void **state)
{
    (void)state;
    weft_idle idle = {0};
    weft_stir moved = {.has_events = true}, quiet = {0};
    double now_s = 1000;
    assert_in_range(turns_at_work(&idle, moved, &now_s, 0.7), 7, 7);
    assert_in_range(turns_at_work(&idle, quiet, &now_s, 60), 1, 6);
}

static void a_window_at_work_is_shown_all_the_time(void **state)
{
    (void)state;
    weft_idle idle = {0};
    weft_stir busy = {.is_busy = true}, quiet = {0};
    double now_s = 1000;
    assert_int_equal(turns_at_work(&idle, busy, &now_s, 60), 600);
    assert_in_range(turns_at_work(&idle, quiet, &now_s, 60), 7, 12);
}

/* It comes, it goes eight seconds later, and another takes its place meanwhile. */
static void notes_come_and_go_by_themselves(void **state)
{
    (void)state;
    weft_idle idle = {0};
    double now_s = 1000;
    weft_stir first = {.note_ends_s = 1008}, second = {.note_ends_s = 1012};
    assert_in_range(turns_at_work(&idle, first, &now_s, 5), 7, 12);
    assert_false(weft_idle_at(&idle, &second, now_s += 0.1));
    assert_in_range(turns_at_work(&idle, second, &now_s, 5), 7, 12);
    assert_in_range(turns_at_work(&idle, second, &now_s, 60), 7, 12);
}

int test_idle(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_shown_where_nothing_happens),
        cmocka_unit_test(what_happens_is_shown_until_a_late_hint_has_come),
        cmocka_unit_test(a_window_at_work_is_shown_all_the_time),
        cmocka_unit_test(notes_come_and_go_by_themselves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* How many pixels a moving picture has: the policy, on machines that are made up. */
#include "player/draw/pace.h"
#include "tests/support/expect_ok.h"

#include <math.h>
#include <string.h>

/* Draws all pixels in `pixels_ms`, beside what it takes for any number of them and to show the picture. */
typedef struct machine {
    double pixels_ms, fixed_ms, shown_ms;
    double jitter;       /* of the time, as a share of it */
    unsigned long state; /* of what decides it */
} machine;

static double jitter_of(machine *m)
{
    m->state = (m->state * 1103515245 + 12345) % 2147483648;
    return 1 + m->jitter * (2 * (double)m->state / 2147483648 - 1);
}

static double drawn_ms(machine *m, double side)
{
    return jitter_of(m) * (m->fixed_ms + m->pixels_ms * side * side);
}

/* Returns how often the side changed. */
static int play(machine *m, weft_pace *pace, int frames)
{
    int changes = 0;
    for (int i = 0; i < frames; i++) {
        double side = weft_pace_side(pace);
        weft_pace_note(pace, weft_pace_is_interactive(pace), drawn_ms(m, side), m->shown_ms);
        changes += weft_pace_side(pace) != side;
    }
    return changes;
}

static void a_fast_machine_draws_every_pixel_exactly(void **state)
{
    (void)state;
    weft_pace pace = {0};
    assert_int_equal(play(&(machine){.pixels_ms = 12, .shown_ms = 2}, &pace, 100), 0);
    assert_false(weft_pace_is_interactive(&pace));
    assert_true(weft_pace_side(&pace) == 1);
}

static void a_machine_whose_interactive_frames_are_in_time_draws_every_pixel(void **state)
{
    (void)state;
    weft_pace pace = {0};
    assert_int_equal(play(&(machine){.pixels_ms = 25, .shown_ms = 5}, &pace, 100), 0);
    assert_true(weft_pace_is_interactive(&pace));
    assert_true(weft_pace_side(&pace) == 1);
}

static void a_slow_machine_keeps_the_promise_after_a_few_frames_and_does_not_pump(void **state)
{
    (void)state;
    for (double whole_ms = 20; whole_ms < 300; whole_ms *= 1.03) {
        machine m = {
            .pixels_ms = 0.9 * whole_ms, .fixed_ms = 0.1 * whole_ms, .shown_ms = 4, .jitter = 0.06, .state = 7};
        weft_pace pace = {0};
        assert_true(play(&m, &pace, 24) <= 4);
        assert_true(play(&m, &pace, 500) <= 1);
        m.jitter = 0;
        double side = weft_pace_side(&pace), frame_ms = drawn_ms(&m, side) + m.shown_ms;
        if (side > 0.25 && frame_ms > 1.07 * WEFT_PACE_MS)
            fail_msg("a machine of %g ms draws frames of %g ms", whole_ms, frame_ms);
        /* No smaller than it has to be: by far the next larger one would be too large. */
        double larger = fmin(1, 1.6 * side);
        if (side < 1 && drawn_ms(&m, larger) + m.shown_ms < 0.85 * WEFT_PACE_MS)
            fail_msg("a machine of %g ms draws a side of %g", whole_ms, side);
    }
}

static void one_hiccup_changes_nothing_and_two_slow_frames_do(void **state)
{
    (void)state;
    machine m = {.pixels_ms = 25};
    weft_pace pace = {0};
    play(&m, &pace, 20);
    weft_pace_note(&pace, true, 900, 5);
    assert_true(weft_pace_side(&pace) == 1);
    assert_int_equal(play(&m, &pace, 50), 0);
    weft_pace_note(&pace, true, 900, 5);
    /* As small as the faster of the two asks for. */
    weft_pace_note(&pace, true, 45, 0);
    assert_float_equal(weft_pace_side(&pace), 5.0 / 6, 1e-12);
}

static void one_hiccup_of_an_exact_frame_changes_nothing(void **state)
{
    (void)state;
    weft_pace pace = {0};
    play(&(machine){.pixels_ms = 5}, &pace, 20);
    weft_pace_note(&pace, false, 900, 5);
    assert_false(weft_pace_is_interactive(&pace));
    play(&(machine){.pixels_ms = 5}, &pace, 1);
    assert_false(weft_pace_is_interactive(&pace));
    /* What goes on does. */
    play(&(machine){.pixels_ms = 60}, &pace, 3);
    assert_true(weft_pace_is_interactive(&pace));
}

static void what_became_faster_gets_its_pixels_back(void **state)
{
    (void)state;
    machine slow = {.pixels_ms = 400}, fast = {.pixels_ms = 20};
    weft_pace pace = {0};
    play(&slow, &pace, 30);
    assert_true(weft_pace_side(&pace) <= 0.5);
    play(&fast, &pace, 60);
    assert_true(weft_pace_side(&pace) == 1);
}

static void a_panel_that_takes_long_leaves_less_for_the_picture(void **state)
{
    (void)state;
    weft_pace without = {0}, with = {0}, only = {0};
    play(&(machine){.pixels_ms = 32}, &without, 50);
    play(&(machine){.pixels_ms = 32, .shown_ms = 20}, &with, 50);
    play(&(machine){.pixels_ms = 16, .shown_ms = 1000}, &only, 50);
    assert_true(weft_pace_side(&without) == 1);
    assert_true(weft_pace_side(&with) < 0.7);
    /* Where it alone takes longer, a smaller picture would win nothing. */
    assert_true(weft_pace_side(&only) >= 0.5);
}

static void frames_at_rest_are_whole_and_say_nothing_of_moving_ones(void **state)
{
    (void)state;
    weft_pace pace = {0};
    play(&(machine){.pixels_ms = 100}, &pace, 20);
    double side = weft_pace_side(&pace);
    assert_true(side < 1);
    for (int i = 0; i < 64; i++)
        weft_pace_note(&pace, false, 500, 4);
    assert_true(weft_pace_side(&pace) == side);
    for (int i = 0; i < 64; i++)
        weft_pace_note(&pace, false, 3, 4);
    assert_true(weft_pace_side(&pace) == 1);
}

static void absurd_times_do_no_harm(void **state)
{
    (void)state;
    const double absurd[] = {NAN, INFINITY, -INFINITY, -1};
    weft_pace pace = {0};
    play(&(machine){.pixels_ms = 60}, &pace, 20);
    const weft_pace before = pace;
    for (size_t i = 0; i < sizeof absurd / sizeof *absurd; i++) {
        for (int interactive = 0; interactive < 2; interactive++) {
            weft_pace_note(&pace, interactive, absurd[i], 1);
            weft_pace_note(&pace, interactive, 1, absurd[i]);
        }
    }
    assert_memory_equal(&pace, &before, sizeof pace);
    for (int i = 0; i < 100; i++)
        weft_pace_note(&pace, true, 0, 0);
    assert_true(weft_pace_side(&pace) == 1);
    for (int i = 0; i < 100; i++)
        weft_pace_note(&pace, true, 1e300, 1e300);
    assert_float_equal(weft_pace_side(&pace), 0.25, 1e-12);
}

int test_pace(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fast_machine_draws_every_pixel_exactly),
        cmocka_unit_test(a_machine_whose_interactive_frames_are_in_time_draws_every_pixel),
        cmocka_unit_test(a_slow_machine_keeps_the_promise_after_a_few_frames_and_does_not_pump),
        cmocka_unit_test(one_hiccup_changes_nothing_and_two_slow_frames_do),
        cmocka_unit_test(one_hiccup_of_an_exact_frame_changes_nothing),
        cmocka_unit_test(what_became_faster_gets_its_pixels_back),
        cmocka_unit_test(a_panel_that_takes_long_leaves_less_for_the_picture),
        cmocka_unit_test(frames_at_rest_are_whole_and_say_nothing_of_moving_ones),
        cmocka_unit_test(absurd_times_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

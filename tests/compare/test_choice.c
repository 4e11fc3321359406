/* Which models of a price list are chosen, and how the page shows them. */
#include "tests/compare/fixture.h"

#include "base/atomic_file.h"
#include "compare/tradeoff/tradeoff.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Choices ---- */

static const weft_offer offers[] = {
    {1000, 0.40, true}, {2000, 0.20, true},   {2100, 0.39, true}, {4000, 0.05, true}, {8000, 0.045, true},
    {9000, 0.04, true}, {3000, 0.001, false}, {500, 0.5, false},  {2000, 0.20, true},
};
enum { OFFERS = sizeof offers / sizeof *offers };

static void offers_are_beaten_by_what_can_be_had(void **state)
{
    (void)state;
    const bool beaten[OFFERS] = {false, false, true, false, false, false, false, false, true};
    for (size_t i = 0; i < OFFERS; i++)
        assert_int_equal(weft_offer_is_beaten(offers, OFFERS, i), beaten[i]);
}

/* Errors of at most sqrt(0.04 x 0.40) = 0.126 are small enough: 4000 bytes are the fewest of these. */
static void presets_choose_by_their_rules(void **state)
{
    (void)state;
    assert_int_equal(weft_preset_choose(offers, OFFERS, WEFT_PRESET_BEST), 5);
    assert_int_equal(weft_preset_choose(offers, OFFERS, WEFT_PRESET_SMALL), 3);
    assert_int_equal(weft_preset_choose(offers, OFFERS, WEFT_PRESET_BALANCED), 3);
}

/* Between 100 bytes of error 0.2 and 10000 of 0.02 a straight line has 0.0632 at 1000. */
static void balanced_is_the_bend(void **state)
{
    (void)state;
    weft_offer curve[] = {
        {10, 1, true}, {100, 0.1, true}, {1000, 0.04, true}, {3000, 0.0325, true}, {10000, 0.01, true}};
    assert_int_equal(weft_preset_choose(curve, 5, WEFT_PRESET_SMALL), 1);
    assert_int_equal(weft_preset_choose(curve, 5, WEFT_PRESET_BALANCED), 1);
    curve[2].error = 0.028;
    assert_int_equal(weft_preset_choose(curve, 5, WEFT_PRESET_BALANCED), 2);
    curve[3].error = 0.0125;
    assert_int_equal(weft_preset_choose(curve, 5, WEFT_PRESET_BALANCED), 3);
    curve[2].may_be_chosen = curve[3].may_be_chosen = false;
    assert_int_equal(weft_preset_choose(curve, 5, WEFT_PRESET_BALANCED), 1);
}

/* A file ten times as large for half a hundredth less error is not better. */
static void a_hundredth_is_not_worth_any_bytes(void **state)
{
    (void)state;
    weft_offer near[] = {{100, 0.3, true}, {1000, 0.1005, true}, {10000, 0.1, true}};
    assert_int_equal(weft_preset_choose(near, 3, WEFT_PRESET_BEST), 1);
    near[1].error = 0.102;
    assert_int_equal(weft_preset_choose(near, 3, WEFT_PRESET_BEST), 2);
    near[0].error = 0.1002;
    for (weft_preset preset = WEFT_PRESET_SMALL; preset < WEFT_PRESET_COUNT; preset++)
        assert_int_equal(weft_preset_choose(near, 3, preset), 0);
}

static void nothing_is_chosen_of_nothing(void **state)
{
    (void)state;
    const weft_offer none[] = {{1, 1, false}};
    for (weft_preset preset = WEFT_PRESET_SMALL; preset <= WEFT_PRESET_BEST; preset++)
        assert_int_equal(weft_preset_choose(none, 1, preset), 1);
}

/* ---- Frames ---- */

/* Nobody knows the time of what is not asked for. */
typedef struct times {
    const double *frame_ms;
    int asked;
} times;

static weft_code tell_time(void *context, size_t which, double *frame_ms, weft_error *error)
{
    (void)error;
    times *t = context;
    t->asked++;
    *frame_ms = t->frame_ms[which];
    return WEFT_OK;
}

static void frames_that_are_too_slow_are_not_chosen(void **state)
{
    (void)state;
    const weft_offer all[] = {{1000, 0.5, true}, {2000, 0.3, true}, {4000, 0.2, true}, {8000, 0.1, true}};
    const double frame_ms[] = {12, 30, 20, 50};
    static const struct {
        double most_ms;
        size_t chosen, fastest;
        int asked;
    } row[] = {{50, 3, 4, 1}, {49, 2, 3, 2}, {19, 0, 2, 4}, {11, 4, 0, 4}, {INFINITY, 3, 4, 1}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        weft_offer offer[4];
        memcpy(offer, all, sizeof all);
        times t = {frame_ms, 0};
        size_t chosen, fastest;
        assert_int_equal(
            weft_preset_choose_fast(offer, 4, WEFT_PRESET_BEST, row[i].most_ms, tell_time, &t, &chosen, &fastest, NULL),
            WEFT_OK);
        assert_int_equal(chosen, row[i].chosen);
        assert_int_equal(fastest, row[i].fastest);
        assert_int_equal(t.asked, row[i].asked);
    }
}

/* ---- The page ---- */

static int count_of(const char *text, const char *word)
{
    int count = 0;
    for (const char *at = strstr(text, word); at; at = strstr(at + 1, word))
        count++;
    return count;
}

/* A model that all presets choose is named once, with why each does. */
static void page_names_a_chosen_model_once(void **state)
{
    (void)state;
    static weft_tradeoff tradeoff;
    char *page;
    size_t size;
    weft_error error = {0};
    tradeoff.row_count = 1;
    tradeoff.row[0] = (weft_tradeoff_row){.model = {.name = "8 components", .arguments = "--components 8"}};
    for (weft_preset preset = WEFT_PRESET_NONE; preset < WEFT_PRESET_COUNT; preset++)
        tradeoff.row[0].is_chosen[preset] = true;
    expect_ok(weft_tradeoff_write_page(&tradeoff, "one.btf.h5", "one-model", &error), &error);
    expect_ok(weft_read_file("one-model/index.html", 1 << 20, &page, &size, &error), &error);
    assert_int_equal(count_of(page, "<a href=\"#model-1\">8 components</a>"), 1);
    assert_int_equal(count_of(page, "<b>small</b>, <b>balanced</b>, <b>best</b>"), 1);
    for (weft_preset preset = WEFT_PRESET_SMALL; preset < WEFT_PRESET_COUNT; preset++)
        assert_int_equal(count_of(page, weft_preset_reason(preset)), 1);
    free(page);
}

int test_choice(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(offers_are_beaten_by_what_can_be_had),
        cmocka_unit_test(presets_choose_by_their_rules),
        cmocka_unit_test(balanced_is_the_bend),
        cmocka_unit_test(a_hundredth_is_not_worth_any_bytes),
        cmocka_unit_test(nothing_is_chosen_of_nothing),
        cmocka_unit_test(frames_that_are_too_slow_are_not_chosen),
        cmocka_unit_test(page_names_a_chosen_model_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

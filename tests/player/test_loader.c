/* Loading beside the thread that draws: order, errors, cancelling, closing at any moment. */
#include "player/settings/loader.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

typedef struct job {
    int pieces;        /* that it hands over */
    size_t bytes;      /* that each says it has */
    int fails_at;      /* piece that cannot be run; -1: none */
    weft_code read;    /* what reading gives in the end */
    atomic_bool *gate; /* waited for before the end of reading, or NULL */
    pthread_t thread;  /* that read it */
    int ran, shown, released, pieces_released;
} job;

typedef struct piece {
    job *job;
    int number;
} piece;

static weft_code run_piece(void *data, weft_error *error)
{
    const piece *p = data;
    assert_int_equal(p->number, p->job->ran);
    if (p->number == p->job->fails_at)
        return weft_fail(error, WEFT_SYSTEM, "piece %d", p->number);
    p->job->ran++;
    return WEFT_OK;
}

static void release_piece(void *data)
{
    piece *p = data;
    p->job->pieces_released++;
    free(p);
}

static weft_code read_job(void *data, weft_load *load, weft_error *error)
{
    job *j = data;
    weft_progress progress = weft_load_progress(load);
    j->thread = pthread_self();
    for (int k = 0; k < j->pieces; k++) {
        piece *p = malloc(sizeof *p);
        *p = (piece){j, k};
        weft_progress_report(&progress, "reading", k, j->pieces);
        WEFT_TRY(weft_load_post(load, (weft_load_piece){run_piece, release_piece, p, j->bytes}, error));
    }
    while (j->gate && !atomic_load(j->gate))
        usleep(1000);
    return j->read == WEFT_OK ? WEFT_OK : weft_fail(error, j->read, "bad file");
}

static weft_code show_job(void *data, weft_error *error)
{
    (void)error;
    job *j = data;
    assert_int_equal(j->ran, j->pieces);
    j->shown++;
    return WEFT_OK;
}

static void release_job(void *data)
{
    job *j = data;
    j->released++;
}

static const weft_load_steps steps = {read_job, show_job, release_job};

static int set_up(void **state)
{
    weft_error error;
    return weft_loader_create((weft_loader **)state, &error) == WEFT_OK ? 0 : -1;
}

static int tear_down(void **state)
{
    weft_loader_free(*state);
    return 0;
}

static void start(weft_loader *loader, int slot, job *j)
{
    weft_error error;
    assert_int_equal(weft_loader_start(loader, slot, &steps, j, &error), WEFT_OK);
}

static weft_code finish(weft_loader *loader, weft_error *error)
{
    bool some = true;
    while (some)
        WEFT_TRY(weft_loader_wait(loader, NULL, &some, error));
    return WEFT_OK;
}

static void a_load_is_read_elsewhere_and_shown_here(void **state)
{
    weft_error error;
    job j = {.pieces = 20, .bytes = 1, .fails_at = -1};
    assert_float_equal(weft_loader_progress(*state), -1, 0);
    start(*state, 0, &j);
    assert_true(weft_loader_progress(*state) >= 0);
    assert_int_equal(finish(*state, &error), WEFT_OK);
    assert_false(pthread_equal(j.thread, pthread_self()));
    assert_int_equal(j.shown, 1);
    assert_int_equal(j.released, 1);
    assert_int_equal(j.pieces_released, 20);
    assert_float_equal(weft_loader_progress(*state), -1, 0);
}

/* 64 MiB wait at most: the reader of these stops until some are taken. */
static void a_reader_waits_for_the_one_who_draws(void **state)
{
    weft_error error;
    job j = {.pieces = 50, .bytes = (size_t)40 << 20, .fails_at = -1};
    start(*state, 0, &j);
    usleep(50000);
    assert_true(weft_loader_progress(*state) < 0.1);
    assert_int_equal(finish(*state, &error), WEFT_OK);
    assert_int_equal(j.shown, 1);
}

static void loads_are_shown_in_their_order_each_as_soon_as_it_is_there(void **state)
{
    weft_error error;
    atomic_bool gate = false;
    bool some, shown = false;
    job first = {.fails_at = -1}, second = {.pieces = 3, .fails_at = -1, .gate = &gate};
    start(*state, 0, &first);
    start(*state, 1, &second);
    while (!shown)
        assert_int_equal(weft_loader_poll(*state, 0, &shown, &error), WEFT_OK);
    assert_int_equal(first.shown, 1);
    assert_int_equal(second.shown, 0);
    atomic_store(&gate, true);
    do
        assert_int_equal(weft_loader_wait(*state, NULL, &some, &error), WEFT_OK);
    while (some);
    assert_int_equal(second.shown, 1);
}

static void a_file_that_cannot_be_read_is_told_and_the_next_is_shown(void **state)
{
    weft_error error;
    job bad = {.pieces = 2, .fails_at = -1, .read = WEFT_BAD_INPUT}, good = {.pieces = 2, .fails_at = -1};
    start(*state, 0, &bad);
    start(*state, 1, &good);
    assert_int_equal(finish(*state, &error), WEFT_BAD_INPUT);
    assert_string_equal(error.message, "bad file");
    assert_int_equal(finish(*state, &error), WEFT_OK);
    assert_int_equal(bad.shown, 0);
    assert_int_equal(bad.released, 1);
    assert_int_equal(good.shown, 1);
}

static void a_piece_that_fails_ends_its_load(void **state)
{
    weft_error error;
    job j = {.pieces = 1000, .bytes = (size_t)16 << 20, .fails_at = 7};
    start(*state, 0, &j);
    assert_int_equal(finish(*state, &error), WEFT_SYSTEM);
    assert_string_equal(error.message, "piece 7");
    assert_int_equal(j.ran, 7);
    assert_int_equal(j.shown, 0);
    assert_int_equal(j.released, 1);
}

static void a_later_load_of_the_slot_cancels_the_earlier(void **state)
{
    weft_error error;
    job old = {.pieces = 1000000, .bytes = (size_t)16 << 20, .fails_at = -1}, other = {.fails_at = -1};
    job new = {.pieces = 3, .fails_at = -1};
    start(*state, 2, &old);
    start(*state, 1, &other);
    start(*state, 2, &new);
    assert_int_equal(finish(*state, &error), WEFT_OK);
    assert_int_equal(old.shown, 0);
    assert_int_equal(old.released, 1);
    assert_int_equal(other.shown, 1);
    assert_int_equal(new.shown, 1);
}

/* The window is closed while much is read, waits, and is queued. */
static void closing_releases_everything_once(void **state)
{
    (void)state;
    for (int pause_us = 0; pause_us < 3000; pause_us += 100) {
        weft_error error;
        weft_loader *loader = NULL;
        bool shown;
        job j[3] = {{.pieces = 1000000, .bytes = (size_t)1 << 20, .fails_at = -1},
                    {.pieces = 5, .fails_at = -1},
                    {.pieces = 5, .fails_at = -1}};
        assert_int_equal(weft_loader_create(&loader, &error), WEFT_OK);
        for (int i = 0; i < 3; i++)
            start(loader, i, &j[i]);
        usleep((unsigned)pause_us);
        weft_loader_poll(loader, 0.0005, &shown, &error);
        weft_loader_free(loader);
        for (int i = 0; i < 3; i++)
            assert_int_equal(j[i].released, 1);
        assert_true(j[0].pieces_released >= j[0].ran);
    }
}

static void polling_an_idle_loader_does_nothing(void **state)
{
    weft_error error;
    bool shown = true, some = true;
    assert_int_equal(weft_loader_poll(*state, 1, &shown, &error), WEFT_OK);
    assert_false(shown);
    assert_int_equal(weft_loader_wait(*state, NULL, &some, &error), WEFT_OK);
    assert_false(some);
}

int test_loader(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_load_is_read_elsewhere_and_shown_here, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_reader_waits_for_the_one_who_draws, set_up, tear_down),
        cmocka_unit_test_setup_teardown(loads_are_shown_in_their_order_each_as_soon_as_it_is_there, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_file_that_cannot_be_read_is_told_and_the_next_is_shown, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_piece_that_fails_ends_its_load, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_later_load_of_the_slot_cancels_the_earlier, set_up, tear_down),
        cmocka_unit_test(closing_releases_everything_once),
        cmocka_unit_test_setup_teardown(polling_an_idle_loader_does_nothing, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* weft compress on a dataset of several blocks: killed, short of memory, with a full disk, with several threads. The
 * bytes of the material must always be the same. */
#include "tests/support/cmocka_all.h"

#include "base/atomic_file.h"
#include "tests/support/disturbed_command.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/synthetic_texel.h"

#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { WIDTH = 34, HEIGHT = 18, BLOCKS = 6, KINDS = 6 };

static const char *const dataset_path = "large.btf.h5", *const whole_path = "large-whole.weft",
                         *const path = "large.weft", *const partial_path = "large.weft.partial";

/* ---- The dataset ---- */

/* A few texels, each brighter or darker than the next; some samples are masked. */
static void fill(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    static float *texel[KINDS];
    size_t count = 3 * (size_t)layout->image_count;
    int kind = (x / 3 + 2 * (y / 5)) % KINDS;
    if (!texel[kind]) {
        texel[kind] = calloc(count, sizeof *texel[kind]);
        assert_non_null(texel[kind]);
        synthetic_texel(layout, (synthetic_kind)(kind % SYNTHETIC_KINDS), 64 * (uint64_t)kind, 0.01, texel[kind]);
    }
    float gain = 0.5f + 0.02f * (float)x + 0.01f * (float)((7 * y) % 11);
    for (size_t i = 0; i < count; i++)
        samples[i] = gain * texel[kind][i];
    for (int image = (x + y) % 13; image < layout->image_count; image += 97)
        mask[image] = WEFT_MASK_SATURATED;
}

static void write_dataset(const char *to)
{
    weft_dataset_layout layout;
    assert_int_equal(synthetic_layout(WIDTH, HEIGHT, &layout, NULL), WEFT_OK);
    synthetic_dataset_write(to, &layout, fill);
    weft_dataset_layout_free(&layout);
}

/* ---- Running the command ---- */

typedef struct limits {
    off_t kill_at; /* bytes of the partial file at which it is killed; 0: never */
    rlim_t file;   /* largest file; 0: none */
} limits;

/* weft compress with up to four options. What it is not fitted to is measured only where they ask for it: it takes its
 * time. */
static disturbed compress_dataset(const char *from, const char *to, limits limit, const char *const option[4])
{
    const char *argument[] = {"weft",       "compress", from,      "-o",      to,        "--lobes", "1",
                              "--hold-out", "off",      option[0], option[1], option[2], option[3], NULL};
    return run_disturbed(argument,
                         (disturbance){.watched = partial_path, .kill_at = limit.kill_at, .largest_file = limit.file});
}

static const char *const no_option[4];
static const limits no_limit;

/* Ends with the bytes of the undisturbed run, and without a partial file. */
static void expect_done(const disturbed *got, const char *what)
{
    expect_says(got, 0, what);
    expect_same_bytes(path, whole_path);
    assert_int_equal(size_of(partial_path), -1);
    unlink(path);
}

static void copy_file(const char *from, const char *to, size_t most)
{
    char *bytes;
    size_t size;
    assert_int_equal(weft_read_file(from, SIZE_MAX / 2, &bytes, &size, NULL), WEFT_OK);
    assert_int_equal(weft_write_file(to, bytes, size < most ? size : most, NULL), WEFT_OK);
    free(bytes);
}

static int prepare(void **state)
{
    (void)state;
    write_dataset(dataset_path);
    unlink(partial_path);
    unlink("large-whole.weft.partial");
    disturbed got = compress_dataset(dataset_path, whole_path, no_limit, no_option);
    expect_says(&got, 0, "in 6 blocks");
    assert_int_equal(size_of("large-whole.weft.partial"), -1);
    return 0;
}

/* Leaves a partial file of which two thirds still hold a block as "large.kept", and removes the original. */
static void keep_some_blocks(void)
{
    disturbed got = compress_dataset(dataset_path, path, (limits){.kill_at = 700000}, no_option);
    assert_true(WIFSIGNALED(got.status));
    copy_file(partial_path, "large.kept", SIZE_MAX);
    unlink(partial_path);
}

/* ---- Tests ---- */

static void killed_again_and_again_it_ends_with_the_same_bytes(void **state)
{
    (void)state;
    unlink(path);
    disturbed got = compress_dataset(dataset_path, path, (limits){.kill_at = 1}, no_option);
    off_t kept = size_of(partial_path);
    assert_true(WIFSIGNALED(got.status) && kept > 0);
    int kills = 1;
    while (WIFSIGNALED(got.status)) {
        kept = size_of(partial_path);
        got = compress_dataset(dataset_path, path, (limits){.kill_at = kept + 1}, no_option);
        assert_true(!WIFSIGNALED(got.status) || size_of(path) == -1);
        if (WIFSIGNALED(got.status) && size_of(partial_path) > kept)
            kills++;
        /* Some kills leave half a record, which is written again. */
        assert_true(kills <= 3 * BLOCKS);
    }
    assert_true(kills > 3);
    expect_done(&got, "going on after");
}

static void other_weights_go_on_as_well(void **state)
{
    (void)state;
    const char *const option[][4] = {{"--weights", "screen"}};
    for (size_t i = 0; i < sizeof option / sizeof *option; i++) {
        disturbed got = compress_dataset(dataset_path, "large-chosen.weft", no_limit, option[i]);
        expect_says(&got, 0, "fitted in");
        got = compress_dataset(dataset_path, path, (limits){.kill_at = 700000}, option[i]);
        assert_true(WIFSIGNALED(got.status));
        got = compress_dataset(dataset_path, path, no_limit, option[i]);
        expect_says(&got, 0, "going on after");
        expect_same_bytes(path, "large-chosen.weft");
        unlink(path);
    }
}

static void a_checkpoint_cut_anywhere_goes_on(void **state)
{
    (void)state;
    keep_some_blocks();
    off_t size = size_of("large.kept");
    const off_t cut[] = {7, 100, size * 2 / 3, size - 1};
    for (size_t i = 0; i < sizeof cut / sizeof *cut; i++) {
        copy_file("large.kept", partial_path, (size_t)cut[i]);
        disturbed got = compress_dataset(dataset_path, path, no_limit, no_option);
        expect_not_said(&got, "discarded");
        expect_done(&got, i < 2 ? "in 6 blocks" : "going on after");
    }
}

static void a_damaged_checkpoint_is_discarded(void **state)
{
    (void)state;
    keep_some_blocks();
    off_t size = size_of("large.kept");
    const off_t place[] = {30, size / 2, size - 10};
    for (size_t i = 0; i < sizeof place / sizeof *place; i++) {
        copy_file("large.kept", partial_path, SIZE_MAX);
        int file = open(partial_path, O_RDWR);
        char byte;
        assert_int_equal(pread(file, &byte, 1, place[i]), 1);
        byte ^= 0x10;
        assert_int_equal(pwrite(file, &byte, 1, place[i]), 1);
        close(file);
        disturbed got = compress_dataset(dataset_path, path, no_limit, no_option);
        if (place[i] == size - 10 && strstr(got.said, "going on after")) {
            /* The last record had been cut by the kill: it is dropped, damaged or not. */
            expect_done(&got, "going on after");
            continue;
        }
        expect_done(&got, "large.weft.partial is discarded: it is damaged");
    }
}

static void a_checkpoint_of_other_options_or_another_dataset_is_discarded(void **state)
{
    (void)state;
    keep_some_blocks();
    copy_file("large.kept", partial_path, SIZE_MAX);
    disturbed got = compress_dataset(dataset_path, path, no_limit, (const char *const[4]){"--weights", "screen"});
    expect_says(&got, 0, "is discarded: it was made with other options");
    copy_file(dataset_path, "other.btf.h5", SIZE_MAX);
    copy_file("large.kept", partial_path, SIZE_MAX);
    got = compress_dataset("other.btf.h5", path, no_limit, no_option);
    expect_done(&got, "is discarded: it was made from another dataset");
    unlink("other.btf.h5");
}

static void what_is_no_checkpoint_is_left_alone(void **state)
{
    (void)state;
    assert_int_equal(weft_write_file(partial_path, "a letter", 8, NULL), WEFT_OK);
    disturbed got = compress_dataset(dataset_path, path, no_limit, no_option);
    expect_says(&got, 2, "'large.weft.partial' is in the way");
    assert_int_equal(size_of(partial_path), 8);
    unlink(partial_path);
    assert_int_equal(mkdir(partial_path, 0755), 0);
    got = compress_dataset(dataset_path, path, no_limit, no_option);
    expect_says(&got, 3, "large.weft.partial");
    rmdir(partial_path);
}

static void a_full_disk_keeps_what_is_done(void **state)
{
    (void)state;
    disturbed got = compress_dataset(dataset_path, path, (limits){.file = 500000}, no_option);
    expect_says(&got, 3, "cannot append to 'large.weft.partial'");
    assert_int_equal(size_of(path), -1);
    assert_true(size_of(partial_path) > 150000);
    got = compress_dataset(dataset_path, path, no_limit, no_option);
    expect_done(&got, "going on after");
}

static void two_at_a_time_to_one_output_are_refused(void **state)
{
    (void)state;
    int file = open(partial_path, O_RDWR | O_CREAT, 0644);
    assert_int_equal(flock(file, LOCK_EX), 0);
    disturbed got = compress_dataset(dataset_path, path, no_limit, no_option);
    expect_says(&got, 3, "in use by another");
    close(file);
    unlink(partial_path);
}

static void threads_change_no_byte(void **state)
{
    (void)state;
    const char *const count[] = {"1", "2", "3"};
    for (int i = 0; i < 3; i++) {
        disturbed got = compress_dataset(dataset_path, path, no_limit, (const char *const[4]){"--threads", count[i]});
        expect_done(&got, "fitted in");
    }
}

/* How much of the libraries is resident differs from run to run: by 4 MB beside other work. */
enum { RESIDENT_NOISE_MB = 8 };

static void little_memory_changes_no_byte_and_is_not_exceeded(void **state)
{
    (void)state;
#if defined(__SANITIZE_ADDRESS__)
    skip(); /* its allocator keeps what is freed */
#endif
    disturbed got = compress_dataset(dataset_path, path, no_limit, (const char *const[4]){"--memory", "1", "-t", "2"});
    expect_says(&got, 2, "more than the limit of 1 MB");
    const char *needs = strstr(got.said, " needs ");
    assert_non_null(needs);
    long least = strtol(needs + strlen(" needs "), NULL, 10);
    assert_in_range(least, 20, 400);
    const long more[] = {RESIDENT_NOISE_MB, 16};
    for (int i = 0; i < 2; i++) {
        char limit[32];
        snprintf(limit, sizeof limit, "%ld", least + more[i]);
        got = compress_dataset(dataset_path, path, no_limit, (const char *const[4]){"--memory", limit, "-t", "2"});
        if (got.peak_kb * 1024 > (least + more[i]) * 1000000)
            fail_msg("%ld kB of memory, allowed were %s MB", got.peak_kb, limit);
        expect_done(&got, "fitted in");
        got = compress_dataset(dataset_path, path, no_limit,
                               (const char *const[4]){"--memory", limit, "--hold-out", "1"});
        if (got.peak_kb * 1024 > (least + more[i]) * 1000000)
            fail_msg("%ld kB of memory with images held out, allowed were %s MB", got.peak_kb, limit);
        expect_says(&got, 0, "not fitted");
    }
}

int test_compress_large(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(killed_again_and_again_it_ends_with_the_same_bytes),
        cmocka_unit_test(other_weights_go_on_as_well),
        cmocka_unit_test(a_checkpoint_cut_anywhere_goes_on),
        cmocka_unit_test(a_damaged_checkpoint_is_discarded),
        cmocka_unit_test(a_checkpoint_of_other_options_or_another_dataset_is_discarded),
        cmocka_unit_test(what_is_no_checkpoint_is_left_alone),
        cmocka_unit_test(a_full_disk_keeps_what_is_done),
        cmocka_unit_test(two_at_a_time_to_one_output_are_refused),
        cmocka_unit_test(threads_change_no_byte),
        cmocka_unit_test(little_memory_changes_no_byte_and_is_not_exceeded),
    };
    return cmocka_run_group_tests(tests, prepare, NULL);
}

/* weft compress --components on a dataset of several blocks: killed at any moment, with a full disk, with what an
 * earlier run left. The bytes of the material must always be the same, and nothing else may stay. */
#include "tests/support/cmocka_all.h"

#include "tests/support/disturbed_command.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_dataset.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Six blocks, the last ones cut. Few images, so that there is little to learn. The checkpoint has some 500 kB. */
enum { WIDTH = 144, HEIGHT = 72, VIEWS = 6, LIGHTS = 16, BLOCKS = 6, HOLE = 20, STEP = 60000 };

static const char *const dataset_path = "cloth.btf.h5", *const whole_path = "whole.weft", *const path = "cloth.weft",
                         *const partial_path = "cloth.weft.partial", *const left_over_path = ".cloth.4711.weft";

static const disturbance undisturbed;

/* ---- The dataset ---- */

/* No two blocks are alike: some texels are holes, and other samples are masked in each column. */
static uint8_t cloth(const weft_dataset_layout *layout, int image, int x, int y, float rgb[3])
{
    uint8_t mask = tiny_smooth(layout, image, x, y, rgb);
    rgb[x % 3] *= 1 + 0.3f * (float)((7 * y + x) % 5);
    bool is_masked = (x < HOLE && y < HOLE) || (image + x * x) % 13 == 0;
    return is_masked ? WEFT_MASK_SATURATED : mask;
}

static int files_at_first;

static disturbed compress_cloth(const char *to, const char *components, disturbance how)
{
    const char *argument[] = {"weft",         "compress", dataset_path, "-o",  to,
                              "--components", components, "--hold-out", "off", NULL};
    how.watched = partial_path;
    return run_disturbed(argument, how);
}

static int prepare(void **state)
{
    weft_error error = {0};
    scratch_folder_enter(state);
    weft_dataset_layout layout = tiny_layout(WIDTH, HEIGHT, VIEWS, LIGHTS);
    expect_ok(tiny_dataset_write(dataset_path, &layout, cloth, &error), &error);
    weft_dataset_layout_free(&layout);
    disturbed got = compress_cloth(whole_path, "8", undisturbed);
    expect_says(&got, 0, "in 6 blocks");
    files_at_first = scratch_folder_entries();
    return 0;
}

/* Ends with the bytes of the undisturbed run, and leaves no other file. */
static void expect_done(const disturbed *got, const char *what)
{
    expect_says(got, 0, what);
    expect_same_bytes(path, whole_path);
    unlink(path);
    assert_int_equal(scratch_folder_entries(), files_at_first);
}

/* Blocks of components that it went on after; 0: it says nothing of them. */
static int blocks_gone_on_after(const disturbed *got)
{
    const char *at = strstr(got->said, " of 6 blocks of components");
    return at ? at[-1] - '0' : 0;
}

/* ---- Tests ---- */

static void killed_again_and_again_it_ends_with_the_same_bytes(void **state)
{
    (void)state;
    disturbed got;
    int kills = -1;
    do {
        off_t kept = size_of(partial_path);
        got = compress_cloth(path, "8", (disturbance){.kill_at = kept + STEP});
        assert_true(!WIFSIGNALED(got.status) || size_of(path) == -1);
        assert_true(++kills <= 10 * BLOCKS);
    } while (WIFSIGNALED(got.status));
    assert_true(kills > 1);
    expect_done(&got, "going on after");
}

/* Unlike a kill it comes at the very byte: after some of the components, and after some more. */
static void a_full_disk_keeps_what_is_done(void **state)
{
    (void)state;
    const rlim_t room[] = {250000, 430000};
    for (int i = 0; i < 2; i++) {
        disturbed got = compress_cloth(path, "8", (disturbance){.largest_file = room[i]});
        expect_says(&got, 3, "cannot append to 'cloth.weft.partial'");
        assert_int_equal(size_of(path), -1);
    }
    disturbed got = compress_cloth(path, "8", undisturbed);
    assert_in_range(blocks_gone_on_after(&got), 2, BLOCKS - 1);
    expect_done(&got, " of 6 blocks of components, kept in cloth.weft.partial");
}

static void other_components_start_anew(void **state)
{
    (void)state;
    disturbed got = compress_cloth(path, "12", (disturbance){.kill_at = 1 << 18});
    assert_true(WIFSIGNALED(got.status));
    got = compress_cloth(path, "8", undisturbed);
    expect_not_said(&got, "going on after");
    expect_done(&got, "is discarded: it was made with other options");
}

/* The file that a run was writing when it was killed. */
static void what_a_killed_run_was_writing_is_removed(void **state)
{
    (void)state;
    scratch_store(left_over_path, "half of it", 10);
    disturbed got = compress_cloth(path, "8", undisturbed);
    expect_done(&got, "in 6 blocks");
}

int test_compress_components_large(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(killed_again_and_again_it_ends_with_the_same_bytes),
        cmocka_unit_test(a_full_disk_keeps_what_is_done),
        cmocka_unit_test(other_components_start_anew),
        cmocka_unit_test(what_a_killed_run_was_writing_is_removed),
    };
    return cmocka_run_group_tests(tests, prepare, scratch_folder_leave);
}

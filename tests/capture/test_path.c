/* The order of poses, against all orders where they are few and against its own bound where they are many. */
#include "capture/axes/path.h"
#include "capture/laboratory/rig_file.h"
#include "tests/capture/tree_bound.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>
#include <string.h>

static uint64_t random_state = 7;

static double random_to(double limit)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random_state >> 33) / 2147483648.0 * limit;
}

static double time_of(const weft_axes *axes, const weft_axis_positions *pose, const int *number, int count)
{
    double seconds = 0;
    for (int i = 1; i < count; i++)
        seconds += weft_axes_move_s(axes, &pose[number[i - 1]], &pose[number[i]]);
    return seconds;
}

/* The soonest of all orders. */
static double soonest(const weft_axes *axes, const weft_axis_positions *pose, int *number, int done, int count,
                      double spent)
{
    double best = done == count ? spent : INFINITY;
    for (int i = done; i < count; i++) {
        int place = number[i];
        number[i] = number[done];
        number[done] = place;
        double more = done ? weft_axes_move_s(axes, &pose[number[done - 1]], &pose[place]) : 0;
        best = fmin(best, soonest(axes, pose, number, done + 1, count, spent + more));
        number[done] = number[i];
        number[i] = place;
    }
    return best;
}

static weft_axes random_axes(void)
{
    weft_axes axes = {.count = 2, .together = random_to(2) < 1};
    for (int k = 0; k < 2; k++)
        axes.axis[k] = (weft_axis){.moves = WEFT_BODY_LIGHT,
                                   .angle = k ? WEFT_TURN_PHI : WEFT_TURN_THETA,
                                   .high_deg = 100,
                                   .speed_deg_s = 5 + random_to(20),
                                   .acceleration_deg_s2 = 5 + random_to(20),
                                   .settle_s = random_to(0.5),
                                   .backlash_deg = random_to(2),
                                   .approach_down = random_to(2) < 1};
    return axes;
}

/* Every bound holds for the best of all orders, and the order found is nearly that. */
static void few_poses_are_ordered_nearly_as_well_as_can_be(void **state)
{
    (void)state;
    enum { COUNT = 7, CASES = 60 };
    double sum = 0;
    for (int i = 0; i < CASES; i++) {
        weft_axes axes = random_axes();
        weft_axis_positions pose[COUNT] = {0};
        int number[COUNT], found[COUNT];
        weft_axes_path path;
        for (int p = 0; p < COUNT; p++) {
            pose[p].deg[0] = random_to(100);
            pose[p].deg[1] = random_to(100);
            number[p] = found[p] = p;
        }
        double best = soonest(&axes, pose, number, 0, COUNT, 0);
        assert_int_equal(weft_axes_order(&axes, pose, COUNT, found, &path, NULL), WEFT_OK);
        assert_float_equal(path.seconds, time_of(&axes, pose, found, COUNT), 1e-9);
        assert_true(tree_bound(&axes, pose, COUNT) <= best + 1e-9);
        assert_true(path.seconds >= best - 1e-9);
        sum += path.seconds / best;
    }
    assert_true(sum / CASES < 1.05);
}

static void a_viewpoint_is_visited_once(void **state)
{
    (void)state;
    enum { COUNT = 40 };
    weft_axes axes = random_axes();
    axes.axis[0].moves = WEFT_BODY_CAMERA;
    weft_axis_positions pose[COUNT] = {0};
    int number[COUNT];
    weft_axes_path path;
    for (int p = 0; p < COUNT; p++) {
        pose[p].deg[0] = 10 * (p * 7 % 5);
        pose[p].deg[1] = random_to(100);
        number[p] = p;
    }
    assert_int_equal(weft_axes_order(&axes, pose, COUNT, number, &path, NULL), WEFT_OK);
    int changes = 0, seen[COUNT] = {0};
    for (int i = 0; i < COUNT; i++) {
        assert_int_equal(seen[number[i]]++, 0);
        changes += i > 0 && pose[number[i]].deg[0] != pose[number[i - 1]].deg[0];
    }
    assert_int_equal(changes, 4);
    /* Where a person sets the light, that is what changes least. */
    axes.axis[1].by_hand = true;
    for (int p = 0; p < COUNT; p++)
        pose[p].deg[1] = 20 * (p % 4);
    assert_int_equal(weft_axes_order(&axes, pose, COUNT, number, &path, NULL), WEFT_OK);
    changes = 0;
    for (int i = 1; i < COUNT; i++)
        changes += pose[number[i]].deg[1] != pose[number[i - 1]].deg[1];
    assert_int_equal(changes, 3);
}

/* The shipped goniometer with all pairs of ubo81: whose time `weft capture --dry-run` says. */
static void the_goniometer_is_within_five_percent_of_the_bound(void **state)
{
    (void)state;
    enum { COUNT = 81 * 81 };
    weft_rig_file rig;
    weft_error error = {0};
    weft_axis_positions *pose = calloc(COUNT, sizeof *pose);
    int *number = malloc(COUNT * sizeof *number);
    assert_true(pose && number);
    if (weft_rig_file_read(WEFT_ASSETS "/rigs/goniometer.conf", &rig, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    for (int i = 0; i < COUNT; i++) {
        number[i] = i;
        assert_int_equal(
            weft_axes_solve(&rig.axes, weft_ubo81_angles(i / 81), weft_ubo81_angles(i % 81), &pose[i], NULL), WEFT_OK);
    }
    double planned = time_of(&rig.axes, pose, number, COUNT);
    weft_axes_path path;
    assert_int_equal(weft_axes_order(&rig.axes, pose, COUNT, number, &path, NULL), WEFT_OK);
    double bound = tree_bound(&rig.axes, pose, COUNT);
    print_message("as planned %.0f s, ordered %.0f s, bound %.0f s: %.2f %% above\n", planned, path.seconds, bound,
                  100 * (path.seconds / bound - 1));
    assert_true(bound > 0 && path.seconds <= 1.05 * bound);
    assert_float_equal(path.seconds, time_of(&rig.axes, pose, number, COUNT), 1e-6);
    assert_int_equal(path.moves, COUNT - 1);
    free(pose);
    free(number);
}

int test_path(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_poses_are_ordered_nearly_as_well_as_can_be),
        cmocka_unit_test(a_viewpoint_is_visited_once),
        cmocka_unit_test(the_goniometer_is_within_five_percent_of_the_bound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

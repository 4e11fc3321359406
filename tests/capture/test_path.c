/* The order of poses, against all orders where they are few and against a bound where they are many. */
#include "capture/axes/path.h"
#include "capture/laboratory/rig_file.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- How soon no order can be through: the least spanning tree (Prim 1957) ---- */

typedef struct tree {
    const weft_axes *axes;
    const weft_axis_positions *pose;
    int count;
    double slope[WEFT_AXES_MAX]; /* of the potential, seconds a degree */
    double *least;               /* [count] cost of the cheapest edge to the tree; -1: in it */
    int *toward;                 /* [count] where that edge leads */
} tree;

static const weft_axis_positions *pose_of(const tree *t, int i)
{
    return &t->pose[i];
}

static double potential_step(const tree *t, const weft_axis_positions *a, const weft_axis_positions *b)
{
    double step = 0;
    for (int k = 0; k < t->axes->count; k++)
        step += t->slope[k] * (b->deg[k] - a->deg[k]);
    return step;
}

static double edge(const tree *t, int i, int j)
{
    const weft_axis_positions *a = pose_of(t, i), *b = pose_of(t, j);
    double step = potential_step(t, a, b);
    return fmin(weft_axes_move_s(t->axes, a, b) + step, weft_axes_move_s(t->axes, b, a) - step);
}

/* Takes pose `added` into the tree; returns the one that is now the cheapest to add. */
static int take_in(tree *t, int added)
{
    int next = -1;
    t->least[added] = -INFINITY;
    for (int i = 0; i < t->count; i++) {
        if (t->least[i] == -INFINITY)
            continue;
        double cost = edge(t, added, i);
        if (cost < t->least[i]) {
            t->least[i] = cost;
            t->toward[i] = added;
        }
        if (next < 0 || t->least[i] < t->least[next])
            next = i;
    }
    return next;
}

/* Edges in which only one axis turns, and how far in all. */
typedef struct steps {
    double sum_deg[WEFT_AXES_MAX];
    int count[WEFT_AXES_MAX];
} steps;

static void note_step(const tree *t, int i, steps *s)
{
    int only = -1;
    for (int k = 0; k < t->axes->count; k++) {
        if (fabs(pose_of(t, i)->deg[k] - pose_of(t, t->toward[i])->deg[k]) > 1e-9)
            only = only == -1 ? k : -2;
    }
    if (only < 0)
        return;
    s->sum_deg[only] += fabs(pose_of(t, i)->deg[only] - pose_of(t, t->toward[i])->deg[only]);
    s->count[only]++;
}

static double grow(tree *t, steps *s)
{
    double total = 0;
    *s = (steps){0};
    for (int i = 0; i < t->count; i++)
        t->least[i] = INFINITY;
    for (int next = take_in(t, 0); next >= 0; next = take_in(t, next)) {
        total += t->least[next];
        note_step(t, next, s);
    }
    return total;
}

/* The slopes that make the mean step of each axis cost the same both ways. */
static void choose_slopes(tree *t, const steps *s)
{
    for (int k = 0; k < t->axes->count; k++) {
        const weft_axis *axis = &t->axes->axis[k];
        double step = s->count[k] > 0 ? s->sum_deg[k] / s->count[k] : 0;
        if (step < axis->backlash_deg || axis->backlash_deg == 0)
            continue;
        double extra = weft_axis_leg_s(axis, step + axis->backlash_deg) + weft_axis_leg_s(axis, axis->backlash_deg) -
                       weft_axis_leg_s(axis, step);
        t->slope[k] = (axis->approach_down ? -1 : 1) * extra / (2 * step);
    }
}

static double range_of_potential(const tree *t)
{
    const weft_axis_positions zero = {0};
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < t->count; i++) {
        double value = potential_step(t, &zero, pose_of(t, i));
        low = fmin(low, value);
        high = fmax(high, value);
    }
    return high - low;
}

/* Of pose[0 .. count - 1]. Asserts.
 *
 * * A path through n poses is a spanning tree of them, and no tree costs less than the least. A move against
 * backlash costs more than its way back, so each pair of poses is counted as min(c(a, b) + d, c(b, a) - d) with
 * d = p(b) - p(a) of a potential p linear in the positions. Along a path p(b) - p(a) sums to at most the range R of p,
 * so that a path costs at least the least tree less R, whatever p is; p = 0 and the p that evens out both ways of the
 * usual step of each axis are tried, and the better bound counts. */
static double tree_bound(const weft_axes *axes, const weft_axis_positions *pose, int count)
{
    tree t = {.axes = axes, .pose = pose, .count = count};
    steps s;
    t.least = malloc((size_t)count * sizeof *t.least);
    t.toward = calloc((size_t)count, sizeof *t.toward);
    assert_true(t.least && t.toward);
    double even = grow(&t, &s);
    choose_slopes(&t, &s);
    double sloped = grow(&t, &s) - range_of_potential(&t);
    free(t.least);
    free(t.toward);
    return fmax(even, sloped);
}

/* ---- Tests ---- */

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

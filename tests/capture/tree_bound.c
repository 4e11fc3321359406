#include "tests/capture/tree_bound.h"

#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdlib.h>

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

double tree_bound(const weft_axes *axes, const weft_axis_positions *pose, int count)
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

#include "capture/axes/path.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Costs, with a row for the beginning, which is place `count`: the tour starts there and never comes back. */
typedef struct tour {
    int count;
    float *cost;                /* [count + 1][count] */
    int *at;                    /* [count + 1]: the beginning, then the places */
    double *forward, *backward; /* [count + 1] costs of the tour up to a place, both ways */
    int *spare;                 /* [count] */
} tour;

/* What is saved must be worth the name. */
static const double least_gain = 1e-6;

static double cost(const tour *t, int from, int to)
{
    return to < t->count ? t->cost[(size_t)from * (size_t)t->count + (size_t)to] : INFINITY;
}

/* The cost of leaving position i for a place; nothing follows the last position. */
static double onward(const tour *t, int place, int next_position)
{
    return next_position <= t->count ? cost(t, place, t->at[next_position]) : 0;
}

static void go_to_nearest(tour *t)
{
    for (int i = 1; i <= t->count; i++) {
        int best = i;
        for (int j = i + 1; j <= t->count; j++) {
            if (cost(t, t->at[i - 1], t->at[j]) < cost(t, t->at[i - 1], t->at[best]))
                best = j;
        }
        int place = t->at[best];
        memmove(t->at + i + 1, t->at + i, (size_t)(best - i) * sizeof *t->at);
        t->at[i] = place;
    }
}

static void sum_up(tour *t)
{
    t->forward[0] = t->forward[1] = t->backward[0] = t->backward[1] = 0;
    for (int i = 2; i <= t->count; i++) {
        t->forward[i] = t->forward[i - 1] + cost(t, t->at[i - 1], t->at[i]);
        t->backward[i] = t->backward[i - 1] + cost(t, t->at[i], t->at[i - 1]);
    }
}

/* ---- Turning a segment round ---- */

static double gain_of_turn(const tour *t, int i, int j)
{
    double before = cost(t, t->at[i - 1], t->at[i]) + t->forward[j] - t->forward[i] + onward(t, t->at[j], j + 1);
    double after = cost(t, t->at[i - 1], t->at[j]) + t->backward[j] - t->backward[i] + onward(t, t->at[i], j + 1);
    return before - after;
}

static void turn(tour *t, int i, int j)
{
    for (; i < j; i++, j--) {
        int place = t->at[i];
        t->at[i] = t->at[j];
        t->at[j] = place;
    }
}

static bool turn_segments(tour *t)
{
    bool changed = false;
    for (int i = 1; i < t->count; i++) {
        for (int j = i + 1; j <= t->count; j++) {
            if (gain_of_turn(t, i, j) <= least_gain)
                continue;
            turn(t, i, j);
            sum_up(t);
            changed = true;
        }
    }
    return changed;
}

/* ---- Moving a segment elsewhere ---- */

/* Positions i .. j go between k and k + 1, which lie outside of them. */
static double gain_of_move(const tour *t, int i, int j, int k)
{
    double lifted = cost(t, t->at[i - 1], t->at[i]) + onward(t, t->at[j], j + 1) - onward(t, t->at[i - 1], j + 1);
    double put = cost(t, t->at[k], t->at[i]) + onward(t, t->at[j], k + 1) - onward(t, t->at[k], k + 1);
    return lifted - put;
}

static void move(tour *t, int i, int j, int k)
{
    int length = j - i + 1;
    memcpy(t->spare, t->at + i, (size_t)length * sizeof *t->at);
    if (k < i)
        memmove(t->at + k + 1 + length, t->at + k + 1, (size_t)(i - k - 1) * sizeof *t->at);
    else
        memmove(t->at + i, t->at + j + 1, (size_t)(k - j) * sizeof *t->at);
    memcpy(t->at + (k < i ? k + 1 : k + 1 - length), t->spare, (size_t)length * sizeof *t->at);
}

static bool move_segments(tour *t)
{
    enum { LONGEST = 3 };
    bool changed = false;
    for (int length = 1; length <= LONGEST; length++) {
        for (int i = 1; i + length - 1 <= t->count; i++) {
            for (int k = 0; k <= t->count; k++) {
                bool inside = k >= i - 1 && k <= i + length - 1;
                if (inside || gain_of_move(t, i, i + length - 1, k) <= least_gain)
                    continue;
                move(t, i, i + length - 1, k);
                sum_up(t);
                changed = true;
            }
        }
    }
    return changed;
}

/* ---- The tour ---- */

static void improve(tour *t)
{
    /* Each round that changes anything gains; the limit is for costs that are nearly equal. */
    enum { ROUNDS = 50 };
    go_to_nearest(t);
    sum_up(t);
    bool changed = true;
    for (int round = 0; changed && round < ROUNDS; round++) {
        changed = turn_segments(t);
        changed = move_segments(t) || changed;
    }
}

static void fill(tour *t, weft_tour_cost *function, const void *context)
{
    for (int from = 0; from <= t->count; from++) {
        for (int to = 0; to < t->count; to++)
            t->cost[(size_t)from * (size_t)t->count + (size_t)to] =
                (float)function(context, from == t->count ? -1 : from, to);
    }
    t->at[0] = t->count;
    for (int i = 0; i < t->count; i++)
        t->at[i + 1] = i;
}

weft_code weft_tour(int count, weft_tour_cost *function, const void *context, int *place, weft_error *error)
{
    if (count < 2 || count > WEFT_TOUR_MAX)
        return WEFT_OK;
    size_t n = (size_t)count;
    tour t = {.count = count,
              .cost = malloc((n + 1) * n * sizeof *t.cost),
              .at = malloc((n + 1) * sizeof *t.at),
              .forward = malloc((n + 1) * sizeof *t.forward),
              .backward = malloc((n + 1) * sizeof *t.backward),
              .spare = malloc(n * sizeof *t.spare)};
    weft_code code = WEFT_OK;
    if (!t.cost || !t.at || !t.forward || !t.backward || !t.spare) {
        code = weft_fail_memory(error, "order of the poses", (n + 1) * n * sizeof *t.cost);
    } else {
        fill(&t, function, context);
        improve(&t);
        memcpy(place, t.at + 1, n * sizeof *place);
    }
    free(t.cost);
    free(t.at);
    free(t.forward);
    free(t.backward);
    free(t.spare);
    return code;
}

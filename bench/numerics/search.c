#include "bench/numerics/search.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { STARTS = 8, MAX_MEDIAN = 4096 };

typedef struct point {
    double coordinate[NUMERICS_MAX_COORDINATES];
    double size;
} point;

typedef struct search {
    const numerics_set *set;
    numerics_id id;
    numerics_objective objective;
    numerics_hold hold;
    const numerics_domain *domain;
    int coordinates, numbers;
    uint64_t random;
    numerics_found found;
} search;

/* splitmix64 (Steele, Lea and Flood 2014), in [0, 1). */
static double uniform(search *s)
{
    uint64_t x = s->random += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return (double)((x ^ x >> 31) >> 11) * 0x1p-53;
}

static void note(numerics_worst *worst, double size, const double *argument)
{
    worst->size = size;
    memcpy(worst->argument, argument, sizeof worst->argument);
}

static void place(const search *s, const point *p, double *argument)
{
    point held = *p;
    if (s->hold.count > 0)
        numerics_make_ordinary(s->domain, held.coordinate);
    for (int i = 0; i < s->hold.count; i++)
        held.coordinate[s->hold.coordinate[i]] = s->hold.share;
    numerics_place(s->domain, held.coordinate, s->set->single, argument);
}

static void evaluate(search *s, point *p)
{
    double argument[NUMERICS_MAX_ARGUMENTS] = {0};
    place(s, p, argument);
    numerics_error error = numerics_error_at(s->set, s->id, argument, s->numbers, s->objective == NUMERICS_GROWTH);
    p->size = error.size[s->objective];
    s->found.evaluations++;
    s->found.jumps += error.jump;
    if (error.broken)
        note(&s->found.broken, s->found.broken.size + 1, argument);
    if (p->size > s->found.search.size)
        note(&s->found.search, p->size, argument);
}

/* ---- Random points ---- */

/* Keeps the worst points in decreasing order. */
static void keep(point *best, const point *p)
{
    if (p->size <= best[STARTS - 1].size)
        return;
    int i = STARTS - 1;
    for (; i > 0 && best[i - 1].size < p->size; i--)
        best[i] = best[i - 1];
    best[i] = *p;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void try_random_points(search *s, long count, point *best)
{
    static _Thread_local double size[MAX_MEDIAN];
    int sizes = 0;
    for (long k = 0; k < count; k++) {
        point p;
        for (int i = 0; i < s->coordinates; i++)
            p.coordinate[i] = uniform(s);
        evaluate(s, &p);
        keep(best, &p);
        if (p.size > 0 && sizes < MAX_MEDIAN)
            size[sizes++] = p.size;
    }
    qsort(size, (size_t)sizes, sizeof *size, ascending);
    s->found.median = sizes > 0 ? size[sizes / 2] : 0;
    s->found.random = s->found.search;
}

/* ---- Evolution ---- */

/* Some coordinates move by a step with a heavy tail: most refine, a few leap. */
static void mutate(search *s, const point *parent, double step, point *child)
{
    *child = *parent;
    double share = fmin(1, 2.5 / s->coordinates);
    for (int i = 0; i < s->coordinates; i++) {
        if (uniform(s) > share)
            continue;
        double moved = parent->coordinate[i] + step * tan(3.1 * (uniform(s) - 0.5));
        child->coordinate[i] = fmin(fmax(moved, 0), 1 - 0x1p-53);
    }
}

/* (1+1) evolution strategy; the step grows with success and shrinks without (Rechenberg's rule of one in five). */
static void evolve(search *s, point parent, long count)
{
    double step = 0.05;
    for (long k = 0; k < count; k++) {
        point child;
        mutate(s, &parent, step, &child);
        evaluate(s, &child);
        bool better = child.size >= parent.size;
        step = fmin(fmax(step * (better ? 1.5 : 0.904), 1e-9), 0.3);
        if (better)
            parent = child;
    }
}

numerics_found numerics_search(const numerics_set *set, numerics_id id, numerics_objective objective,
                               numerics_hold hold, long evaluations)
{
    search s = {.set = set, .id = id, .objective = objective, .hold = hold, .domain = numerics_domain_of(id)};
    s.random = (uint64_t)id * 1000 + (uint64_t)objective;
    s.coordinates = numerics_coordinate_count(s.domain);
    s.numbers = numerics_number_count(s.domain);
    point best[STARTS] = {0};
    try_random_points(&s, evaluations * 2 / 5, best);
    for (int i = 0; i < STARTS; i++)
        evolve(&s, best[i], (evaluations - evaluations * 2 / 5) / STARTS);
    return s.found;
}

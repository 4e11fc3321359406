#include "base/numeric/quadratic_program.h"

#include "base/numeric/cholesky.h"

#include <float.h>
#include <math.h>

enum { MAX = WEFT_QUADRATIC_PROGRAM_MAX, MOST_RELEASES = 16 * MAX };

static const double negligible = 64 * DBL_EPSILON; /* multiplier, as a part of the terms that cancel in it */

typedef struct program {
    int n;
    const double *h, *g, *low, *high;
} program;

/* A point of the box, and the bounds it is bound to: the others may move. */
typedef struct face {
    double *d; /* [n] */
    bool bound[MAX];
} face;

static bool bounds_are_ordered(const program *p)
{
    bool ordered = true;
    for (int i = 0; i < p->n; i++)
        ordered &= p->low[i] <= p->high[i];
    return ordered;
}

/* The minimiser over the free variables alone, wherever their bounds are; the others stay as in `at` and are not
 * written. */
static bool minimise_free(const program *p, const face *at, double *minimiser)
{
    double a[MAX * MAX], x[MAX];
    int index[MAX], m = 0, n = p->n;
    bool finite = true;
    for (int i = 0; i < n; i++) {
        if (!at->bound[i])
            index[m++] = i;
    }
    for (int i = 0; i < m; i++) {
        const double *row = p->h + index[i] * n;
        x[i] = p->g[index[i]];
        for (int j = 0; j < n; j++)
            x[i] -= at->bound[j] ? row[j] * at->d[j] : 0;
        for (int j = 0; j <= i; j++)
            a[i * MAX + j] = row[index[j]];
        finite &= isfinite(x[i]) != 0;
    }
    if (!finite || !weft_cholesky_factor(m, MAX, a))
        return false;
    weft_cholesky_solve(m, MAX, a, x);
    for (int i = 0; i < m; i++)
        minimiser[index[i]] = x[i];
    return true;
}

/* A first face: minimises, binds what leaves the box, and minimises over the rest until nothing leaves. Most often this
 * is the solution, and without a bound in reach it is one factorisation. But what has been bound may have to be let go
 * again. */
static bool guess_face(const program *p, face *at)
{
    for (int i = 0; i < p->n; i++) {
        at->d[i] = p->low[i];
        at->bound[i] = p->low[i] >= p->high[i];
    }
    for (bool inside = false; !inside;) {
        if (!minimise_free(p, at, at->d))
            return false;
        inside = true;
        for (int i = 0; i < p->n; i++) {
            if (at->d[i] < p->low[i] || at->d[i] > p->high[i]) {
                at->d[i] = at->d[i] < p->low[i] ? p->low[i] : p->high[i];
                at->bound[i] = true;
                inside = false;
            }
        }
    }
    return true;
}

/* The bound variable that promises to lower the objective most when it alone leaves its bound; -1 where no multiplier
 * has the wrong sign: the point is the solution. */
static int find_release(const program *p, const face *at)
{
    int found = -1;
    double best = 0;
    for (int i = 0; i < p->n; i++) {
        if (!at->bound[i] || p->low[i] >= p->high[i])
            continue;
        double slope = p->g[i], size = fabs(slope);
        for (int j = 0; j < p->n; j++) {
            double term = p->h[i * p->n + j] * at->d[j];
            slope -= term;
            size += fabs(term);
        }
        double inwards = at->d[i] > p->low[i] ? -slope : slope;
        double gain = inwards * inwards / p->h[i * p->n + i];
        if (inwards > negligible * size && gain > best) {
            best = gain;
            found = i;
        }
    }
    return found;
}

/* Goes from the point towards `to` as far as the box allows, and binds the variables that stop it. False where it
 * arrives. */
static bool step(const program *p, const double *to, face *at)
{
    double end[MAX], length[MAX], least = 1;
    for (int i = 0; i < p->n; i++) {
        end[i] = at->bound[i] ? at->d[i] : fmin(fmax(to[i], p->low[i]), p->high[i]);
        length[i] = at->bound[i] || end[i] == to[i] ? INFINITY : (end[i] - at->d[i]) / (to[i] - at->d[i]);
        least = fmin(least, length[i]);
    }
    bool stopped = false;
    for (int i = 0; i < p->n; i++) {
        bool stops = length[i] <= least;
        if (least < 1 && !stops && !at->bound[i])
            end[i] = fmin(fmax(at->d[i] + least * (to[i] - at->d[i]), p->low[i]), p->high[i]);
        at->d[i] = end[i];
        at->bound[i] |= stops;
        stopped |= stops;
    }
    return stopped;
}

/* Descends to the minimum on a face: that of `at`, or a smaller one where bounds stop the descent. False where there is
 * no minimum. */
static bool descend(const program *p, face *at)
{
    double to[MAX];
    do {
        if (!minimise_free(p, at, to))
            return false;
    } while (step(p, to, at));
    return true;
}

static bool is_finite(int n, const double *d)
{
    bool finite = true;
    for (int i = 0; i < n; i++)
        finite &= isfinite(d[i]) != 0;
    return finite;
}

/* Every descent begins and ends at the minimum on a face, and ends lower than it began. So no face comes twice, and the
 * search ends. The limit only guards against rounding: it is far above the 13 releases that a program has needed. */
bool weft_quadratic_program_solve(int n, const double *h, const double *g, const double *low, const double *high,
                                  double *d)
{
    const program p = {n, h, g, low, high};
    face at = {.d = d};
    if (!bounds_are_ordered(&p) || !guess_face(&p, &at))
        return false;
    for (int releases = 0; releases <= MOST_RELEASES; releases++) {
        int i = find_release(&p, &at);
        if (i < 0)
            return is_finite(n, d);
        at.bound[i] = false;
        if (!descend(&p, &at))
            return false;
    }
    return false;
}

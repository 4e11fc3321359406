#include "capture/axes/path.h"

#include <math.h>
#include <stdlib.h>

static const double same_deg = 1e-9;

/* ---- Viewpoints ----
 *
 * A viewpoint is what is visited once: poses whose slow axes, as a mask, stand alike. */

typedef struct viewpoint {
    int first, count; /* in the sorted numbers */
} viewpoint;

typedef struct plan {
    const weft_axes *axes;
    bool slow[WEFT_AXES_MAX];
    const weft_axis_positions *pose;
    int count, *number; /* sorted by viewpoint */
    int viewpoint_count, *viewpoint_order;
    viewpoint *viewpoint;
    const weft_axis_positions *from; /* where the tour at hand begins; NULL: anywhere */
    const int *local;                /* its numbers */
} plan;

/* Those of camera and sample; those of the light where an operator turns one. */
static void choose_slow_axes(plan *p)
{
    bool light = false;
    for (int k = 0; k < p->axes->count; k++)
        light = light || (p->axes->axis[k].by_hand && p->axes->axis[k].moves == WEFT_BODY_LIGHT);
    for (int k = 0; k < p->axes->count; k++)
        p->slow[k] = (p->axes->axis[k].moves == WEFT_BODY_LIGHT) == light;
}

/* qsort has no context. */
static _Thread_local const plan *sorting;

static int compare_viewpoints(const void *a, const void *b)
{
    const int *p = a, *q = b;
    for (int k = 0; k < sorting->axes->count; k++) {
        double difference = sorting->pose[*p].deg[k] - sorting->pose[*q].deg[k];
        if (sorting->slow[k] && fabs(difference) > same_deg)
            return difference < 0 ? -1 : 1;
    }
    return *p - *q;
}

static bool same_viewpoint(const plan *p, int a, int b)
{
    for (int k = 0; k < p->axes->count; k++) {
        if (p->slow[k] && fabs(p->pose[a].deg[k] - p->pose[b].deg[k]) > same_deg)
            return false;
    }
    return true;
}

static weft_code find_viewpoints(plan *p, weft_error *error)
{
    sorting = p;
    qsort(p->number, (size_t)p->count, sizeof *p->number, compare_viewpoints);
    p->viewpoint = malloc((size_t)p->count * sizeof *p->viewpoint);
    p->viewpoint_order = malloc((size_t)p->count * sizeof *p->viewpoint_order);
    if (!p->viewpoint || !p->viewpoint_order)
        return weft_fail_memory(error, "order of the poses", (size_t)p->count * sizeof *p->viewpoint);
    for (int i = 0; i < p->count; i++) {
        if (i > 0 && same_viewpoint(p, p->number[i - 1], p->number[i])) {
            p->viewpoint[p->viewpoint_count - 1].count++;
            continue;
        }
        p->viewpoint_order[p->viewpoint_count] = p->viewpoint_count;
        p->viewpoint[p->viewpoint_count++] = (viewpoint){i, 1};
    }
    return WEFT_OK;
}

/* ---- Tours ---- */

/* The other axes travel meanwhile, and less far: they are left out. */
static double between_viewpoints(const void *context, int from, int to)
{
    const plan *p = context;
    if (from < 0)
        return 0;
    weft_axis_positions a = p->pose[p->number[p->viewpoint[from].first]],
                        b = p->pose[p->number[p->viewpoint[to].first]];
    for (int k = 0; k < p->axes->count; k++) {
        if (!p->slow[k])
            a.deg[k] = b.deg[k] = 0;
    }
    return weft_axes_move_s(p->axes, &a, &b);
}

static double within_viewpoint(const void *context, int from, int to)
{
    const plan *p = context;
    const weft_axis_positions *a = from < 0 ? p->from : &p->pose[p->local[from]];
    return a ? weft_axes_move_s(p->axes, a, &p->pose[p->local[to]]) : 0;
}

/* Appends the poses of a viewpoint to `ordered`. */
static weft_code tour_viewpoint(plan *p, const viewpoint *s, int *ordered, int done, weft_error *error)
{
    int *tour = malloc((size_t)s->count * sizeof *tour);
    if (!tour)
        return weft_fail_memory(error, "order of the poses", (size_t)s->count * sizeof *tour);
    p->from = done > 0 ? &p->pose[ordered[done - 1]] : NULL;
    p->local = p->number + s->first;
    for (int i = 0; i < s->count; i++)
        tour[i] = i;
    weft_code code = weft_tour(s->count, within_viewpoint, p, tour, error);
    for (int i = 0; i < s->count; i++)
        ordered[done + i] = p->local[tour[i]];
    free(tour);
    return code;
}

static weft_code tour_all(plan *p, int *ordered, weft_error *error)
{
    WEFT_TRY(weft_tour(p->viewpoint_count, between_viewpoints, p, p->viewpoint_order, error));
    for (int i = 0, done = 0; i < p->viewpoint_count; i++) {
        const viewpoint *s = &p->viewpoint[p->viewpoint_order[i]];
        WEFT_TRY(tour_viewpoint(p, s, ordered, done, error));
        done += s->count;
    }
    return WEFT_OK;
}

/* ---- What it comes to ---- */

static void measure(const plan *p, weft_axes_path *path)
{
    for (int i = 1; i < p->count; i++) {
        double seconds = weft_axes_move_s(p->axes, &p->pose[p->number[i - 1]], &p->pose[p->number[i]]);
        path->seconds += seconds;
        path->moves += seconds > 0;
    }
}

static weft_code order(plan *p, weft_axes_path *path, weft_error *error)
{
    int *ordered = calloc((size_t)p->count, sizeof *ordered);
    if (!ordered)
        return weft_fail_memory(error, "order of the poses", (size_t)p->count * sizeof *ordered);
    weft_code code = find_viewpoints(p, error);
    if (code == WEFT_OK)
        code = tour_all(p, ordered, error);
    for (int i = 0; code == WEFT_OK && i < p->count; i++)
        p->number[i] = ordered[i];
    free(ordered);
    WEFT_TRY(code);
    measure(p, path);
    return WEFT_OK;
}

weft_code weft_axes_order(const weft_axes *axes, const weft_axis_positions *pose, int count, int *number,
                          weft_axes_path *path, weft_error *error)
{
    plan p = {.axes = axes, .pose = pose, .count = count, .number = number};
    *path = (weft_axes_path){0};
    choose_slow_axes(&p);
    weft_code code = count > 1 ? order(&p, path, error) : WEFT_OK;
    free(p.viewpoint);
    free(p.viewpoint_order);
    return code;
}

#include "compress/texel/frame_search.h"

#include <stdlib.h>

/* A frame is turned only where that takes at least 2 % off the squared error. */
#define WORTHWHILE 0.98

/* The fit of the grey samples is a start, not worth its last steps. */
#define GREY_TOLERANCE 3e-3

enum { TABLES = 6 * WEFT_FINALISTS };

weft_code weft_frame_search_create(int view_count, weft_frame_search *search, weft_error *error)
{
    size_t views = (size_t)view_count;
    double *tables = calloc(TABLES * views, sizeof *tables);
    *search = (weft_frame_search){.tables = tables};
    if (!tables)
        return weft_fail_memory(error, "view tables of grey fits", TABLES * views * sizeof *tables);
    for (size_t i = 0; i < WEFT_FINALISTS; i++) {
        double *own = tables + 6 * i * views;
        search->surface[i] = (weft_finalist){.upright_table = own, .turned_table = own + views};
        search->given[i] = (weft_finalist){.upright_table = own + 2 * views, .turned_table = own + 3 * views};
        search->bare[i] = (weft_finalist){.upright_table = own + 4 * views, .turned_table = own + 5 * views};
    }
    return WEFT_OK;
}

void weft_frame_search_free(weft_frame_search *search)
{
    free(search->tables);
    *search = (weft_frame_search){0};
}

/* The best of the fits begun in a frame. A diffuse term has no use for turns. */
static weft_grey_fit fit_from_frame(const weft_bundle *bundle, const weft_samples *samples,
                                    weft_fit_workspace *workspace, const weft_fit_options *options,
                                    const weft_frame *frame, weft_finalist *finalist)
{
    weft_starts starts;
    bool turns = options->lobe_count > 0;
    weft_fit_find_starts(bundle, samples, WEFT_GREY, options, workspace, frame, &starts);
    weft_fit_refine_starts(bundle, samples, WEFT_GREY, options, turns, workspace, &starts, WEFT_FINALISTS, finalist);
    if (turns && finalist->turned.residual < WORTHWHILE * finalist->upright.residual)
        return (weft_grey_fit){finalist->turned, finalist->turned_table, true};
    return (weft_grey_fit){finalist->upright, finalist->upright_table, false};
}

static bool has_vanished_lobe(const weft_fit *fit)
{
    bool vanished = false;
    for (int i = 0; i < fit->lobe_count; i++)
        vanished |= !(fit->lobe[i].amplitude > 0);
    return vanished;
}

static weft_grey_fit better(weft_grey_fit best, weft_grey_fit other)
{
    return other.fit.residual < best.fit.residual ? other : best;
}

/* T alone may explain so much that no lobe is found beside it. Lobes that are found without T mostly leave less with
 * it, too. */
static weft_grey_fit fit_from_bare(weft_frame_search *search, const weft_bundle *bundle, const weft_samples *samples,
                                   weft_fit_workspace *workspace, const weft_fit_options *options,
                                   const weft_frame *frame)
{
    weft_fit_options bare = *options, whole = *options;
    bare.table = false;
    weft_grey_fit found = fit_from_frame(bundle, samples, workspace, &bare, frame, search->bare);
    whole.fit_frame = found.turns;
    weft_fit_refine(bundle, samples, WEFT_GREY, &whole, workspace, &found.fit, found.table);
    return found;
}

weft_grey_fit weft_frame_search_run(weft_frame_search *search, const weft_bundle *bundle, const weft_samples *samples,
                                    weft_fit_workspace *workspace, const weft_fit_options *options,
                                    const weft_frame *given)
{
    const weft_frame surface = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_fit_options grey = *options;
    grey.tolerance = GREY_TOLERANCE;
    weft_grey_fit best = fit_from_frame(bundle, samples, workspace, &grey, &surface, search->surface);
    if (options->table && has_vanished_lobe(&best.fit))
        best = better(best, fit_from_bare(search, bundle, samples, workspace, &grey, &surface));
    if (options->lobe_count > 0 && given)
        best = better(best, fit_from_frame(bundle, samples, workspace, &grey, given, search->given));
    return best;
}

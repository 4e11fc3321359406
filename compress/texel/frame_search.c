#include "compress/texel/frame_search.h"

#include <stdlib.h>
#include <string.h>

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

static weft_grey_fit choose_frame(const weft_finalist *from, bool turn)
{
    if (turn && from->turned.residual < WORTHWHILE * from->upright.residual)
        return (weft_grey_fit){from->turned, from->turned_table, true};
    return (weft_grey_fit){from->upright, from->upright_table, false};
}

void weft_frame_search_forget(weft_frame_search *search)
{
    search->starts[0].found = search->starts[1].found = false;
}

/* A diffuse term has no use for a frame. */
static bool may_turn(const weft_frame_request *request)
{
    return request->choice == WEFT_FRAMES_FITTED && request->options.lobe_count > 0;
}

static const weft_starts *find_starts(weft_frame_search *search, const weft_bundle *bundle, const weft_samples *samples,
                                      weft_fit_workspace *workspace, const weft_frame_request *request)
{
    const weft_frame surface = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_frame_starts *starts = &search->starts[request->options.table];
    weft_fit_options options = request->options;
    bool use_given = request->choice == WEFT_FRAMES_GIVEN && request->given;
    if (starts->found)
        return &starts->surface;
    options.lobe_count = request->most_lobes;
    weft_fit_find_starts(bundle, samples, WEFT_GREY, &options, workspace, use_given ? request->given : &surface,
                         &starts->surface);
    if (request->choice == WEFT_FRAMES_FITTED && request->given)
        weft_fit_find_starts(bundle, samples, WEFT_GREY, &options, workspace, request->given, &starts->given);
    starts->found = true;
    return &starts->surface;
}

static bool has_vanished_lobe(const weft_fit *fit)
{
    bool vanished = false;
    for (int i = 0; i < fit->lobe_count; i++)
        vanished |= !(fit->lobe[i].amplitude > 0);
    return vanished;
}

static void challenge(weft_frame_search *search, weft_grey_fit fit)
{
    bool is_better = fit.fit.residual < search->best.fit.residual;
    if (is_better) {
        search->other = search->best;
        search->best = fit;
        search->has_other = true;
    }
}

/* T alone may explain so much that no lobe is found beside it. Lobes that are found without T mostly leave less with
 * it, too. */
static void try_bare_starts(weft_frame_search *search, const weft_bundle *bundle, const weft_samples *samples,
                            weft_fit_workspace *workspace, const weft_frame_request *request)
{
    weft_frame_request bare = *request;
    weft_fit_options options = request->options;
    bool turn = may_turn(request);
    bare.options.table = false;
    bare.options.tolerance = options.tolerance = GREY_TOLERANCE;
    const weft_starts *starts = find_starts(search, bundle, samples, workspace, &bare);
    weft_fit_refine_starts(bundle, samples, WEFT_GREY, &bare.options, turn, workspace, starts, WEFT_FINALISTS,
                           search->bare);
    weft_grey_fit found = choose_frame(&search->bare[0], turn);
    options.fit_frame = found.turns;
    weft_fit_refine(bundle, samples, WEFT_GREY, &options, workspace, &found.fit, found.table);
    challenge(search, found);
}

void weft_frame_search_run(weft_frame_search *search, const weft_bundle *bundle, const weft_samples *samples,
                           weft_fit_workspace *workspace, const weft_frame_request *request)
{
    weft_fit_options options = request->options;
    const weft_starts *starts = find_starts(search, bundle, samples, workspace, request);
    bool turn = may_turn(request);
    options.tolerance = GREY_TOLERANCE;
    int count = weft_fit_refine_starts(bundle, samples, WEFT_GREY, &options, turn, workspace, starts, WEFT_FINALISTS,
                                       search->surface);
    search->best = choose_frame(&search->surface[0], turn);
    search->has_other = count > 1;
    if (count > 1)
        search->other = choose_frame(&search->surface[1], turn);
    if (request->options.table && has_vanished_lobe(&search->best.fit))
        try_bare_starts(search, bundle, samples, workspace, request);
    if (!turn || !request->given)
        return;
    starts = &search->starts[request->options.table].given;
    weft_fit_refine_starts(bundle, samples, WEFT_GREY, &options, turn, workspace, starts, WEFT_FINALISTS,
                           search->given);
    challenge(search, choose_frame(&search->given[0], turn));
}

bool weft_frame_search_other(weft_frame_search *search, const weft_bundle *bundle, const weft_samples *samples,
                             weft_fit_workspace *workspace, const weft_frame_request *request)
{
    weft_starts second = search->starts[request->options.table].surface;
    int lobes = request->options.lobe_count;
    bool turn = may_turn(request);
    if (search->has_other || second.count[lobes] < 2)
        return search->has_other;
    second.start[lobes][0] = second.start[lobes][1];
    weft_fit_options options = request->options;
    options.tolerance = GREY_TOLERANCE;
    weft_fit_refine_starts(bundle, samples, WEFT_GREY, &options, turn, workspace, &second, 1, &search->surface[1]);
    search->other = choose_frame(&search->surface[1], turn);
    search->has_other = true;
    return true;
}

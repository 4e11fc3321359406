#include "compress/texel/frame_search.h"

#include <stdlib.h>
#include <string.h>

/* A frame is turned only where that takes at least 2 % off the squared error. */
#define WORTHWHILE 0.98

/* The fit of the grey samples is a start, not worth its last steps. */
#define GREY_TOLERANCE 3e-3

weft_code weft_frame_search_create(int view_count, weft_frame_search *search, weft_error *error)
{
    size_t views = (size_t)view_count;
    double *tables = calloc(3 * views, sizeof *tables);
    *search = (weft_frame_search){.upright.table = tables};
    if (!tables)
        return weft_fail_memory(error, "view tables of grey fits", 3 * views * sizeof *tables);
    search->given.table = tables + views;
    search->turned.table = tables + 2 * views;
    return WEFT_OK;
}

void weft_frame_search_free(weft_frame_search *search)
{
    free(search->upright.table);
    *search = (weft_frame_search){0};
}

/* What all fits of a texel share. */
typedef struct grey_samples {
    const weft_bundle *bundle;
    const weft_samples *samples;
    weft_fit_workspace *workspace;
    weft_fit_options options;
} grey_samples;

static void fit_from_nothing(const grey_samples *grey, const weft_frame *frame, weft_grey_fit *to)
{
    weft_fit_cold(grey->bundle, grey->samples, WEFT_GREY, &grey->options, grey->workspace, frame, &to->fit, to->table);
}

/* A diffuse term has no use for a frame. */
static weft_grey_fit *fit_as_it_is(weft_frame_search *search, const grey_samples *grey,
                                   const weft_frame_request *request)
{
    const weft_frame surface = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_grey_fit *upright = &search->upright, *given = &search->given;
    bool one = request->choice != WEFT_FRAMES_FITTED || grey->options.lobe_count == 0 || !request->given;
    if (one) {
        bool use_given = request->choice == WEFT_FRAMES_GIVEN && request->given;
        fit_from_nothing(grey, use_given ? request->given : &surface, upright);
        return upright;
    }
    fit_from_nothing(grey, &surface, upright);
    fit_from_nothing(grey, request->given, given);
    return given->fit.residual < upright->fit.residual ? given : upright;
}

const weft_grey_fit *weft_frame_search_run(weft_frame_search *search, const weft_bundle *bundle,
                                           const weft_samples *samples, weft_fit_workspace *workspace,
                                           const weft_frame_request *request)
{
    grey_samples grey = {bundle, samples, workspace, request->options};
    grey.options.tolerance = GREY_TOLERANCE;
    weft_grey_fit *start = fit_as_it_is(search, &grey, request), *turned = &search->turned;
    if (grey.options.lobe_count == 0 || request->choice != WEFT_FRAMES_FITTED)
        return start;
    grey.options.fit_frame = true;
    turned->fit = start->fit;
    memcpy(turned->table, start->table, (size_t)bundle->view_count * sizeof *turned->table);
    weft_fit_refine(bundle, samples, WEFT_GREY, &grey.options, workspace, &turned->fit, turned->table);
    return turned->fit.residual < WORTHWHILE * start->fit.residual ? turned : start;
}

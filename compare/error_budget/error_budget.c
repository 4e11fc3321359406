#include "compare/error_budget/error_budget.h"

#include "base/atomic_file.h"
#include "btf/file_kind.h"
#include "geometry/stitch/stitch.h"

#include <stdio.h>
#include <stdlib.h>

/* The tiles of a stitch have their size in mm, and few of them fill an opening. Opening and lens are scaled until they
 * do, and so is how far sample and camera are from their places. */
static weft_code scale_to_tiles(const char *cloth, double tiles, weft_virtual_settings *rig, weft_error *error)
{
    weft_file_kind kind;
    weft_stitch stitch;
    WEFT_TRY(weft_file_kind_of(cloth, &kind, error));
    if (kind != WEFT_FILE_STITCH || !(tiles > 0))
        return WEFT_OK;
    WEFT_TRY(weft_stitch_read(cloth, &stitch, error));
    double opening_mm = tiles * stitch.width;
    double scale = opening_mm / rig->rig.opening_mm;
    rig->rig.opening_mm = opening_mm;
    rig->rig.focal_length_px /= scale;
    rig->mounting_translation_mm *= scale;
    rig->viewpoint_translation_mm *= scale;
    weft_stitch_free(&stitch);
    return WEFT_OK;
}

static weft_code split_error(const weft_error_budget_request *request, const weft_source_stages *stages,
                             const weft_progress *progress, weft_error_budget *result, weft_error *error)
{
    const weft_source_queries *queries = &request->queries;
    weft_source_answer *answer = calloc((size_t)queries->count, sizeof *answer);
    if (!answer)
        return weft_fail_memory(error, "queries", (size_t)queries->count * sizeof *answer);
    weft_code code = weft_source_answers(stages, queries, progress, answer, &result->span, error);
    if (code == WEFT_OK)
        code = weft_error_stack_of(answer, (size_t)(result->span.asked - result->span.unseen), queries->seed,
                                   &result->stack, error);
    free(answer);
    return code;
}

static weft_code measure(const weft_error_budget_request *request, weft_virtual_rig *rig, const weft_progress *progress,
                         weft_error_budget *result, weft_error *error)
{
    weft_chain chain;
    weft_code code = weft_chain_make(&request->chain, rig, request->folder, progress, &chain, error);
    const weft_source_stages stages = {&rig->sample, chain.registered, chain.fitted, chain.stored};
    if (code == WEFT_OK)
        code = split_error(request, &stages, progress, result, error);
    weft_chain_remove(&chain);
    result->photograph_count = chain.photograph_count;
    result->registered_count = chain.registered_count;
    result->component_count = chain.component_count;
    return code;
}

weft_code weft_error_budget_measure(const weft_error_budget_request *request, const char *cloth,
                                    const weft_progress *progress, weft_error_budget *result, weft_error *error)
{
    weft_virtual_request wanted = {cloth, request->queries.seed, request->rig};
    weft_virtual_rig rig;
    *result = (weft_error_budget){.size = request->chain.size};
    WEFT_TRY(scale_to_tiles(cloth, request->tiles, &wanted.settings, error));
    WEFT_TRY(weft_make_folder(request->folder, error));
    WEFT_TRY(weft_virtual_rig_open(&wanted, &rig, error));
    snprintf(result->name, sizeof result->name, "%s", weft_virtual_sample_name(&rig.sample));
    result->opening_mm = wanted.settings.rig.opening_mm;
    weft_code code = measure(request, &rig, progress, result, error);
    weft_virtual_rig_close(&rig);
    return code;
}

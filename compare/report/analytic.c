/* The analytic cloth of a comparison: read as it is, or fitted to the dataset first. */
#include "compare/report/compare.h"

#include "base/atomic_file.h"
#include "btf/file_kind.h"
#include "compress/weave_fit/fit_weave.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static weft_code fit_and_write(const weft_compare_options *options, weft_dataset *dataset, const char *path,
                               const weft_progress *progress, weft_fit_weave_report *report, weft_error *error)
{
    weft_weave weave;
    weft_fit_weave_source source;
    char warning[WEFT_MESSAGE_SIZE];
    WEFT_TRY(weft_make_folder(options->folder, error));
    WEFT_TRY(weft_weave_read(options->weave, NULL, 0, &weave, warning, error));
    weft_code code = weft_fit_weave_to_dataset(dataset, &weave, progress, &source, report, error);
    if (code == WEFT_OK)
        code = weft_fit_weave_write(path, &weave, dataset, report, error);
    weft_weave_free(&weave);
    return code;
}

static weft_code name_file(const weft_compare_options *options, weft_compared_weave *weave, weft_error *error)
{
    int length = options->fit ? asprintf(&weave->path, "%s/fitted.wv", options->folder)
                              : asprintf(&weave->path, "%s", options->weave);
    if (length >= 0)
        return WEFT_OK;
    weave->path = NULL;
    return weft_fail_memory(error, "path", 0);
}

static weft_code open_threads(const weft_compare_options *options, weft_compared_weave *weave,
                              weft_comparison *comparison, weft_error *error)
{
    if (options->fit)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' is microcylinder cloth: only a weave (.wv) is fitted",
                         options->weave);
    if (options->tiles_u > 0)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' is microcylinder cloth: only a weave (.wv) has tiles",
                         options->weave);
    WEFT_TRY(weft_microcylinder_read(weave->path, NULL, 0, &weave->threads, error));
    memcpy(comparison->weave_name, weave->threads.name, sizeof comparison->weave_name);
    snprintf(comparison->weave_origin, sizeof comparison->weave_origin, "as its file gives it, the same at all texels");
    return WEFT_OK;
}

static weft_code open_weave(const weft_compare_options *options, weft_dataset *dataset, const weft_progress *progress,
                            weft_compared_weave *weave, weft_comparison *comparison, weft_error *error)
{
    if (options->fit)
        WEFT_TRY(fit_and_write(options, dataset, weave->path, progress, &comparison->fit, error));
    WEFT_TRY(weft_fit_weave_origin(weave->path, dataset, comparison->weave_origin, error));
    WEFT_TRY(weft_weave_read(weave->path, NULL, 0, &weave->weave, NULL, error));
    memcpy(comparison->weave_name, weave->weave.name, sizeof comparison->weave_name);
    comparison->weave_layout = weft_weave_lay_out(&weave->weave, options->tiles_u, options->tiles_v);
    comparison->weave_on_yarns = weave->weave.layout.tiles_u > 0 && !(options->tiles_u > 0);
    return WEFT_OK;
}

weft_code weft_compare_weave_open(const weft_compare_options *options, weft_dataset *dataset,
                                  const weft_progress *progress, weft_compared_weave *weave,
                                  weft_comparison *comparison, weft_error *error)
{
    weft_file_kind kind;
    WEFT_TRY(weft_file_kind_of(options->weave, &kind, error));
    WEFT_TRY(name_file(options, weave, error));
    weave->is_threads = comparison->weave_is_threads = kind == WEFT_FILE_MICROCYLINDER;
    if (weave->is_threads)
        return open_threads(options, weave, comparison, error);
    return open_weave(options, dataset, progress, weave, comparison, error);
}

void weft_compare_weave_close(weft_compared_weave *weave)
{
    weft_weave_free(&weave->weave);
    free(weave->path);
    *weave = (weft_compared_weave){0};
}

/* The analytic cloth of a comparison: read as it is, or fitted to the dataset first. */
#include "study/compare_weave.h"

#include "btf/atomic_file.h"
#include "study/fit_weave_origin.h"

#include <stdio.h>
#include <stdlib.h>

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

weft_code weft_compare_weave_open(const weft_compare_options *options, weft_dataset *dataset,
                                  const weft_progress *progress, weft_compared_weave *weave,
                                  weft_comparison *comparison, weft_error *error)
{
    weft_rig_settings rig = weft_rig_settings_default();
    WEFT_TRY(name_file(options, weave, error));
    if (options->fit)
        WEFT_TRY(fit_and_write(options, dataset, weave->path, progress, &comparison->fit, error));
    WEFT_TRY(weft_fit_weave_origin(weave->path, dataset, comparison->weave_origin, error));
    WEFT_TRY(weft_virtual_cloth_read(weave->path, &rig, 0, &weave->cloth, NULL, error));
    comparison->weave_layout = weft_virtual_cloth_layout(&weave->cloth, options->tiles_u, options->tiles_v);
    comparison->weave_on_yarns = weave->cloth.weave.layout.tiles_u > 0 && !(options->tiles_u > 0);
    return WEFT_OK;
}

void weft_compare_weave_close(weft_compared_weave *weave)
{
    weft_virtual_cloth_free(&weave->cloth);
    free(weave->path);
    *weave = (weft_compared_weave){0};
}

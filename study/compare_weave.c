/* The analytic cloth of a comparison: read as it is, or fitted to the dataset first. */
#include "study/compare_weave.h"

#include "btf/atomic_file.h"
#include "study/fit_weave_origin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static weft_code fit_and_write(const weft_compare_options *options, weft_dataset *dataset, const char *path,
                               const weft_progress *progress, weft_comparison *comparison, weft_error *error)
{
    weft_weave weave;
    char warning[WEFT_MESSAGE_SIZE];
    WEFT_TRY(weft_make_folder(options->folder, error));
    WEFT_TRY(weft_weave_read(options->weave, NULL, 0, &weave, warning, error));
    weft_code code =
        weft_fit_weave_to_dataset(dataset, &weave, progress, &comparison->fit_source, &comparison->fit, error);
    if (code == WEFT_OK)
        code = weft_fit_weave_write(path, &weave, dataset, &comparison->fit, error);
    weft_weave_free(&weave);
    return code;
}

/* Tiles across the material: those asked for, those that the fit found, or as the virtual rig lays them out. */
static weft_rig_settings layout_of(const weft_compare_options *options, const weft_fit_weave_source *source)
{
    weft_rig_settings layout = weft_rig_settings_default();
    layout.tiles_x = options->tiles_u;
    layout.tiles_y = options->tiles_v;
    layout.cloth_noise = 0;
    if (source->tiled && !(options->tiles_u > 0)) {
        layout.tiles_x = fmax(1, round(source->tile.tiles_x));
        layout.tiles_y = fmax(1, round(source->tile.tiles_y));
    }
    return layout;
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
    char warning[WEFT_MESSAGE_SIZE];
    WEFT_TRY(name_file(options, weave, error));
    if (options->fit)
        WEFT_TRY(fit_and_write(options, dataset, weave->path, progress, comparison, error));
    WEFT_TRY(weft_fit_weave_origin(weave->path, dataset, comparison->weave_origin, error));
    weft_rig_settings layout = layout_of(options, &comparison->fit_source);
    return weft_virtual_cloth_read(weave->path, &layout, 0, &weave->cloth, warning, error);
}

void weft_compare_weave_close(weft_compared_weave *weave)
{
    weft_virtual_cloth_free(&weave->cloth);
    free(weave->path);
    *weave = (weft_compared_weave){0};
}

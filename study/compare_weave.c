/* The analytic cloth of a comparison: read as it is, or fitted to the dataset first. */
#include "study/compare_weave.h"

#include "btf/atomic_file.h"
#include "capture/virtual_cloth.h"
#include "study/fit_weave_origin.h"

#include <stdio.h>
#include <stdlib.h>

static weft_code fit_and_write(const weft_compare_options *options, weft_dataset *dataset, const char *path,
                               const weft_progress *progress, weft_fit_weave_source *source,
                               weft_fit_weave_report *report, weft_error *error)
{
    weft_weave weave;
    char warning[WEFT_MESSAGE_SIZE];
    WEFT_TRY(weft_make_folder(options->folder, error));
    WEFT_TRY(weft_weave_read(options->weave, NULL, 0, &weave, warning, error));
    weft_code code = weft_fit_weave_to_dataset(dataset, &weave, progress, source, report, error);
    if (code == WEFT_OK)
        code = weft_fit_weave_write(path, &weave, dataset, report, error);
    weft_weave_free(&weave);
    return code;
}

/* As the virtual rig lays a weave out. */
static weft_code rig_layout(const char *path, weft_weave_layout *layout, weft_error *error)
{
    weft_rig_settings settings = weft_rig_settings_default();
    weft_virtual_cloth cloth;
    WEFT_TRY(weft_virtual_cloth_read(path, &settings, 0, &cloth, NULL, error));
    *layout = (weft_weave_layout){.tiles_u = cloth.tiles_x, .tiles_v = cloth.tiles_y};
    weft_virtual_cloth_free(&cloth);
    return WEFT_OK;
}

static weft_code lay(const weft_compare_options *options, const weft_dataset_layout *material,
                     const weft_fit_weave_source *source, const char *path, weft_comparison *comparison,
                     weft_error *error)
{
    weft_weave_layout *layout = &comparison->weave_layout;
    comparison->weave_on_yarns = source->tiled && !(options->tiles_u > 0);
    if (options->tiles_u > 0)
        *layout = (weft_weave_layout){.tiles_u = options->tiles_u, .tiles_v = options->tiles_v};
    else if (source->tiled)
        *layout = weft_tile_layout(&source->tile.tile, material);
    else
        return rig_layout(path, layout, error);
    return WEFT_OK;
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
    weft_fit_weave_source source = {0};
    WEFT_TRY(name_file(options, weave, error));
    if (options->fit)
        WEFT_TRY(fit_and_write(options, dataset, weave->path, progress, &source, &comparison->fit, error));
    WEFT_TRY(weft_fit_weave_origin(weave->path, dataset, comparison->weave_origin, error));
    WEFT_TRY(lay(options, weft_dataset_get_layout(dataset), &source, weave->path, comparison, error));
    return weft_weave_read(weave->path, NULL, 0, &weave->weave, warning, error);
}

void weft_compare_weave_close(weft_compared_weave *weave)
{
    weft_weave_free(&weave->weave);
    free(weave->path);
    *weave = (weft_compared_weave){0};
}

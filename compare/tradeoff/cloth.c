#include "compare/tradeoff/cloth.h"

#include "base/clock.h"
#include "btf/file_kind.h"
#include "compress/weave_fit/fit_weave.h"

weft_code weft_priced_cloth_open(const char *path, weft_priced_cloth *cloth, weft_error *error)
{
    weft_file_kind kind;
    *cloth = (weft_priced_cloth){0};
    WEFT_TRY(weft_file_kind_of(path, &kind, error));
    if (kind != WEFT_FILE_WEAVE && kind != WEFT_FILE_MICROCYLINDER)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is neither a weave (.wv) nor microcylinder cloth (.mc)", path);
    cloth->is_threads = kind == WEFT_FILE_MICROCYLINDER;
    return cloth->is_threads ? weft_microcylinder_read(path, NULL, 0, &cloth->threads, error)
                             : weft_weave_read(path, NULL, 0, &cloth->weave, NULL, error);
}

void weft_priced_cloth_free(weft_priced_cloth *cloth)
{
    weft_weave_free(&cloth->weave);
    *cloth = (weft_priced_cloth){0};
}

weft_code weft_priced_cloth_fit(weft_priced_cloth *cloth, weft_dataset *dataset, weft_error *error)
{
    weft_fit_weave_source source;
    weft_fit_weave_report report;
    double began = weft_now_s();
    if (cloth->is_threads)
        return WEFT_OK;
    WEFT_TRY(weft_fit_weave_to_dataset(dataset, &cloth->weave, NULL, &source, &report, error));
    cloth->fit_s = weft_now_s() - began;
    cloth->is_fitted = true;
    return WEFT_OK;
}

weft_code weft_priced_cloth_write(const weft_priced_cloth *cloth, const char *path, weft_error *error)
{
    return weft_weave_write(path, &cloth->weave, NULL, error);
}

weft_code weft_priced_cloth_predictor(const weft_priced_cloth *cloth, const weft_texel_subset *subset,
                                      weft_predictor **predictor, weft_error *error)
{
    if (cloth->is_threads)
        return weft_predictor_of_threads(&subset->layout, &cloth->threads.cloth, predictor, error);
    const weft_weave_layout tiles = weft_weave_lay_out(&cloth->weave, 0, 0);
    const weft_predicted_window *window = cloth->is_fitted ? NULL : &subset->window;
    return weft_predictor_of_weave(&subset->layout, window, &cloth->weave, &tiles, predictor, error);
}

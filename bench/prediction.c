/* Whether what weft compress predicts is what it measures afterwards: `bench_prediction NAME.btf.h5 MODEL...`, a MODEL
 * being layersK, lobesN (with T where the images carry it), errorPERCENT or budgetKB. Prints predicted and measured
 * bytes of the file, metadata and all, and the error on directions that are not fitted. The presets predict the models
 * that they choose in the same way. */
#include "bench/measure.h"
#include "btf/material/held_out.h"
#include "btf/material/metadata.h"
#include "compare/tradeoff/preset.h"
#include "compress/compress.h"
#include "compress/hold_out/hold_out.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const scratch = "prediction.btf.h5";

static void stop_on(weft_code code, const weft_error *error)
{
    bench_stop_on("bench_prediction", code, error);
}

static weft_compress_options options_of(const char *model)
{
    weft_compress_options options = weft_compress_default_options();
    size_t letters = strcspn(model, "0123456789");
    double number = atof(model + letters);
    bool has_components = strncmp(model, "components", letters) == 0;
    options.component_count = has_components ? (int)number : 0;
    options.table = !has_components;
    if (has_components || strncmp(model, "lobes", letters) == 0)
        options.lobe_count = has_components ? 0 : (int)number;
    else if (strncmp(model, "error", letters) == 0)
        options.target_error = number / 100;
    else
        options.budget_bytes = (uint64_t)(1000 * number);
    return options;
}

/* As weft compress makes it. */
static uint64_t make(weft_dataset *dataset, weft_compress_options options, const weft_prediction *prediction,
                     weft_hold_out *held_out)
{
    weft_error error = {0};
    weft_material material;
    uint64_t own, bytes;
    int splits;
    stop_on(weft_hold_out_enough_splits(weft_dataset_get_layout(dataset), &splits, &error), &error);
    stop_on(weft_hold_out_measure(dataset, &options, splits, scratch, NULL, held_out, &error), &error);
    stop_on(weft_hold_out_bytes(held_out, &options.added_bytes, &error), &error);
    stop_on(weft_prediction_stored_bytes(prediction, &own, &error), &error);
    options.added_bytes += own;
    options.heights = !held_out->heights.asked || held_out->heights.used;
    stop_on(weft_compress(dataset, &options, NULL, &material, NULL, &error), &error);
    stop_on(weft_hold_out_store(held_out, &material, &error), &error);
    stop_on(weft_material_put_metadata(&material, "predicted", weft_prediction_to_json(prediction), &error), &error);
    stop_on(weft_material_size(&material, &bytes, &error), &error);
    weft_material_free(&material);
    return bytes;
}

static void compare(weft_dataset *dataset, const char *name)
{
    const weft_preset_wish wish = {.preset = WEFT_PRESET_NONE};
    weft_error error = {0};
    weft_compress_options options = options_of(name);
    weft_prediction prediction;
    weft_hold_out held_out;
    stop_on(weft_preset_predict(dataset, &wish, scratch, NULL, &options, &prediction, &error), &error);
    double bytes = (double)make(dataset, options, &prediction, &held_out);
    double measured = held_out.material.all.relative_rmse;
    printf("%-10s bytes %9.0f -> %9.0f (%+.2f %%), relative RMSE %.4f -> %.4f (%+.1f %%)\n", name, prediction.bytes,
           bytes, 100 * (bytes / prediction.bytes - 1), prediction.error, measured,
           100 * (measured / prediction.error - 1));
    fflush(stdout);
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    weft_dataset *dataset;
    if (argc < 3) {
        fprintf(stderr, "usage: bench_prediction NAME.btf.h5 MODEL...\n");
        return WEFT_BAD_USAGE;
    }
    stop_on(weft_dataset_open(argv[1], &dataset, &error), &error);
    for (int i = 2; i < argc; i++)
        compare(dataset, argv[i]);
    weft_dataset_close(dataset);
    return 0;
}

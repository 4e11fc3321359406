/* Whether what a preset of weft compress predicts is what it measures afterwards: `bench_prediction NAME.btf.h5
 * PRESET...`. Prints predicted and measured bytes of the file, metadata and all, and the error on directions that are
 * not fitted. */
#include "compare/tradeoff/prediction.h"
#include "bench/measure.h"
#include "btf/material/held_out.h"
#include "btf/material/metadata.h"
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

static weft_preset preset_named(const char *name)
{
    for (weft_preset preset = WEFT_PRESET_SMALL; preset < WEFT_PRESET_COUNT; preset++)
        if (strcmp(weft_preset_name(preset), name) == 0)
            return preset;
    fprintf(stderr, "bench_prediction: '%s' is no preset\n", name);
    exit(WEFT_BAD_USAGE);
}

/* As weft compress makes it. */
static uint64_t make(weft_dataset *dataset, weft_compress_options options, const weft_prediction *prediction,
                     weft_hold_out *held_out)
{
    weft_error error = {0};
    weft_material material;
    uint64_t bytes;
    int splits;
    stop_on(weft_hold_out_enough_splits(weft_dataset_get_layout(dataset), &splits, &error), &error);
    stop_on(weft_hold_out_measure(dataset, &options, splits, scratch, NULL, held_out, &error), &error);
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
    const weft_preset_wish wish = {.preset = preset_named(name)};
    weft_error error = {0};
    weft_compress_options options = weft_compress_default_options();
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
        fprintf(stderr, "usage: bench_prediction NAME.btf.h5 PRESET...\n");
        return WEFT_BAD_USAGE;
    }
    stop_on(weft_dataset_open(argv[1], &dataset, &error), &error);
    for (int i = 2; i < argc; i++)
        compare(dataset, argv[i]);
    weft_dataset_close(dataset);
    return 0;
}

/* Photographs in files of their own are decoded and put into the dataset. */
#include "import/run.h"

#include <stdlib.h>

static weft_code put_photograph(const weft_import_run *run, int index, weft_decoded *decoded, weft_error *error)
{
    const weft_photograph *photograph = &run->collection->photograph[index];
    size_t texels = (size_t)run->decoding.width * (size_t)run->decoding.height;
    weft_half *samples = malloc(3 * texels * sizeof *samples);
    uint8_t *mask = malloc(texels);
    char *path = weft_join_path(run->source, photograph->name);
    weft_code code = WEFT_OK;
    if (!samples || !mask || !path)
        code = weft_fail_memory(error, "photograph", 3 * texels * sizeof *samples);
    if (code == WEFT_OK)
        code = weft_photograph_decode(&run->decoding, path, photograph, samples, mask, decoded, error);
    if (code == WEFT_OK)
        code = weft_dataset_writer_put_image(run->writer, index, samples, mask, error);
    free(samples);
    free(mask);
    free(path);
    return code;
}

void weft_import_photographs(weft_import_run *run)
{
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < run->collection->count; i++) {
        if (weft_import_has_stopped(run))
            continue;
        weft_error error = {0};
        weft_decoded decoded = {0};
        weft_code code = WEFT_OK;
        if (!run->collection->photograph[i].missing)
            code = put_photograph(run, i, &decoded, &error);
        weft_import_count(run, i, code, &error, &decoded);
    }
}

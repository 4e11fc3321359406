#include "import/run.h"

#include <stdlib.h>

/* Names a missing or skipped photograph; the user is told of the first ten. */
static weft_code note_photograph(weft_import_run *run, int count, const char *what, const char *name, const char *why)
{
    if (count <= 10)
        return weft_lines_add(&run->report->notes, &run->error, "%s '%s'%s%s", what, name, *why ? ": " : "", why);
    return WEFT_OK;
}

/* What is wrong with one photograph: it is missing, damaged, of a kind that is not read, or unlike the others. A
 * failure of the memory or the disk is never skipped. */
static bool may_be_skipped(weft_code code)
{
    return weft_class_of(code) == WEFT_BAD_INPUT;
}

/* Called in the critical section. */
static void count_image(weft_import_run *run, int index, weft_code code, const weft_error *error,
                        const weft_decoded *decoded)
{
    const weft_photograph *photograph = &run->collection->photograph[index];
    weft_import_report *report = run->report;
    if (photograph->missing) {
        run->code = note_photograph(run, ++report->missing_count, "missing, masked:", photograph->name, "");
    } else if (may_be_skipped(code) && run->options->skip_bad) {
        run->code = note_photograph(run, ++report->skipped_count, "skipped, masked:", photograph->name, error->message);
    } else if (code != WEFT_OK) {
        run->code = code;
        run->error = *error;
    } else {
        weft_colour_messages_add(&run->messages, index, photograph->name, decoded);
        run->saturated += decoded->saturated;
        run->outside += decoded->outside;
        run->light[index] = decoded->light;
        run->lacking += decoded->missing;
        if (decoded->missing > 0 && (run->partial++ == 0 || index < run->first_partial))
            run->first_partial = index;
        run->sum += decoded->sum;
        run->samples += (size_t)run->decoding.width * (size_t)run->decoding.height;
    }
    weft_progress_report(run->progress, "reading photographs", ++run->done, run->collection->count);
}

bool weft_import_has_stopped(const weft_import_run *run)
{
    weft_code stopped;
#pragma omp atomic read
    stopped = run->code;
    return stopped != WEFT_OK;
}

void weft_import_count(weft_import_run *run, int index, weft_code code, const weft_error *error,
                       const weft_decoded *decoded)
{
#pragma omp critical(weft_import)
    if (run->code == WEFT_OK)
        count_image(run, index, code, error, decoded);
}

/* The first photograph has been read already. */
static weft_code take_photograph(weft_import_run *run, int index, const char *path, weft_shown_photograph *shown,
                                 weft_error *error)
{
    if (index != run->first_index || !run->first.image.pixels)
        return weft_shown_photograph_read(path, shown, error);
    *shown = run->first;
    run->first.image.pixels = NULL;
    return WEFT_OK;
}

static weft_code put_photograph(weft_import_run *run, int index, weft_decoded *decoded, weft_error *error)
{
    const weft_photograph *photograph = &run->collection->photograph[index];
    size_t texels = (size_t)run->decoding.width * (size_t)run->decoding.height;
    weft_half *samples = malloc(3 * texels * sizeof *samples);
    uint8_t *mask = malloc(texels);
    char *path = weft_join_path(run->source, photograph->name);
    weft_shown_photograph shown = {.image = {0}};
    weft_code code = WEFT_OK;
    if (!samples || !mask || !path)
        code = weft_fail_memory(error, "photograph", 3 * texels * sizeof *samples);
    if (code == WEFT_OK)
        code = take_photograph(run, index, path, &shown, error);
    if (code == WEFT_OK)
        code = weft_photograph_decode(&run->decoding, path, photograph, &shown, samples, mask, decoded, error);
    if (code == WEFT_OK)
        code = weft_dataset_writer_put_image(run->writer, index, samples, mask, error);
    for (size_t i = 0; code == WEFT_OK && i < texels; i++) {
        if (mask[i])
            continue;
#pragma omp atomic write
        run->seen[i] = 1;
    }
    weft_image_free(&shown.image);
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

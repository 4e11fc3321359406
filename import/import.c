#include "import/import.h"

#include "base/picture/image.h"
#include "import/colour_remarks.h"
#include "import/dataset_description.h"
#include "import/decode.h"
#include "import/readers.h"

#include <math.h>
#include <stdlib.h>

/* One run of weft_import: what the parallel workers share. */
typedef struct import_run {
    const char *source;
    const weft_import_options *options;
    const weft_progress *progress;
    weft_import_report *report;
    const weft_collection *collection;
    weft_decoding decoding;
    weft_dataset_writer *writer;
    weft_code code; /* of the first failure; guarded, with everything below, by the critical section */
    weft_error error;
    long done;
    size_t saturated, outside, samples;
    double sum;
    weft_colour_remarks remarks;
} import_run;

weft_import_options weft_import_defaults(void)
{
    return (weft_import_options){.saturated_at = 250.0 / 255, .white = 1, .values = WEFT_REFLECTANCE_COSINE};
}

void weft_import_report_free(weft_import_report *report)
{
    weft_lines_free(&report->notes);
}

/* The size that all photographs must have: that of the first one that can be read. */
static weft_code probe_size(const weft_collection *collection, const char *folder, bool skip_bad,
                            weft_decoding *decoding, weft_error *error)
{
    weft_code code = WEFT_OK;
    for (int i = 0; i < collection->count && decoding->source_width == 0; i++) {
        if (collection->photograph[i].missing)
            continue;
        char *path = weft_join_path(folder, collection->photograph[i].name);
        weft_image image;
        code = path ? weft_image_read_shown(path, &image, NULL, error) : weft_fail_memory(error, "path", 0);
        free(path);
        if (code == WEFT_OK) {
            decoding->source_width = image.width;
            decoding->source_height = image.height;
            weft_image_free(&image);
        } else if (!skip_bad) {
            return code;
        }
    }
    return code;
}

static weft_code choose_size(const weft_import_options *options, weft_decoding *decoding, weft_error *error)
{
    int width = decoding->source_width, height = decoding->source_height;
    decoding->width = options->width ? options->width : width;
    if (decoding->width < 1 || decoding->width > width)
        return weft_fail(error, WEFT_BAD_USAGE, "%d texels asked for, but the photographs are %d pixels wide",
                         decoding->width, width);
    if ((long)height * decoding->width % width != 0)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "photographs of %d x %d pixels cannot become %d texels wide: that is %g high", width, height,
                         decoding->width, (double)height * decoding->width / width);
    decoding->height = (int)((long)height * decoding->width / width);
    return WEFT_OK;
}

/* Names a missing or skipped photograph; the user is told of the first ten. */
static weft_code note_photograph(import_run *run, int count, const char *what, const char *name, const char *why)
{
    if (count <= 10)
        return weft_lines_add(&run->report->notes, &run->error, "%s '%s'%s%s", what, name, *why ? ": " : "", why);
    return WEFT_OK;
}

/* Called in the critical section. */
static void count_photograph(import_run *run, int index, weft_code code, const weft_error *error,
                             const weft_decoded *decoded)
{
    const weft_photograph *photograph = &run->collection->photograph[index];
    weft_import_report *report = run->report;
    if (photograph->missing) {
        run->code = note_photograph(run, ++report->missing_count, "missing, masked:", photograph->name, "");
    } else if (code == WEFT_BAD_INPUT && run->options->skip_bad) {
        run->code = note_photograph(run, ++report->skipped_count, "skipped, masked:", photograph->name, error->message);
    } else if (code != WEFT_OK) {
        run->code = code;
        run->error = *error;
    } else {
        weft_colour_remarks_add(&run->remarks, index, photograph->name, decoded);
        run->saturated += decoded->saturated;
        run->outside += decoded->outside;
        run->sum += decoded->sum;
        run->samples += (size_t)run->decoding.width * (size_t)run->decoding.height;
    }
    weft_progress_report(run->progress, "reading photographs", ++run->done, run->collection->count);
}

static weft_code read_photograph(const import_run *run, int index, weft_decoded *decoded, weft_error *error)
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

static weft_code read_photographs(import_run *run)
{
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < run->collection->count; i++) {
        weft_code stopped;
#pragma omp atomic read
        stopped = run->code;
        if (stopped != WEFT_OK)
            continue;
        weft_error error = {0};
        weft_decoded decoded = {0};
        weft_code code = WEFT_OK;
        if (!run->collection->photograph[i].missing)
            code = read_photograph(run, i, &decoded, &error);
#pragma omp critical
        if (run->code == WEFT_OK)
            count_photograph(run, i, code, &error, &decoded);
    }
    if (run->code == WEFT_OK && run->samples == 0)
        return weft_fail(&run->error, WEFT_BAD_INPUT, "'%s': no photograph could be used", run->source);
    return run->code;
}

/* Only highlights are above 1, so a mean is well below it. */
static weft_code note_scale(weft_import_report *report, weft_error *error)
{
    const double implausible = 2;
    if (report->mean < implausible)
        return WEFT_OK;
    return weft_lines_add(&report->notes, error,
                          "the samples are %.3g in the mean, but a perfect white diffuser is 1: if it is 100 in the "
                          "photographs say --white 100",
                          report->mean);
}

static weft_code finish(import_run *run, weft_error *error)
{
    weft_import_report *report = run->report;
    report->saturated_fraction = (double)run->saturated / (double)run->samples;
    report->outside_fraction = (double)run->outside / (double)run->samples;
    report->mean = run->sum / (3 * fmax(1, (double)(run->samples - run->saturated)));
    WEFT_TRY(note_scale(report, error));
    WEFT_TRY(weft_colour_remarks_note(&run->remarks, run->collection, run->options->colours, &report->notes, error));
    char *provenance = weft_import_provenance(run->source, run->collection, run->options, &run->decoding, report);
    if (!provenance)
        return weft_fail_memory(error, "provenance", 0);
    weft_progress_report(run->progress, "writing the dataset", 0, 1);
    weft_code code = weft_dataset_writer_finish(run->writer, provenance, error);
    run->writer = NULL;
    free(provenance);
    if (code == WEFT_OK)
        weft_progress_report(run->progress, "writing the dataset", 1, 1);
    return code;
}

static weft_code write_dataset(import_run *run, const char *output, weft_error *error)
{
    weft_dataset_layout layout = {0};
    WEFT_TRY(weft_import_layout(run->collection, run->options, &run->decoding, &layout, &run->report->notes, error));
    *run->report = (weft_import_report){.kind = run->collection->kind,
                                        .width = layout.width,
                                        .height = layout.height,
                                        .image_count = layout.image_count,
                                        .view_count = layout.view_count,
                                        .notes = run->report->notes};
    weft_code code = weft_dataset_writer_create(output, &layout, &run->writer, error);
    weft_dataset_layout_free(&layout);
    if (code == WEFT_OK) {
        code = read_photographs(run);
        if (code != WEFT_OK && error)
            *error = run->error;
    }
    if (code == WEFT_OK)
        code = finish(run, error);
    weft_dataset_writer_abandon(run->writer);
    return code;
}

static weft_code import_collection(import_run *run, const char *output, weft_error *error)
{
    weft_decoding *decoding = &run->decoding;
    decoding->saturated_at = run->options->saturated_at;
    decoding->colours = run->options->colours;
    decoding->white = run->options->white;
    decoding->linear = run->options->linear;
    decoding->distance = run->collection->distance;
    WEFT_TRY(probe_size(run->collection, run->source, run->options->skip_bad, decoding, error));
    WEFT_TRY(choose_size(run->options, decoding, error));
    decoding->pixel_pitch_mm = run->collection->side_mm / decoding->source_width;
    return write_dataset(run, output, error);
}

weft_code weft_import(const char *source, const char *output, const weft_import_options *options,
                      const weft_progress *progress, weft_import_report *report, weft_error *error)
{
    *report = (weft_import_report){0};
    weft_collection collection;
    WEFT_TRY(weft_collection_open(source, options->lights, options->skip_bad, &collection, error));
    import_run run = {
        .source = source, .options = options, .progress = progress, .report = report, .collection = &collection};
    report->notes = collection.notes;
    collection.notes = (weft_lines){0};
    weft_code code = import_collection(&run, output, error);
    weft_collection_free(&collection);
    if (code != WEFT_OK)
        weft_import_report_free(report);
    return code;
}

#include "weft/import.h"

#include "base/progress.h"
#include "btf/file_kind.h"
#include "import/readers.h"
#include "import/reduce.h"
#include "import/run.h"

#include <math.h>
#include <stdlib.h>

weft_import_options weft_import_defaults(void)
{
    return (weft_import_options){.saturated_at = 250.0 / 255, .white = 1, .values = WEFT_VALUES_OF_SOURCE};
}

void weft_import_report_free(weft_import_report *report)
{
    weft_lines_free(&report->notes);
}

/* The first photograph that can be read is kept: all must have its size. */
static weft_code read_first(weft_import_run *run, weft_error *error)
{
    const weft_collection *collection = run->collection;
    weft_code code = WEFT_OK;
    for (int i = 0; i < collection->count && run->decoding.source_width == 0; i++) {
        if (collection->photograph[i].missing)
            continue;
        char *path = weft_join_path(run->source, collection->photograph[i].name);
        code = path ? weft_shown_photograph_read(path, &run->first, error) : weft_fail_memory(error, "path", 0);
        free(path);
        if (code == WEFT_OK) {
            run->decoding.source_width = run->first.image.width;
            run->decoding.source_height = run->first.image.height;
            run->first_index = i;
        } else if (!run->options->skip_bad) {
            return code;
        }
    }
    return code;
}

static weft_code put_images(weft_import_run *run, const weft_bonn_file *bonn)
{
    if (bonn)
        weft_import_bonn_images(run, bonn);
    else
        weft_import_photographs(run);
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
                          "the mean sample is %.3g, but a perfect white diffuser is 1; if white is 100 in the "
                          "photographs, pass --white 100",
                          report->mean);
}

static weft_code note_partial(weft_import_run *run, weft_error *error)
{
    if (run->partial == 0)
        return WEFT_OK;
    return weft_lines_add(&run->report->notes, error,
                          "'%s' does not hold all pixels that it shows (%d of %d photographs): %.3g %% of all samples "
                          "are masked as missing",
                          run->collection->photograph[run->first_partial].name, run->partial, run->messages.read,
                          100 * (double)run->lacking / (double)run->samples);
}

/* A texel without a sample has no colour, and is black in a picture. */
static weft_code note_unseen(weft_import_run *run, weft_error *error)
{
    long texels = (long)run->decoding.width * run->decoding.height, unseen = 0;
    for (long i = 0; i < texels; i++)
        unseen += !run->seen[i];
    if (unseen == 0)
        return WEFT_OK;
    return weft_lines_add(&run->report->notes, error,
                          "%ld of %ld texels are masked in every photograph, and will be black%s", unseen, texels,
                          run->saturated > 0 ? ": those that are clipped keep their values with --saturated 256" : "");
}

static weft_code finish(weft_import_run *run, const weft_bonn_file *bonn, weft_error *error)
{
    weft_import_report *report = run->report;
    report->saturated_fraction = (double)run->saturated / (double)run->samples;
    report->outside_fraction = (double)run->outside / (double)run->samples;
    report->mean = run->sum / (3 * fmax(1, (double)(run->samples - run->saturated - run->lacking)));
    WEFT_TRY(note_scale(report, error));
    WEFT_TRY(note_partial(run, error));
    if (!bonn)
        WEFT_TRY(note_unseen(run, error));
    WEFT_TRY(weft_check_plausibility(run->collection, run->values, run->light, &report->notes, error));
    WEFT_TRY(weft_colour_messages_note(&run->messages, run->collection, run->options->colours, &report->notes, error));
    char *provenance = weft_import_provenance(run->source, run->collection, bonn, run->options, &run->decoding, report);
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

static weft_code write_dataset(weft_import_run *run, const weft_bonn_file *bonn, const char *output, weft_error *error)
{
    weft_dataset_layout layout = {0};
    WEFT_TRY(weft_import_layout(run->collection, run->options, &run->decoding, &layout, &run->report->notes, error));
    *run->report = (weft_import_report){.kind = run->collection->kind,
                                        .width = layout.width,
                                        .height = layout.height,
                                        .image_count = layout.image_count,
                                        .view_count = layout.view_count,
                                        .notes = run->report->notes};
    run->values = layout.values;
    weft_code code = weft_dataset_writer_create(output, &layout, &run->writer, error);
    weft_dataset_layout_free(&layout);
    size_t count = (size_t)run->collection->count;
    size_t texels = (size_t)run->decoding.width * (size_t)run->decoding.height;
    if (code == WEFT_OK && !(run->light = calloc(count, sizeof *run->light)))
        code = weft_fail_memory(error, "light", count * sizeof *run->light);
    if (code == WEFT_OK && !(run->seen = calloc(texels, sizeof *run->seen)))
        code = weft_fail_memory(error, "texels", texels);
    if (code == WEFT_OK) {
        code = put_images(run, bonn);
        if (code != WEFT_OK && error)
            *error = run->error;
    }
    if (code == WEFT_OK && bonn)
        code = weft_import_bonn_frames(run, bonn, error);
    if (code == WEFT_OK)
        code = finish(run, bonn, error);
    weft_dataset_writer_abandon(run->writer);
    return code;
}

/* The size of what is read, and of what is written. */
static weft_code choose_size(weft_import_run *run, const weft_bonn_file *bonn, weft_error *error)
{
    weft_decoding *decoding = &run->decoding;
    if (bonn) {
        decoding->source_width = bonn->width;
        decoding->source_height = bonn->height;
    } else {
        WEFT_TRY(read_first(run, error));
    }
    WEFT_TRY(weft_reduced_size(decoding->source_width, decoding->source_height, run->options->width, &decoding->width,
                               &decoding->height, error));
    double rows = decoding->source_height - (double)decoding->height * decoding->source_width / decoding->width;
    return rows < 1e-9 ? WEFT_OK
                       : weft_lines_add(&run->report->notes, error,
                                        "%d x %d texels: of the %d rows of pixels %.2f are left out above, and as many "
                                        "below, because texels are square",
                                        decoding->width, decoding->height, decoding->source_height, rows / 2);
}

static weft_code import_collection(weft_import_run *run, const weft_bonn_file *bonn, const char *output,
                                   weft_error *error)
{
    weft_decoding *decoding = &run->decoding;
    decoding->options = run->options;
    decoding->distance = run->collection->distance;
    WEFT_TRY(choose_size(run, bonn, error));
    decoding->pixel_pitch_mm = run->collection->side_mm / decoding->source_width;
    return write_dataset(run, bonn, output, error);
}

/* The collection in a folder, or in a file of Bonn (else NULL), which is then open. */
static weft_code open_source(const char *source, const weft_import_options *options, weft_collection *collection,
                             weft_bonn_file **bonn, weft_error *error)
{
    if (!weft_file_is_bonn(source)) {
        *bonn = NULL;
        return weft_collection_open(source, options->lights, options->skip_bad, collection, error);
    }
    if (options->lights)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--lights applies to a folder of photographs; '%s' holds its own lights", source);
    if (options->colours != WEFT_IMPORT_AS_SAID)
        return weft_fail(error, WEFT_BAD_USAGE, "--colours applies to photographs; '%s' holds its own colours", source);
    *collection = (weft_collection){.leaves_out_doubles = options->skip_bad};
    WEFT_TRY(weft_bonn_file_open(source, *bonn, error));
    weft_code code = weft_collection_of_bonn(source, *bonn, collection, error);
    if (code == WEFT_OK)
        return WEFT_OK;
    weft_collection_free(collection);
    weft_bonn_file_close(*bonn);
    return code;
}

weft_code weft_import(const char *source, const char *output, const weft_import_options *options,
                      const weft_progress *progress, weft_import_report *report, weft_error *error)
{
    *report = (weft_import_report){0};
    weft_collection collection;
    weft_bonn_file file = {0}, *bonn = &file;
    WEFT_TRY(open_source(source, options, &collection, &bonn, error));
    weft_import_run run = {
        .source = source, .options = options, .progress = progress, .report = report, .collection = &collection};
    report->notes = collection.notes;
    collection.notes = (weft_lines){0};
    weft_code code = import_collection(&run, bonn, output, error);
    weft_image_free(&run.first.image);
    free(run.light);
    free(run.seen);
    weft_collection_free(&collection);
    weft_bonn_file_close(&file);
    if (code != WEFT_OK)
        weft_import_report_free(report);
    return code;
}

/* A file of Bonn as a collection of photographs, and its images put into the dataset. */
#include "import/bonn/images.h"
#include "import/far_photograph.h"
#include "import/readers.h"
#include "import/reduce.h"
#include "import/run.h"

#include "base/integers.h"

#include <stdio.h>
#include <stdlib.h>

/* ---- The collection ---- */

/* Width of a texel in mm; 0 where the file says nothing that can be one. */
static double pitch_of(const weft_bonn_file *file)
{
    double pitch_mm = 1 / file->pixels_per_mm;
    return pitch_mm >= 1e-6 && pitch_mm <= 1e6 ? pitch_mm : 0;
}

static weft_code note_scale(const weft_bonn_file *file, weft_collection *collection, weft_error *error)
{
    const float *scale = file->rgb_scale;
    if (scale[0] == 1 && scale[1] == 1 && scale[2] == 1)
        return WEFT_OK;
    return weft_lines_add(&collection->notes, error,
                          "the file gives scales of red, green and blue, %g %g %g: not applied", (double)scale[0],
                          (double)scale[1], (double)scale[2]);
}

weft_code weft_collection_of_bonn(const char *path, const weft_bonn_file *file, weft_collection *collection,
                                  weft_error *error)
{
    collection->kind = file->kind;
    collection->distance = WEFT_FAR;
    collection->values = file->has_cosine ? WEFT_REFLECTANCE_COSINE : WEFT_REFLECTANCE;
    collection->side_mm = pitch_of(file) * file->width;
    for (int i = 0; i < file->notes.count; i++)
        WEFT_TRY(weft_lines_add(&collection->notes, error, "%s", file->notes.line[i]));
    WEFT_TRY(note_scale(file, collection, error));
    for (int view = 0, number = 0; view < file->view_count; view++) {
        for (int light = 0; light < file->light_count; light++, number++) {
            char name[64];
            snprintf(name, sizeof name, "view %d, light %d", view, light);
            weft_photograph photograph = {.number = number, .light = file->light[number], .view = file->view[view]};
            WEFT_TRY(weft_collection_add(collection, name, photograph, error));
        }
    }
    return weft_collection_sort_far(collection, path, error);
}

/* ---- The images ---- */

static weft_code put_image(const weft_import_run *run, int index, weft_image *image, weft_half *samples,
                           weft_error *error)
{
    size_t at, width = (size_t)image->width;
    weft_divide_by_white(run->options->white, image);
    if (weft_find_unstorable(image, &at))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': value %g at texel (%zu, %zu) of %s", run->source,
                         (double)image->pixels[at], at / 3 % width, at / 3 / width,
                         run->collection->photograph[index].name);
    WEFT_TRY(weft_reduce(image, NULL, run->decoding.width, run->decoding.height, samples, NULL, error));
    return weft_dataset_writer_put_image(run->writer, index, samples, NULL, error);
}

/* Colours and masks of such a file tell nothing: they are known, and there are none. */
static const weft_decoded nothing_to_tell = {.claim = WEFT_CLAIM_CLEAR};

/* Images first .. first + count of the collection, into `image` [count] and, reduced, into `samples`. */
static void put_group(weft_import_run *run, const weft_bonn_file *file, int first, int count, weft_image *image,
                      weft_half *samples)
{
    int number[WEFT_BONN_GROUP];
    weft_error error = {0};
    for (int i = 0; i < count; i++)
        number[i] = run->collection->photograph[first + i].number;
    weft_code made = weft_bonn_images_make(file, number, count, image, &error);
    for (int i = 0; i < count && !weft_import_has_stopped(run); i++) {
        weft_code code = made == WEFT_OK ? put_image(run, first + i, &image[i], samples, &error) : made;
        weft_import_count(run, first + i, code, &error, &nothing_to_tell);
    }
}

static weft_code create_images(const weft_import_run *run, int count, weft_image *image, weft_half **samples,
                               weft_error *error)
{
    size_t texels = (size_t)run->decoding.width * (size_t)run->decoding.height;
    *samples = malloc(3 * texels * sizeof **samples);
    if (!*samples)
        return weft_fail_memory(error, "image", 3 * texels * sizeof **samples);
    for (int i = 0; i < count; i++)
        WEFT_TRY(weft_image_create(run->decoding.source_width, run->decoding.source_height, &image[i], error));
    return WEFT_OK;
}

void weft_import_bonn_images(weft_import_run *run, const weft_bonn_file *file)
{
    int size = weft_bonn_group_size(file), total = run->collection->count;
#pragma omp parallel
    {
        weft_image image[WEFT_BONN_GROUP] = {{0}};
        weft_half *samples = NULL;
        weft_error error = {0};
        weft_code code = create_images(run, size, image, &samples, &error);
#pragma omp for schedule(dynamic)
        for (int first = 0; first < total; first += size) {
            if (code != WEFT_OK)
                weft_import_count(run, first, code, &error, &nothing_to_tell);
            else if (!weft_import_has_stopped(run))
                put_group(run, file, first, weft_smaller(size, total - first), image, samples);
        }
        for (int i = 0; i < size; i++)
            weft_image_free(&image[i]);
        free(samples);
    }
}

/* ---- The frames ---- */

weft_code weft_import_bonn_frames(weft_import_run *run, const weft_bonn_file *file, weft_error *error)
{
    size_t bytes = 6 * (size_t)run->decoding.width * (size_t)run->decoding.height * sizeof(float);
    if (!file->frame)
        return WEFT_OK;
    float *frames = malloc(bytes);
    if (!frames)
        return weft_fail_memory(error, "frames", bytes);
    weft_code code =
        weft_bonn_frames_average(file, run->decoding.width, run->decoding.height, frames)
            ? weft_dataset_writer_put_frames(run->writer, frames, error)
            : weft_lines_add(&run->report->notes, error, "left out: frames of the texels, some of which are none");
    free(frames);
    return code;
}

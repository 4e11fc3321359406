#include "import/run.h"

#include "base/text/json_text.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* ---- Layout ---- */

static const double assumed_pitch_mm = 1;

static int by_view(const void *a, const void *b)
{
    const weft_photograph *p = *(const weft_photograph *const *)a, *q = *(const weft_photograph *const *)b;
    const weft_real difference[3] = {p->view.x - q->view.x, p->view.y - q->view.y, p->view.z - q->view.z};
    for (int i = 0; i < 3; i++) {
        if (difference[i] != 0)
            return difference[i] < 0 ? -1 : 1;
    }
    return p < q ? -1 : p > q;
}

static bool same_view(const weft_photograph *p, const weft_photograph *q)
{
    return p->view.x == q->view.x && p->view.y == q->view.y && p->view.z == q->view.z;
}

/* Numbers the distinct views in the order in which they first occur; among equal views the pointers order, so the head
 * is the first. */
static int number_views(const weft_photograph **sorted, const weft_photograph *photograph, int count,
                        int32_t *view_of_image)
{
    for (int i = 0; i < count; i++)
        sorted[i] = &photograph[i];
    qsort(sorted, (size_t)count, sizeof *sorted, by_view);
    for (int i = 0, head = 0; i < count; i++) {
        if (!same_view(sorted[i], sorted[head]))
            head = i;
        view_of_image[sorted[i] - photograph] = (int32_t)(sorted[head] - photograph);
    }
    int views = 0;
    for (int i = 0; i < count; i++)
        view_of_image[i] = view_of_image[i] == i ? views++ : view_of_image[view_of_image[i]];
    return views;
}

static void copy_directions(const weft_collection *collection, const int32_t *view_of_image,
                            weft_dataset_layout *layout)
{
    for (int i = 0; i < collection->count; i++) {
        layout->light[i] = collection->photograph[i].light;
        layout->view[view_of_image[i]] = collection->photograph[i].view;
        layout->view_of_image[i] = view_of_image[i];
    }
}

static weft_code choose_pitch(const weft_collection *collection, const weft_import_options *options,
                              weft_dataset_layout *layout, weft_lines *notes, weft_error *error)
{
    /* The places of near lights are told in the length of the side. */
    layout->texel_pitch_mm = collection->distance == WEFT_FAR ? options->texel_pitch_mm : 0;
    if (layout->texel_pitch_mm == 0 && collection->side_mm > 0)
        layout->texel_pitch_mm = collection->side_mm / layout->width;
    if (layout->texel_pitch_mm > 0)
        return WEFT_OK;
    layout->texel_pitch_mm = assumed_pitch_mm;
    return weft_lines_add(notes, error, "the photographs do not say how large a texel is: %g mm assumed",
                          assumed_pitch_mm);
}

static weft_values choose_values(const weft_collection *collection, const weft_import_options *options)
{
    if (collection->distance == WEFT_NEAR)
        return WEFT_REFLECTANCE_COSINE;
    return options->values == WEFT_VALUES_OF_SOURCE ? collection->values : (weft_values)options->values;
}

weft_code weft_import_layout(const weft_collection *collection, const weft_import_options *options,
                             const weft_decoding *decoding, weft_dataset_layout *layout, weft_lines *notes,
                             weft_error *error)
{
    size_t count = (size_t)collection->count;
    int32_t *view_of_image = malloc(count * sizeof *view_of_image);
    const weft_photograph **sorted = malloc(count * sizeof *sorted);
    *layout = (weft_dataset_layout){.width = decoding->width,
                                    .height = decoding->height,
                                    .image_count = collection->count,
                                    .distance = collection->distance,
                                    .values = choose_values(collection, options)};
    weft_code code = WEFT_OK;
    if (!view_of_image || !sorted)
        code = weft_fail_memory(error, "views", count * sizeof *sorted);
    if (code == WEFT_OK) {
        layout->view_count = number_views(sorted, collection->photograph, collection->count, view_of_image);
        code = weft_dataset_layout_allocate(layout, error);
    }
    if (code == WEFT_OK) {
        copy_directions(collection, view_of_image, layout);
        code = choose_pitch(collection, options, layout, notes, error);
        if (code != WEFT_OK)
            weft_dataset_layout_free(layout);
    }
    free(view_of_image);
    free(sorted);
    return code;
}

/* ---- Provenance ---- */

/* The last part of a path: the rest is about the machine, not about the material. */
static json_t *folder_name(const char *source)
{
    size_t length = strlen(source);
    while (length > 1 && source[length - 1] == '/')
        length--;
    size_t begin = length;
    while (begin > 0 && source[begin - 1] != '/')
        begin--;
    return weft_json_text(source + begin, length - begin);
}

static json_t *file_name(const weft_photograph *photograph)
{
    return photograph->missing ? json_null() : weft_json_text(photograph->name, strlen(photograph->name));
}

static json_t *photograph_names(const weft_collection *collection)
{
    json_t *names = json_array();
    for (int i = 0; i < collection->count; i++)
        weft_json_append(&names, file_name(&collection->photograph[i]));
    return names;
}

static json_t *words_of(const char *words)
{
    return weft_json_text(words, strlen(words));
}

/* What a file of Bonn says of itself, in the place of the names of photographs. */
static void put_bonn(json_t **root, const weft_bonn_file *file)
{
    json_t *scale = json_array(), *components = json_array();
    for (int c = 0; c < WEFT_BONN_CHANNELS; c++) {
        weft_json_append(&scale, weft_json_number((double)file->rgb_scale[c]));
        weft_json_append(&components, json_integer(file->matrices.channel[c].component_count));
    }
    weft_json_put(root, "setup", words_of(file->setup));
    weft_json_put(root, "sensor", words_of(file->sensor));
    weft_json_put(root, "lamp", words_of(file->lamp));
    weft_json_put(root, "rgb_scale", scale);
    weft_json_put(root, "colour_model", json_integer(file->colour.model));
    weft_json_put(root, "components", components);
}

char *weft_import_provenance(const char *source, const weft_collection *collection, const weft_bonn_file *bonn,
                             const weft_import_options *options, const weft_decoding *decoding,
                             const weft_import_report *report)
{
    static const char *const colours[] = {"file", "sRGB", "gamma 2.2", "Adobe RGB", "Display P3", "CIE XYZ"};
    json_t *root =
        json_pack("{s:s, s:o, s:s, s:[ii], s:s, s:f, s:f, s:i, s:i, s:f}", "program", "weft import " WEFT_VERSION,
                  "source", folder_name(source), "kind", collection->kind, "photograph_size", decoding->source_width,
                  decoding->source_height, "colours", colours[options->colours], "white", options->white,
                  "saturated_at", options->saturated_at, "missing", report->missing_count, "skipped",
                  report->skipped_count, "saturated_fraction", report->saturated_fraction);
    if (bonn)
        put_bonn(&root, bonn);
    else
        weft_json_put(&root, "photographs", photograph_names(collection));
    char *text = root ? json_dumps(root, JSON_COMPACT) : NULL;
    json_decref(root);
    return text;
}

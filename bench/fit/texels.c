#include "bench/fit/texels.h"

#include "tests/support/random_starts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NOISE 0.01

static weft_code allocate(texel_source *source, weft_error *error)
{
    size_t images = (size_t)source->layout.image_count;
    source->sum = calloc(3 * images, sizeof *source->sum);
    source->count = calloc(images, sizeof *source->count);
    source->half = calloc(3 * images, sizeof *source->half);
    source->mask = calloc(images, sizeof *source->mask);
    if (!source->sum || !source->count || !source->half || !source->mask)
        return weft_fail_memory(error, "samples of a texel", 32 * images);
    WEFT_TRY(weft_bundle_create(&source->layout, NULL, &source->bundle, error));
    return weft_samples_create(&source->bundle, &source->samples, error);
}

weft_code texel_source_invent(synthetic_kind kind, texel_source *source, weft_error *error)
{
    static const char *const name[SYNTHETIC_KINDS] = {"Lafortune x T", "two Ward lobes", "crossed yarns"};
    *source = (texel_source){.name = name[kind], .kind = kind, .noise = NOISE};
    WEFT_TRY(synthetic_layout(1, 1, &source->layout, error));
    return allocate(source, error);
}

weft_code texel_source_truths(int view_count, int light_count, int first_seed, texel_source *source, weft_error *error)
{
    *source = (texel_source){.name = "random truths", .is_random = true, .first_seed = first_seed, .noise = NOISE};
    WEFT_TRY(random_truth_layout(view_count, light_count, &source->layout, error));
    return allocate(source, error);
}

weft_code texel_source_open(const char *path, texel_source *source, weft_error *error)
{
    const char *slash = strrchr(path, '/');
    *source = (texel_source){.name = slash ? slash + 1 : path};
    WEFT_TRY(weft_dataset_open(path, &source->dataset, error));
    source->layout = *weft_dataset_get_layout(source->dataset);
    return allocate(source, error);
}

void texel_source_free(texel_source *source)
{
    weft_samples_free(&source->samples);
    weft_bundle_free(&source->bundle);
    free(source->sum);
    free(source->count);
    free(source->half);
    free(source->mask);
    if (source->dataset)
        weft_dataset_close(source->dataset);
    else
        weft_dataset_layout_free(&source->layout);
    *source = (texel_source){0};
}

static void gather(texel_source *source)
{
    weft_samples_gather(&source->bundle, source->layout.values, source->sum, source->count, 1, &source->samples);
}

static weft_code read_texel(texel_source *source, int x, int y, weft_error *error)
{
    WEFT_TRY(weft_dataset_read_block(source->dataset, x, y, 1, 1, source->half, source->mask, error));
    for (int i = 0; i < source->layout.image_count; i++) {
        source->count[i] = source->mask[i] ? 0 : 1;
        for (int k = 0; k < 3; k++)
            source->sum[3 * i + k] = weft_float_of_half(source->half[3 * i + k]);
    }
    source->x = x;
    source->y = y;
    double x_mm, y_mm;
    weft_bundle_place(&source->layout, x, y, x + 1, y + 1, &x_mm, &y_mm);
    if (source->layout.distance == WEFT_NEAR)
        weft_bundle_aim(&source->bundle, &source->layout, x_mm, y_mm);
    return WEFT_OK;
}

weft_code texel_source_load(texel_source *source, int index, int total, bool neighbour, weft_error *error)
{
    const weft_dataset_layout *layout = &source->layout;
    if (source->dataset) {
        int64_t place = (int64_t)index * layout->width * layout->height / total;
        int x = (int)(place % layout->width), y = (int)(place / layout->width);
        if (neighbour && layout->width > 1)
            x += x > 0 ? -1 : 1;
        WEFT_TRY(read_texel(source, x, y, error));
    } else {
        /* A material of its own for every texel; seeds that differ in the last bit are neighbours. */
        uint64_t seed = (uint64_t)source->first_seed + ((uint64_t)(64 * index + index % 64) ^ neighbour);
        if (source->is_random)
            random_truth_samples(layout, seed, source->noise, source->sum);
        else
            synthetic_texel(layout, source->kind, seed, source->noise, source->sum);
        for (int i = 0; i < layout->image_count; i++)
            source->count[i] = 1;
    }
    gather(source);
    return WEFT_OK;
}

weft_code problem_create(const texel_source *source, problem *given, weft_error *error)
{
    size_t samples = (size_t)source->layout.image_count, views = (size_t)source->layout.view_count;
    *given = (problem){.code = &model_vector,
                       .view_count = source->layout.view_count,
                       .first = calloc(views + 1, sizeof *given->first)};
    double **array[] = {&given->product[0],  &given->product[1],  &given->product[2],  &given->cosine,
                        &given->value,       &given->power[0],    &given->power[1],    &given->power[2],
                        &given->log_base[0], &given->log_base[1], &given->log_base[2], &given->model};
    bool complete = given->first != NULL;
    for (size_t i = 0; i < sizeof array / sizeof *array; i++) {
        *array[i] = calloc(samples + 1, sizeof(double));
        complete = complete && *array[i];
    }
    given->column = calloc(PROBLEM_PARAMETERS * samples + 1, sizeof(double));
    if (complete && given->column)
        return WEFT_OK;
    problem_free(given);
    return weft_fail_memory(error, "a problem in double", PROBLEM_PARAMETERS * samples * sizeof(double));
}

/* Light and view of an image as the texel sees them; the sample, scaled as the fit of Weft scales it. */
static void load_sample(const texel_source *source, int image, int channel, int at, problem *given)
{
    const weft_dataset_layout *layout = &source->layout;
    weft_vec3 light = weft_dataset_light_direction(layout, image, source->x, source->y);
    weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image], source->x, source->y);
    given->product[0][at] = light.x * view.x;
    given->product[1][at] = light.y * view.y;
    given->product[2][at] = light.z * view.z;
    given->cosine[at] = light.z;
    double value = (double)source->sum[3 * image + channel] / source->samples.scale;
    given->value[at] = layout->values == WEFT_REFLECTANCE ? value * light.z : value;
}

static bool is_valid(const texel_source *source, int image)
{
    weft_vec3 light = weft_dataset_light_direction(&source->layout, image, source->x, source->y);
    return source->count[image] > 0 && light.z > 0;
}

void problem_load(const texel_source *source, int channel, const weft_fit_options *options, problem *given)
{
    const weft_dataset_layout *layout = &source->layout;
    memset(given->first, 0, (size_t)(layout->view_count + 1) * sizeof *given->first);
    for (int image = 0; image < layout->image_count; image++)
        given->first[layout->view_of_image[image] + 1] += is_valid(source, image);
    for (int view = 0; view < layout->view_count; view++)
        given->first[view + 1] += given->first[view];
    given->sample_count = given->first[layout->view_count];
    for (int image = layout->image_count - 1; image >= 0; image--) {
        /* Filled from behind: first[view + 1] counts down to first[view]. */
        if (is_valid(source, image))
            load_sample(source, image, channel, --given->first[layout->view_of_image[image] + 1], given);
    }
    memmove(given->first, given->first + 1, (size_t)layout->view_count * sizeof *given->first);
    given->first[layout->view_count] = given->sample_count;
    given->lobe_count = options->lobe_count;
    given->parameter_count = 1 + 4 * options->lobe_count;
    given->fits_table = options->table;
    given->max_exponent = options->max_exponent;
    given->tolerance = options->tolerance;
    given->passes = 0;
}

void problem_free(problem *given)
{
    for (int k = 0; k < 3; k++) {
        free(given->product[k]);
        free(given->power[k]);
        free(given->log_base[k]);
    }
    free(given->first);
    free(given->cosine);
    free(given->value);
    free(given->model);
    free(given->column);
    *given = (problem){0};
}

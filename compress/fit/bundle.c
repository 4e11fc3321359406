#include "compress/fit/bundle.h"

#include "base/integers.h"

#include "compress/fit/kernels.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct entry {
    int view, image;
    weft_vec3 light;
    double order;
} entry;

static int compare_reals(double a, double b)
{
    return (a > b) - (a < b);
}

static int compare_lights(const void *left, const void *right)
{
    const entry *a = left, *b = right;
    int order = a->view - b->view;
    if (!order)
        order = compare_reals(a->light.z, b->light.z);
    if (!order)
        order = compare_reals(a->light.x, b->light.x);
    if (!order)
        order = compare_reals(a->light.y, b->light.y);
    return order ? order : a->image - b->image;
}

static int compare_order(const void *left, const void *right)
{
    const entry *a = left, *b = right;
    return compare_reals(a->order, b->order);
}

/* Multiples of the golden ratio spread any prefix of a sorted list evenly over it. */
static void shuffle_evenly(entry *entries, int count)
{
    for (int i = 0; i < count; i++)
        entries[i].order = fmod(i * 0.61803398874989485, 1.0);
    qsort(entries, (size_t)count, sizeof *entries, compare_order);
}

static entry *sorted_entries(const weft_dataset_layout *layout, const uint8_t *held_out, int *count)
{
    entry *entries = calloc((size_t)layout->image_count, sizeof *entries);
    *count = 0;
    for (int i = 0; entries && i < layout->image_count; i++) {
        if (!held_out || !held_out[i])
            entries[(*count)++] = (entry){.view = layout->view_of_image[i], .image = i, .light = layout->light[i]};
    }
    if (entries)
        qsort(entries, (size_t)*count, sizeof *entries, compare_lights);
    return entries;
}

/* ---- Strips ---- */

static int whole_strips(int count)
{
    return (count + WEFT_STRIP_LANES - 1) / WEFT_STRIP_LANES;
}

/* Images of every view, from the sorted entries. */
static int *count_by_view(const entry *entries, int count, int view_count)
{
    int *images = calloc((size_t)view_count + 1, sizeof *images);
    for (int i = 0; images && i < count; i++)
        images[entries[i].view]++;
    return images;
}

/* A quarter of the slots of a view, but more where these would be too few samples to choose a start by. */
static int coarse_part(int slots, int image_count)
{
    int enough = (int)ceil((double)slots * WEFT_COARSE_SAMPLES / image_count);
    return weft_smaller(slots, weft_larger((slots + 3) / 4, enough));
}

static void add_strip(weft_bundle *bundle, int view, int slots, bool split)
{
    int coarse = coarse_part(slots, bundle->image_count);
    bundle->is_coarse |= coarse < slots;
    bundle->strip[bundle->strip_count++] = (weft_strip){
        .first = bundle->sample_count, .slots = slots, .coarse_slots = coarse, .view = view, .split = split};
    bundle->sample_count += slots * WEFT_STRIP_LANES;
}

/* Sixteen views side by side, or one after the other where that takes fewer slots: few views are left at the end, or
 * one has many more lights than its neighbours. */
static void plan_strips(weft_bundle *bundle, const int *images)
{
    for (int first = 0; first < bundle->view_count; first += WEFT_STRIP_LANES) {
        int last = first + WEFT_STRIP_LANES < bundle->view_count ? first + WEFT_STRIP_LANES : bundle->view_count;
        int aligned = 0, split = 0;
        for (int view = first; view < last; view++) {
            aligned = images[view] > aligned ? images[view] : aligned;
            split += whole_strips(images[view]);
        }
        if (aligned <= split && aligned > 0)
            add_strip(bundle, first, aligned, false);
        for (int view = first; aligned > split && view < last; view++) {
            if (images[view] > 0)
                add_strip(bundle, view, whole_strips(images[view]), true);
        }
    }
}

/* Puts image number `index` of a view of a strip into its place. */
static void place_image(weft_bundle *bundle, const weft_strip *strip, int view, int index, int image)
{
    int slot = strip->split ? index / WEFT_STRIP_LANES : index;
    int lane = strip->split ? index % WEFT_STRIP_LANES : view - strip->view;
    bundle->image[strip->first + slot * WEFT_STRIP_LANES + lane] = image;
}

/* The mean over the bundled images is 1, so that only ratios matter to a fit. Where all have weight 0, none counts. */
static void weigh_images(weft_bundle *bundle, const weft_dataset_layout *layout)
{
    const double *weight = layout->figure[WEFT_IMAGE_WEIGHT];
    double sum = 0;
    for (int i = 0; weight && i < bundle->sample_count; i++)
        sum += bundle->image[i] < 0 ? 0 : weight[bundle->image[i]];
    double scale = sum > 0 ? bundle->image_count / sum : 1;
    for (int i = 0; i < bundle->sample_count; i++)
        bundle->weight[i] = weight && bundle->image[i] >= 0 ? (float)(scale * weight[bundle->image[i]]) : 1;
}

static void place_images(weft_bundle *bundle, entry *entries, const int *images)
{
    for (int i = 0; i < bundle->sample_count; i++)
        bundle->image[i] = -1;
    for (int s = 0; s < bundle->strip_count; s++) {
        const weft_strip *strip = &bundle->strip[s];
        for (int i = 0; i < strip->slots * WEFT_STRIP_LANES; i++) {
            int view = strip->view + (strip->split ? 0 : i % WEFT_STRIP_LANES);
            bundle->view_of[strip->first + i] = view < bundle->view_count ? view : 0;
        }
        int views = strip->split ? 1 : WEFT_STRIP_LANES;
        for (int view = strip->view; view < strip->view + views && view < bundle->view_count; view++) {
            shuffle_evenly(entries, images[view]);
            for (int i = 0; i < images[view]; i++)
                place_image(bundle, strip, view, i, entries[i].image);
            entries += images[view];
        }
    }
}

/* ---- Creation ---- */

/* Zeros, four bytes each. */
static void *allocate_rows(size_t count)
{
    size_t bytes = (count + 2 * WEFT_STRIP_LANES) / WEFT_STRIP_LANES * WEFT_STRIP_LANES * sizeof(float);
    void *result = aligned_alloc(64, bytes);
    if (result)
        memset(result, 0, bytes);
    return result;
}

static weft_code allocate_samples(weft_bundle *bundle, weft_error *error)
{
    size_t samples = (size_t)bundle->sample_count + 1;
    bundle->image = allocate_rows(samples);
    bundle->view_of = allocate_rows(samples);
    bundle->weight = allocate_rows(samples);
    bool complete = bundle->image && bundle->view_of && bundle->weight;
    for (int k = 0; k < 3; k++) {
        bundle->light[k] = allocate_rows(samples);
        bundle->view_xyz[k] = allocate_rows((size_t)bundle->view_stride);
        complete = complete && bundle->light[k] && bundle->view_xyz[k];
    }
    return complete ? WEFT_OK : weft_fail_memory(error, "bundled images", samples * 5 * sizeof(float));
}

static weft_code fill_bundle(weft_bundle *bundle, const weft_dataset_layout *layout, entry *entries, const int *images,
                             weft_error *error)
{
    plan_strips(bundle, images);
    WEFT_TRY(allocate_samples(bundle, error));
    place_images(bundle, entries, images);
    weigh_images(bundle, layout);
    weft_bundle_aim(bundle, layout, 0, 0);
    return WEFT_OK;
}

weft_code weft_bundle_create(const weft_dataset_layout *layout, const uint8_t *held_out, weft_bundle *bundle,
                             weft_error *error)
{
    int views = layout->view_count;
    *bundle = (weft_bundle){.view_count = views, .view_stride = WEFT_STRIP_LANES * whole_strips(views)};
    entry *entries = sorted_entries(layout, held_out, &bundle->image_count);
    int *images = entries ? count_by_view(entries, bundle->image_count, views) : NULL;
    bundle->view = calloc((size_t)views + 1, sizeof *bundle->view);
    bundle->strip = calloc((size_t)views + 1, sizeof *bundle->strip);
    weft_code code = WEFT_OK;
    if (!images || !bundle->view || !bundle->strip)
        code = weft_fail_memory(error, "bundles of views", (size_t)views * sizeof *bundle->view);
    else
        code = fill_bundle(bundle, layout, entries, images, error);
    if (code != WEFT_OK)
        weft_bundle_free(bundle);
    free(entries);
    free(images);
    return code;
}

void weft_bundle_free(weft_bundle *bundle)
{
    free(bundle->strip);
    free(bundle->image);
    free(bundle->view_of);
    free(bundle->weight);
    free(bundle->view);
    for (int k = 0; k < 3; k++) {
        free(bundle->light[k]);
        free(bundle->view_xyz[k]);
    }
    *bundle = (weft_bundle){0};
}

static weft_vec3 direction_from(const weft_dataset_layout *layout, weft_vec3 target, weft_vec3 place)
{
    return weft_unit(layout->distance == WEFT_NEAR ? weft_subtract(target, place) : target);
}

void weft_bundle_aim(weft_bundle *bundle, const weft_dataset_layout *layout, double x_mm, double y_mm)
{
    weft_vec3 place = weft_vec3_of(x_mm, y_mm, 0);
    for (int view = 0; view < bundle->view_count; view++) {
        weft_vec3 direction = direction_from(layout, layout->view[view], place);
        bundle->view[view] = direction;
        bundle->view_xyz[0][view] = (float)direction.x;
        bundle->view_xyz[1][view] = (float)direction.y;
        bundle->view_xyz[2][view] = (float)direction.z;
    }
    for (int i = 0; i < bundle->sample_count; i++) {
        if (bundle->image[i] < 0)
            continue;
        weft_vec3 light = direction_from(layout, layout->light[bundle->image[i]], place);
        bundle->light[0][i] = (float)light.x;
        bundle->light[1][i] = (float)light.y;
        bundle->light[2][i] = (float)light.z;
    }
}

void weft_bundle_place(const weft_dataset_layout *layout, int x0, int y0, int x1, int y1, double *x_mm, double *y_mm)
{
    *x_mm = (0.5 * (x0 + x1) - 0.5 * layout->width) * layout->texel_pitch_mm;
    *y_mm = (0.5 * layout->height - 0.5 * (y0 + y1)) * layout->texel_pitch_mm;
}

weft_code weft_samples_create(const weft_bundle *bundle, weft_samples *samples, weft_error *error)
{
    *samples = (weft_samples){.sample_count = bundle->sample_count, .scale = 1};
    size_t count = (size_t)bundle->sample_count;
    samples->cosine = allocate_rows(count);
    bool complete = samples->cosine != NULL;
    for (int channel = 0; channel <= WEFT_GREY; channel++) {
        samples->value[channel] = allocate_rows(count);
        complete = complete && samples->value[channel];
    }
    if (complete)
        return WEFT_OK;
    weft_samples_free(samples);
    return weft_fail_memory(error, "samples of a texel", 5 * count * sizeof(float));
}

void weft_samples_free(weft_samples *samples)
{
    free(samples->cosine);
    for (int channel = 0; channel <= WEFT_GREY; channel++)
        free(samples->value[channel]);
    *samples = (weft_samples){0};
}

void weft_samples_gather(const weft_bundle *bundle, weft_values values, const float *sum, const float *count,
                         int group_size, weft_samples *samples)
{
    WEFT_DISPATCH(weft_gather_samples)(bundle, values, sum, count, group_size, samples);
}

void weft_samples_weigh_for_screen(const weft_bundle *bundle, weft_samples *samples)
{
    WEFT_DISPATCH(weft_gather_weigh)(bundle, samples);
}

#include "compress/bundle.h"

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

static int whole_lanes(int count)
{
    return (count + WEFT_LANES - 1) / WEFT_LANES * WEFT_LANES;
}

static void measure(weft_bundle *bundle, const entry *entries, int count)
{
    int lane = 0;
    for (int view = 0, next = 0; view < bundle->view_count; view++) {
        int first = next;
        while (next < count && entries[next].view == view)
            next++;
        bundle->first_lane[view] = lane;
        bundle->coarse_end[view] = lane + whole_lanes((next - first + 3) / 4);
        lane += whole_lanes(next - first);
    }
    bundle->first_lane[bundle->view_count] = lane;
    bundle->lane_count = lane;
}

static void place_images(weft_bundle *bundle, entry *entries)
{
    for (int i = 0; i < bundle->lane_count; i++)
        bundle->image[i] = -1;
    for (int view = 0, next = 0; view < bundle->view_count; view++) {
        int count = 0;
        while (next + count < bundle->image_count && entries[next + count].view == view)
            count++;
        shuffle_evenly(entries + next, count);
        for (int i = 0; i < count; i++)
            bundle->image[bundle->first_lane[view] + i] = entries[next + i].image;
        next += count;
    }
}

static weft_code allocate_lanes(weft_bundle *bundle, weft_error *error)
{
    size_t lanes = (size_t)(bundle->lane_count > 0 ? bundle->lane_count : WEFT_LANES);
    bundle->image = calloc(lanes, sizeof *bundle->image);
    for (int k = 0; k < 3; k++) {
        bundle->light[k] = aligned_alloc(64, lanes * sizeof(float));
        if (!bundle->light[k])
            return weft_fail_memory(error, "light directions", lanes * sizeof(float));
        memset(bundle->light[k], 0, lanes * sizeof(float));
    }
    return bundle->image ? WEFT_OK : weft_fail_memory(error, "bundled images", lanes * sizeof *bundle->image);
}

weft_code weft_bundle_create(const weft_dataset_layout *layout, const uint8_t *held_out, weft_bundle *bundle,
                             weft_error *error)
{
    *bundle = (weft_bundle){.view_count = layout->view_count};
    size_t views = (size_t)layout->view_count;
    entry *entries = sorted_entries(layout, held_out, &bundle->image_count);
    bundle->first_lane = calloc(views + 1, sizeof *bundle->first_lane);
    bundle->coarse_end = calloc(views + 1, sizeof *bundle->coarse_end);
    bundle->view = calloc(views + 1, sizeof *bundle->view);
    weft_code code = WEFT_OK;
    if (!entries || !bundle->first_lane || !bundle->coarse_end || !bundle->view)
        code = weft_fail_memory(error, "bundles of views", views * sizeof *bundle->view);
    if (code == WEFT_OK) {
        measure(bundle, entries, bundle->image_count);
        code = allocate_lanes(bundle, error);
    }
    if (code == WEFT_OK) {
        place_images(bundle, entries);
        weft_bundle_aim(bundle, layout, 0, 0);
    } else {
        weft_bundle_free(bundle);
    }
    free(entries);
    return code;
}

void weft_bundle_free(weft_bundle *bundle)
{
    free(bundle->first_lane);
    free(bundle->coarse_end);
    free(bundle->image);
    free(bundle->view);
    for (int k = 0; k < 3; k++)
        free(bundle->light[k]);
    *bundle = (weft_bundle){0};
}

static weft_vec3 direction_from(const weft_dataset_layout *layout, weft_vec3 target, weft_vec3 place)
{
    return weft_unit(layout->distance == WEFT_NEAR ? weft_subtract(target, place) : target);
}

void weft_bundle_aim(weft_bundle *bundle, const weft_dataset_layout *layout, double x_mm, double y_mm)
{
    weft_vec3 place = weft_vec3_of(x_mm, y_mm, 0);
    for (int view = 0; view < bundle->view_count; view++)
        bundle->view[view] = direction_from(layout, layout->view[view], place);
    for (int lane = 0; lane < bundle->lane_count; lane++) {
        if (bundle->image[lane] < 0)
            continue;
        weft_vec3 light = direction_from(layout, layout->light[bundle->image[lane]], place);
        bundle->light[0][lane] = (float)light.x;
        bundle->light[1][lane] = (float)light.y;
        bundle->light[2][lane] = (float)light.z;
    }
}

void weft_bundle_place(const weft_dataset_layout *layout, int x0, int y0, int x1, int y1, double *x_mm, double *y_mm)
{
    *x_mm = (0.5 * (x0 + x1) - 0.5 * layout->width) * layout->texel_pitch_mm;
    *y_mm = (0.5 * layout->height - 0.5 * (y0 + y1)) * layout->texel_pitch_mm;
}

weft_code weft_samples_create(const weft_bundle *bundle, weft_samples *samples, weft_error *error)
{
    *samples = (weft_samples){.lane_count = bundle->lane_count, .scale = 1};
    size_t bytes = (size_t)(bundle->lane_count > 0 ? bundle->lane_count : WEFT_LANES) * sizeof(float);
    samples->cosine = aligned_alloc(64, bytes);
    bool complete = samples->cosine != NULL;
    for (int channel = 0; channel <= WEFT_GREY; channel++) {
        samples->value[channel] = aligned_alloc(64, bytes);
        complete = complete && samples->value[channel];
    }
    if (complete)
        return WEFT_OK;
    weft_samples_free(samples);
    return weft_fail_memory(error, "samples of a texel", bytes);
}

void weft_samples_free(weft_samples *samples)
{
    free(samples->cosine);
    for (int channel = 0; channel <= WEFT_GREY; channel++)
        free(samples->value[channel]);
    *samples = (weft_samples){0};
}

static void clear_lane(weft_samples *samples, int lane)
{
    samples->cosine[lane] = 0;
    for (int channel = 0; channel <= WEFT_GREY; channel++)
        samples->value[channel][lane] = 0;
}

static void gather_lane(weft_samples *samples, int lane, float light_z, const float *sum, float count, float weight,
                        weft_values values)
{
    float root = sqrtf(weight);
    float factor = root / count * (values == WEFT_REFLECTANCE ? light_z : 1);
    float rgb[3] = {sum[0] * factor, sum[1] * factor, sum[2] * factor};
    samples->cosine[lane] = root * light_z;
    for (int channel = 0; channel < WEFT_CHANNELS; channel++)
        samples->value[channel][lane] = rgb[channel];
    samples->value[WEFT_GREY][lane] = (rgb[0] + rgb[1] + rgb[2]) / 3;
    samples->weight += weight;
    samples->valid_count++;
}

/* Scaling by the texel keeps the sums of the fit far from the ends of the range of floats. */
static void normalise(weft_samples *samples)
{
    double energy[WEFT_CHANNELS + 1] = {0}, total = 0;
    for (int channel = 0; channel <= WEFT_GREY; channel++) {
        for (int lane = 0; lane < samples->lane_count; lane++)
            energy[channel] += (double)samples->value[channel][lane] * (double)samples->value[channel][lane];
        total += channel < WEFT_CHANNELS ? energy[channel] : 0;
    }
    samples->scale = total > 0 ? sqrt(total / (WEFT_CHANNELS * samples->weight)) : 1;
    float inverse = (float)(1 / samples->scale);
    for (int channel = 0; channel <= WEFT_GREY; channel++) {
        samples->energy[channel] = energy[channel] / (samples->scale * samples->scale);
        for (int lane = 0; lane < samples->lane_count; lane++)
            samples->value[channel][lane] *= inverse;
    }
}

void weft_samples_gather(const weft_bundle *bundle, weft_values values, const float *sum, const float *count,
                         int group_size, weft_samples *samples)
{
    samples->valid_count = 0;
    samples->weight = 0;
    for (int lane = 0; lane < bundle->lane_count; lane++) {
        int image = bundle->image[lane];
        float light_z = bundle->light[2][lane];
        const float *rgb = sum + 3 * (image < 0 ? 0 : image);
        if (image < 0 || !(count[image] > 0) || !(light_z > 0) || !isfinite(rgb[0] + rgb[1] + rgb[2]))
            clear_lane(samples, lane);
        else
            gather_lane(samples, lane, light_z, rgb, count[image], count[image] / (float)group_size, values);
    }
    normalise(samples);
}

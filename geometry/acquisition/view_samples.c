#include "geometry/acquisition/view_samples.h"

#include "geometry/light/sample_sequence.h"

#include <stdlib.h>
#include <string.h>

/* Keeps the place in the texel apart from the bounces of the path, which count from 0. */
#define PLACE_KEY 0x10000u

enum { FIRST_BATCHES = 4, MAX_BATCHES = 512, MAX_ROUNDS = 4 };

static size_t texel_count(const weft_view_samples *samples)
{
    return (size_t)samples->options->width * (size_t)samples->options->height;
}

static size_t values_per_texel(const weft_view_samples *samples)
{
    return 3 * (size_t)samples->light_count;
}

weft_code weft_view_samples_create(const weft_tile_mesh *mesh, int light_count, const weft_acquisition_options *options,
                                   weft_view_samples *samples, weft_error *error)
{
    *samples = (weft_view_samples){.options = options,
                                   .tile_width = (weft_real)mesh->width,
                                   .tile_height = (weft_real)mesh->height,
                                   .plane = (weft_real)mesh->top + (weft_real)options->plane_mm,
                                   .light_count = light_count};
    size_t texels = texel_count(samples), bytes = texels * values_per_texel(samples) * sizeof *samples->sum;
    samples->texel = malloc(texels * sizeof *samples->texel);
    samples->sum = malloc(bytes);
    samples->wanted = malloc(texels * sizeof *samples->wanted);
    if (samples->texel && samples->sum && samples->wanted)
        return WEFT_OK;
    weft_view_samples_free(samples);
    return weft_fail_memory(error, "samples of a view", bytes);
}

void weft_view_samples_free(weft_view_samples *samples)
{
    free(samples->texel);
    free(samples->sum);
    free(samples->wanted);
    *samples = (weft_view_samples){0};
}

/* Point k of a batch in a texel. */
static weft_vec3 place_in_texel(const weft_view_samples *samples, int x, int y, uint64_t key, uint32_t k)
{
    double point[2];
    weft_sequence_point(weft_sequence_key(key, PLACE_KEY), k, point);
    return weft_vec3_of((x + point[0]) / samples->options->width * samples->tile_width,
                        (samples->options->height - y - 1 + point[1]) / samples->options->height * samples->tile_height,
                        samples->plane);
}

static void add_batch(weft_view_samples *samples, const weft_illumination *illumination, weft_vec3 view, size_t index,
                      uint64_t key, float *batch)
{
    size_t values = values_per_texel(samples);
    weft_texel_samples *texel = &samples->texel[index];
    float *sum = samples->sum + index * values;
    int x = (int)(index % (size_t)samples->options->width), y = (int)(index / (size_t)samples->options->width);
    key = weft_sequence_key(key, (uint64_t)texel->batches++);
    memset(batch, 0, values * sizeof *batch);
    for (uint32_t k = 0; k < WEFT_BATCH_PATHS; k++) {
        weft_first_hit first;
        if (!weft_illumination_path(illumination, place_in_texel(samples, x, y, key, k), view, key, k,
                                    (float(*)[3])(void *)batch, &first))
            continue;
        texel->hits++;
        weft_frame_sum_add(&texel->frame, first.normal, first.tangent, 1);
    }
    for (size_t i = 0; i < values; i++) {
        float mean = batch[i] / WEFT_BATCH_PATHS;
        sum[i] += mean;
        texel->squares += (double)mean * (double)mean;
    }
}

static double square_of_sums(const weft_view_samples *samples, size_t index)
{
    const float *sum = samples->sum + index * values_per_texel(samples);
    double square = 0;
    for (size_t i = 0; i < values_per_texel(samples); i++)
        square += (double)sum[i] * (double)sum[i];
    return square;
}

static void find_variance(weft_view_samples *samples, size_t index)
{
    weft_texel_samples *texel = &samples->texel[index];
    double n = texel->batches;
    texel->variance = fmax(texel->squares - square_of_sums(samples, index) / n, 0) / (n - 1);
}

/* Brings every texel to its wanted number of batches. */
static weft_code fill_up(weft_view_samples *samples, const weft_illumination *illumination, weft_vec3 view, int number,
                         weft_error *error)
{
    uint64_t view_key = weft_sequence_key(samples->options->seed, (uint64_t)number);
    bool short_of_memory = false;
    long count = (long)texel_count(samples);
#pragma omp parallel
    {
        float *batch = malloc(values_per_texel(samples) * sizeof *batch);
        if (!batch) {
#pragma omp atomic write
            short_of_memory = true;
        }
#pragma omp for schedule(dynamic, 4)
        for (long i = 0; i < count; i++) {
            uint64_t key = weft_sequence_key(view_key, (uint64_t)i);
            while (batch && samples->texel[i].batches < samples->wanted[i])
                add_batch(samples, illumination, view, (size_t)i, key, batch);
            find_variance(samples, (size_t)i);
        }
        free(batch);
    }
    return short_of_memory ? weft_fail_memory(error, "batch of paths", values_per_texel(samples) * sizeof(float))
                           : WEFT_OK;
}

double weft_view_samples_noise(const weft_view_samples *samples)
{
    double error = 0, signal = 0;
    for (size_t i = 0; i < texel_count(samples); i++) {
        double n = samples->texel[i].batches;
        error += samples->texel[i].variance / n;
        signal += square_of_sums(samples, i) / (n * n);
    }
    return signal > 0 ? sqrt(error / signal) : 0;
}

static int batches_for(const weft_texel_samples *texel, double scale)
{
    return (int)weft_clamp(ceil(scale * sqrt(texel->variance)), FIRST_BATCHES, MAX_BATCHES);
}

/* Sum over the texels of the squared standard error that `scale` batches per standard deviation would leave. */
static double error_left(const weft_view_samples *samples, double scale)
{
    double left = 0;
    for (size_t i = 0; i < texel_count(samples); i++)
        left += samples->texel[i].variance / batches_for(&samples->texel[i], scale);
    return left;
}

static void allocate_batches(weft_view_samples *samples)
{
    double signal = 0, most = 0;
    for (size_t i = 0; i < texel_count(samples); i++) {
        signal += square_of_sums(samples, i) / ((double)samples->texel[i].batches * samples->texel[i].batches);
        most = fmax(most, sqrt(samples->texel[i].variance));
    }
    double allowed = samples->options->noise * samples->options->noise * signal;
    double low = 0, high = most > 0 ? MAX_BATCHES * 64 / most : 0;
    for (int step = 0; step < 40; step++) {
        double middle = (low + high) / 2;
        if (error_left(samples, middle) > allowed)
            low = middle;
        else
            high = middle;
    }
    for (size_t i = 0; i < texel_count(samples); i++)
        samples->wanted[i] = batches_for(&samples->texel[i], high);
}

weft_code weft_view_samples_gather(weft_view_samples *samples, const weft_illumination *illumination, weft_vec3 view,
                                   int number, weft_error *error)
{
    size_t texels = texel_count(samples);
    memset(samples->sum, 0, texels * values_per_texel(samples) * sizeof *samples->sum);
    for (size_t i = 0; i < texels; i++) {
        samples->texel[i] = (weft_texel_samples){0};
        samples->wanted[i] = FIRST_BATCHES;
    }
    WEFT_TRY(fill_up(samples, illumination, view, number, error));
    /* The first batches tell the variance only roughly. */
    for (int round = 0; round < MAX_ROUNDS && weft_view_samples_noise(samples) > samples->options->noise; round++) {
        allocate_batches(samples);
        WEFT_TRY(fill_up(samples, illumination, view, number, error));
    }
    return WEFT_OK;
}

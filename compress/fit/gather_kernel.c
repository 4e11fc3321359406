/* The samples of a texel, put in order, and how well a model explains them. */
#include "compress/fit/kernels.h"

#include "base/lanes.h"

#include <math.h>

/* Sums over a texel. */
typedef struct gather_sums {
    double energy[WEFT_CHANNELS + 1];
    double weight, valid;
} gather_sums;

WEFT_INLINE lane_bits is_finite(lanes x)
{
    return ((lane_bits)x & 0x7f800000) != 0x7f800000;
}

WEFT_INLINE void gather_vector(const weft_bundle *bundle, weft_values values, const float *sum, const float *count,
                               float share, int at, weft_samples *samples, gather_sums *sums)
{
    lane_bits image = lane_bits_load(bundle->image + at), is_there = image >= 0;
    lane_bits index = image & is_there;
    lanes light_z = lanes_load(bundle->light[2] + at), n = lanes_gather(count, index), rgb[WEFT_CHANNELS];
    for (int k = 0; k < WEFT_CHANNELS; k++)
        rgb[k] = lanes_gather(sum, 3 * index + k);
    lanes of_image = lanes_load(bundle->weight + at);
    lane_bits valid =
        is_there & (n > 0.0f) & (of_image > 0.0f) & (light_z > 0.0f) & is_finite(rgb[0] + rgb[1] + rgb[2]);
    lanes weight = lanes_where(valid, n * share * of_image), root = lanes_sqrt(weight);
    lanes factor = root / lanes_select(valid, n, lanes_of(1));
    if (values == WEFT_REFLECTANCE)
        factor *= light_z;
    lanes_store(samples->cosine + at, root * light_z);
    lanes grey = {0};
    for (int k = 0; k < WEFT_CHANNELS; k++) {
        lanes value = lanes_where(valid, rgb[k] * factor);
        lanes_store(samples->value[k] + at, value);
        sums->energy[k] += (double)lanes_sum(value * value);
        grey += value;
    }
    grey *= 1.0f / WEFT_CHANNELS;
    lanes_store(samples->value[WEFT_GREY] + at, grey);
    sums->energy[WEFT_GREY] += (double)lanes_sum(grey * grey);
    sums->weight += (double)lanes_sum(weight);
    sums->valid += (double)lanes_sum(lanes_where(valid, lanes_of(1)));
}

/* Scaling by the texel keeps the sums of the fit far from the ends of the range of floats. */
WEFT_INLINE void normalise(const gather_sums *sums, weft_samples *samples)
{
    double total = 0;
    for (int k = 0; k < WEFT_CHANNELS; k++)
        total += sums->energy[k];
    samples->weight = sums->weight;
    samples->valid_count = (int)sums->valid;
    double rms = total > 0 ? sqrt(total / (WEFT_CHANNELS * samples->weight)) : 1;
    float inverse = (float)(1 / rms);
    samples->scale *= rms;
    for (int k = 0; k <= WEFT_GREY; k++) {
        samples->energy[k] = sums->energy[k] / (rms * rms);
        for (int at = 0; at < samples->sample_count; at += LANES)
            lanes_store(samples->value[k] + at, lanes_load(samples->value[k] + at) * inverse);
    }
}

void WEFT_KERNEL(weft_gather_samples)(const weft_bundle *bundle, weft_values values, const float *sum,
                                      const float *count, int group_size, weft_samples *samples)
{
    gather_sums sums = {0};
    samples->scale = 1;
    for (int at = 0; at < bundle->sample_count; at += LANES)
        gather_vector(bundle, values, sum, count, 1.0f / (float)group_size, at, samples, &sums);
    normalise(&sums, samples);
}

void WEFT_KERNEL(weft_gather_weigh)(const weft_bundle *bundle, weft_samples *samples)
{
    gather_sums sums = {.valid = samples->valid_count};
    for (int at = 0; at < bundle->sample_count; at += LANES) {
        lanes cosine = lanes_load(samples->cosine + at);
        lane_bits valid = cosine > 0.0f;
        lanes root = lanes_where(valid, cosine / lanes_select(valid, lanes_load(bundle->light[2] + at), lanes_of(1)));
        lanes grey = lanes_load(samples->value[WEFT_GREY] + at) / lanes_select(valid, root, lanes_of(1));
        grey = lanes_select(grey > 0.0f, grey, lanes_of(0));
        lanes factor = lanes_sqrt((float)WEFT_SCREEN_TOE / ((float)WEFT_SCREEN_TOE + grey));
        lanes_store(samples->cosine + at, cosine * factor);
        for (int k = 0; k <= WEFT_GREY; k++) {
            lanes value = lanes_load(samples->value[k] + at) * factor;
            lanes_store(samples->value[k] + at, value);
            sums.energy[k] += (double)lanes_sum(value * value);
        }
        sums.weight += (double)lanes_sum(root * root * factor * factor);
    }
    normalise(&sums, samples);
}

void WEFT_KERNEL(weft_gather_compare)(const weft_bundle *bundle, const weft_samples *samples, int channel,
                                      const float *model, const float *table, weft_error_sums *sums)
{
    double square = 0, square_error = 0;
    for (int at = 0; at < bundle->sample_count; at += LANES) {
        lanes cosine = lanes_load(samples->cosine + at), sample = lanes_load(samples->value[channel] + at);
        lane_bits valid = cosine > 0.0f;
        lanes t = lanes_gather(table, lane_bits_load(bundle->view_of + at));
        lanes root = lanes_where(valid, lanes_load(bundle->light[2] + at) / lanes_select(valid, cosine, lanes_of(1)));
        lanes error = (sample - t * lanes_load(model + at)) * root;
        sample *= root;
        square += (double)lanes_sum(sample * sample);
        square_error += (double)lanes_sum(error * error);
    }
    double scale = samples->scale * samples->scale;
    sums->square += scale * square;
    sums->square_error += scale * square_error;
    sums->count += samples->valid_count;
}

WEFT_INLINE float largest_of(lanes x)
{
    float largest = x[0];
    for (int i = 1; i < LANES; i++)
        largest = x[i] > largest ? x[i] : largest;
    return largest;
}

void WEFT_KERNEL(weft_gather_brightest)(const weft_bundle *bundle, const weft_samples *samples, int channel, float *r,
                                        float *f, float *cosine)
{
    lanes most_r = {0}, most_f = {0}, most_cosine = {0};
    for (int at = 0; at < bundle->sample_count; at += LANES) {
        lanes own = lanes_load(samples->cosine + at), light = lanes_load(bundle->light[2] + at);
        lane_bits valid = own > 0.0f;
        lanes value =
            lanes_where(valid, lanes_load(samples->value[channel] + at) / lanes_select(valid, own, lanes_of(1)));
        most_r = lanes_max(most_r, value * light);
        most_f = lanes_max(most_f, value);
        most_cosine = lanes_max(most_cosine, lanes_where(valid, light));
    }
    *r = largest_of(most_r);
    *f = largest_of(most_f);
    *cosine = largest_of(most_cosine);
}

#include "capture/virtual/sensor.h"

#include "capture/virtual/random.h"

#include <stdlib.h>

/* What a random number of a sample, or of a speck, is for. */
enum { DARK, HOT, HEAT, RESPONSE, SPECK_X, SPECK_Y, SPECK_RADIUS, SPECK_DEPTH, USES };

static uint64_t number_of(size_t index, int use)
{
    return (uint64_t)index * USES + (uint64_t)use;
}

static double uniform(uint64_t seed, size_t index, int use)
{
    return weft_random_uniform(seed, WEFT_RANDOM_SENSOR, number_of(index, use));
}

static double normal(uint64_t seed, size_t index, int use)
{
    return weft_random_normal(seed, WEFT_RANDOM_SENSOR, number_of(index, use));
}

static bool is_hot(const weft_virtual_settings *s, uint64_t seed, size_t sample)
{
    return uniform(seed, sample / 3, HOT) < s->hot_share;
}

static double dark_of(const weft_virtual_settings *s, uint64_t seed, size_t sample)
{
    double usual = fmax(0, s->dark_electrons * (1 + s->dark_spread * normal(seed, sample, DARK)));
    if (!is_hot(s, seed, sample))
        return usual;
    return usual - s->hot_factor * s->dark_electrons * log(1 - uniform(seed, sample, HEAT));
}

static void lay_speck(const weft_virtual_settings *s, uint64_t seed, size_t speck, float *response)
{
    int width = (int)s->rig.width_px, height = (int)s->rig.height_px;
    double x = width * uniform(seed, speck, SPECK_X), y = height * uniform(seed, speck, SPECK_Y);
    double radius = 3 + 6 * uniform(seed, speck, SPECK_RADIUS);
    double depth = s->dust_depth * (0.3 + 0.7 * uniform(seed, speck, SPECK_DEPTH));
    for (int row = (int)fmax(0, y - radius); row < height && row <= y + radius; row++) {
        for (int column = (int)fmax(0, x - radius); column < width && column <= x + radius; column++) {
            double away = hypot(column - x, row - y) / radius;
            double shadow = away < 1 ? depth * 0.5 * (1 + cos(WEFT_PI * away)) : 0;
            for (int c = 0; c < 3; c++)
                response[3 * ((size_t)row * (size_t)width + (size_t)column) + (size_t)c] *= (float)(1 - shadow);
        }
    }
}

weft_code weft_virtual_sensor_defects_make(const weft_virtual_settings *s, uint64_t seed,
                                           weft_virtual_sensor_defects *faults, weft_error *error)
{
    long count = (long)s->rig.width_px * (long)s->rig.height_px * 3;
    faults->response = malloc((size_t)count * sizeof(float));
    faults->dark_electrons = malloc((size_t)count * sizeof(float));
    faults->hot = malloc((size_t)count);
    if (!faults->response || !faults->dark_electrons || !faults->hot)
        return weft_fail_memory(error, "faults of the virtual sensor", (size_t)count * 2 * sizeof(float));
#pragma omp parallel for schedule(static)
    for (long i = 0; i < count; i++) {
        faults->response[i] = (float)fmax(0, 1 + s->response_spread * normal(seed, (size_t)i, RESPONSE));
        faults->dark_electrons[i] = (float)dark_of(s, seed, (size_t)i);
        faults->hot[i] = is_hot(s, seed, (size_t)i);
    }
    for (int speck = 0; speck < (int)s->dust_specks; speck++)
        lay_speck(s, seed, (size_t)speck, faults->response);
    return WEFT_OK;
}

void weft_virtual_sensor_defects_free(weft_virtual_sensor_defects *faults)
{
    free(faults->response);
    free(faults->dark_electrons);
    free(faults->hot);
    *faults = (weft_virtual_sensor_defects){0};
}

/* The value below which a fraction p of the standard normal lies: Newton on its distribution function. */
static double normal_quantile(double p)
{
    double x = 0;
    for (int i = 0; i < 60; i++) {
        double excess = 0.5 * erfc(-x / sqrt(2)) - p;
        double step = excess * sqrt(2 * WEFT_PI) * exp(x * x / 2);
        x -= weft_clamp(step, -0.5, 0.5);
    }
    return x;
}

/* Equally likely values, scaled to variance 1 (the finite table misses a little of the tails). */
static float *make_quantiles(void)
{
    float *quantiles = malloc(WEFT_NORMAL_COUNT * sizeof *quantiles);
    double squares = 0;
    for (int i = 0; quantiles && i < WEFT_NORMAL_COUNT; i++) {
        double value = normal_quantile((i + 0.5) / WEFT_NORMAL_COUNT);
        squares += value * value;
        quantiles[i] = (float)value;
    }
    for (int i = 0; quantiles && i < WEFT_NORMAL_COUNT; i++)
        quantiles[i] /= (float)sqrt(squares / WEFT_NORMAL_COUNT);
    return quantiles;
}

weft_code weft_virtual_sensor_make(const weft_virtual_settings *s, uint64_t seed, weft_virtual_sensor *sensor,
                                   weft_error *error)
{
    int full_scale = (1 << (int)s->rig.bits) - 1, black_level = (int)s->rig.black_level;
    *sensor = (weft_virtual_sensor){
        .read_noise = (float)s->read_noise_electrons,
        .electrons_per_step = (float)(s->full_well_electrons / (full_scale - black_level)),
        .black_level = black_level,
        .full_scale = full_scale,
        .normal = make_quantiles(),
    };
    if (!sensor->normal)
        return weft_fail_memory(error, "noise table", WEFT_NORMAL_COUNT * sizeof(float));
    return s->sensor_faults != 0 ? weft_virtual_sensor_defects_make(s, seed, &sensor->faults, error) : WEFT_OK;
}

void weft_virtual_sensor_free(weft_virtual_sensor *sensor)
{
    free((float *)sensor->normal);
    weft_virtual_sensor_defects_free(&sensor->faults);
    *sensor = (weft_virtual_sensor){0};
}

/* An integer hash in the manner of Wellons' "lowbias32", keyed between its rounds so that two keys never give shifted
 * copies of one sequence. */
static inline uint32_t hash_sample(uint32_t index, uint32_t key, uint32_t second_key)
{
    uint32_t h = index ^ key;
    h = (h ^ h >> 16) * 0x7feb352du;
    h += second_key;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return h ^ h >> 16;
}

/* What the defects of the sensor make of the electrons of samples from `first` on. */
static void spoil(const weft_virtual_sensor_defects *faults, size_t first, int count, float exposure_s, uint64_t key,
                  float *electrons)
{
    for (int i = 0; i < count; i++) {
        size_t at = first + (size_t)i;
        float dark = faults->dark_electrons[at] * exposure_s;
        bool more = hash_sample((uint32_t)at, (uint32_t)(key >> 32), (uint32_t)key) >> 31;
        float blink = !faults->hot[at] ? 1 : more ? 1.5f : 0.5f;
        electrons[i] = electrons[i] * faults->response[at] + dark * blink;
    }
}

WEFT_HOT static void read_block(const weft_virtual_sensor *s, const float *gathered, uint32_t first, int count,
                                uint64_t key, uint16_t *samples)
{
    const float *normal = s->normal;
    float read_variance = s->read_noise * s->read_noise;
    float per_electron = 1 / s->electrons_per_step, zero = (float)s->black_level + 0.5f;
    float full_scale = (float)s->full_scale;
    uint32_t low = (uint32_t)key, high = (uint32_t)(key >> 32);
    for (int i = 0; i < count; i++) {
        float electrons = gathered[i];
        uint32_t quantile = hash_sample(first + (uint32_t)i, low, high) >> (32 - WEFT_NORMAL_BITS);
        float noisy = electrons + sqrtf(electrons + read_variance) * normal[quantile];
        float raw = zero + noisy * per_electron;
        raw = raw > 0 ? raw : 0;
        samples[i] = (uint16_t)(int)(raw < full_scale ? raw : full_scale);
    }
}

void weft_virtual_sensor_read(const weft_virtual_sensor *sensor, const float *radiance, size_t count, double gain,
                              double exposure_s, uint64_t key, uint16_t *samples)
{
    enum { BLOCK = 8192 };
    long blocks = (long)((count + BLOCK - 1) / BLOCK);
#pragma omp parallel for schedule(static)
    for (long block = 0; block < blocks; block++) {
        size_t first = (size_t)block * BLOCK;
        int length = count - first < BLOCK ? (int)(count - first) : BLOCK;
        float electrons[BLOCK];
        for (int i = 0; i < length; i++)
            electrons[i] = radiance[first + (size_t)i] * (float)gain;
        if (sensor->faults.response)
            spoil(&sensor->faults, first, length, (float)exposure_s, key, electrons);
        read_block(sensor, electrons, (uint32_t)first, length, key, samples + first);
    }
}

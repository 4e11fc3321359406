#include "capture/virtual/sensor_defects.h"

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

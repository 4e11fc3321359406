#include "capture/synthetic/plan.h"

#include "capture/virtual/sensor.h"

#include <math.h>
#include <stdlib.h>

static const double full_well_at_100 = 60000, read_noise = 4;
static const int bits = 14, black_level = 512;

double weft_synthetic_gain(double seconds, double f_number, double iso)
{
    return seconds * iso / (120 * f_number * f_number);
}

static weft_code make_sensor(double full_well, weft_virtual_sensor *sensor, weft_error *error)
{
    weft_virtual_settings settings = weft_virtual_settings_default();
    settings.full_well_electrons = full_well;
    settings.read_noise_electrons = read_noise;
    settings.rig.bits = bits;
    settings.rig.black_level = black_level;
    return weft_virtual_sensor_make(&settings, 0, sensor, error);
}

static void balance(const weft_synthetic_exposure *exposure, const uint16_t *raw, size_t count, float *linear)
{
    double range = (1 << bits) - 1 - black_level;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < count; i++) {
        double value = (raw[i] - black_level) / range * exposure->white_balance[i % 3];
        linear[i] = (float)fmin(fmax(value, 0), 1);
    }
}

weft_code weft_synthetic_sense(const weft_synthetic_exposure *exposure, const float *radiance, size_t count,
                               uint64_t key, float *linear, weft_error *error)
{
    double full_well = full_well_at_100 * 100 / exposure->iso;
    weft_virtual_sensor sensor;
    uint16_t *raw = malloc(count * sizeof *raw);
    if (!raw)
        return weft_fail_memory(error, "a photograph", count * sizeof *raw);
    weft_code code = make_sensor(full_well, &sensor, error);
    if (code == WEFT_OK) {
        weft_virtual_sensor_read(&sensor, radiance, count, exposure->gain * full_well, 0, key, raw);
        balance(exposure, raw, count, linear);
        weft_virtual_sensor_free(&sensor);
    }
    free(raw);
    return code;
}

static double contrast_curve(double linear)
{
    const double toe = 0.002, power = 0.85, middle = 0.4589348; /* 0.4^0.85 */
    double t = linear > 0 ? linear * linear / (linear + toe) : 0, raised = pow(t, power);
    double full = pow(1 / (1 + toe), power);
    return raised / (raised + middle) * (full + middle) / full;
}

static double soft_curve(double linear)
{
    const double density = 2, gamma = 2.2;
    return pow(expm1(-density * fmax(linear, 0)) / expm1(-density), 1 / gamma);
}

double weft_synthetic_tone(weft_synthetic_curve curve, double linear)
{
    return curve == WEFT_SYNTHETIC_SOFT ? soft_curve(linear) : contrast_curve(linear);
}
